#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/evaluation/detection_report.h"
#include "common/evaluation/trajectory_report.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "processes/tools/evaluate/detection_input.h"
#include "processes/tools/evaluate/evaluate_command.h"

namespace airdos {
namespace {

struct DetectionArguments {
  std::string log;
  std::string data;
  std::string json;
  bool force = false;
};

void RunDetections(const DetectionArguments& arguments) {
  const OutputFiles outputs({arguments.json}, {{arguments.log, arguments.data}, arguments.force});
  const DetectionInput input = ReadDetections(arguments.log, arguments.data);
  const DetectionReport report = EvaluateDetections(input.camera, input.frames);
  Remarks remarks = input.remarks;
  for (const Remark& doubt : DoubtsAbout(report)) remarks.push_back(doubt);
  std::fputs(ToTable(report).c_str(), stdout);
  for (const Remark& remark : remarks) std::printf("%s\n", ToLine(remark).c_str());
  if (!arguments.json.empty()) {
    nlohmann::json json = ToJson(report);
    json["log"] = arguments.log;
    json["data"] = arguments.data;
    json["remarks"] = RemarksToJson(remarks);
    WriteJson(json, arguments.json);
  }
  SayWarnings(remarks);
}

}  // namespace

void AddDetectionsCommand(CommandLine* app) {
  const auto arguments = std::make_shared<DetectionArguments>();
  CommandLine command =
      app->AddCommand("detections", "Errors of a detector of people: recall, false people, joints");
  command
      .AddFile(
          "--log", &arguments->log,
          "log with PERSON_KEYPOINTS_LEFT and _RIGHT, as written by airdos-replay --data FOLDER "
          "--detect --out LOG, run_live.sh --record, or airdos-import")
      .Required();
  command
      .AddFolder("--data", &arguments->data,
                 "data set of the same images, with true joints (joints_gt.json.gz and "
                 "gt_tum_optical.txt), keypoints to compare with, or both")
      .Required();
  command.AddFile("--json", &arguments->json, "JSON file for all figures");
  command.AddForce(&arguments->force);
  command.OnGiven([arguments] { RunDetections(*arguments); });
}

}  // namespace airdos
