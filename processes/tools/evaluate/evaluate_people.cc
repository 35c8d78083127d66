#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/evaluation/people_report.h"
#include "common/evaluation/trajectory_report.h"
#include "common/util/error.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "processes/tools/evaluate/evaluate_command.h"

namespace airdos {
namespace {

struct PeopleArguments {
  std::string people;
  std::string joints;
  std::string estimate;
  std::string ground_truth;
  std::string json;
  bool force = false;
};

/// The matched poses of the camera. The truth must be in optical axes.
TrajectoryReport CompareCameras(const PeopleArguments& arguments) {
  EvaluationOptions options;
  options.max_time_difference_s = 0.001;
  options.axes = GroundTruthAxes::Optical();
  const Trajectory estimate = ReadTrajectory(arguments.estimate);
  const TrajectoryReport report =
      EvaluateTrajectory(estimate, ReadTrajectory(arguments.ground_truth), options);
  if (!report.no_rotations_because.empty()) {
    throw InputError(arguments.estimate + " against " + arguments.ground_truth + ": " +
                     report.no_rotations_because +
                     "; people are compared in camera axes, so poses with rotations are needed");
  }
  return report;
}

void RunPeople(const PeopleArguments& arguments) {
  const OutputFiles outputs({arguments.json}, {{arguments.people, arguments.joints,
                                                arguments.estimate, arguments.ground_truth},
                                               arguments.force});
  const TrajectoryReport cameras = CompareCameras(arguments);
  const PeopleReport report = EvaluatePeople(ReadPeople(arguments.people),
                                             ReadTruePeople(arguments.joints), cameras.matched);
  std::fputs(ToTable(report).c_str(), stdout);
  for (const Remark& remark : cameras.remarks) std::printf("%s\n", ToLine(remark).c_str());
  if (!arguments.json.empty()) {
    nlohmann::json json = ToJson(report);
    json["remarks"] = RemarksToJson(cameras.remarks);
    WriteJson(json, arguments.json);
  }
  SayWarnings(cameras.remarks);
}

}  // namespace

void AddPeopleCommand(CommandLine* app) {
  const auto arguments = std::make_shared<PeopleArguments>();
  CommandLine command =
      app->AddCommand("people", "Errors of people: joints, identities, segment lengths");
  command.AddFile("--people", &arguments->people, "people.jsonl of a map").Required();
  command.AddFile("--joints", &arguments->joints, "true joints: joints_gt.json, or its .gz")
      .Required();
  command.AddFile("--estimate", &arguments->estimate, "trajectory.tum of the same map").Required();
  command
      .AddFile("--ground-truth", &arguments->ground_truth,
               "TUM file of the true camera, optical axes, in the world of the true joints")
      .Required();
  command.AddFile("--json", &arguments->json, "JSON file for all figures");
  command.AddForce(&arguments->force);
  command.OnGiven([arguments] { RunPeople(*arguments); });
}

}  // namespace airdos
