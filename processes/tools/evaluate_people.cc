#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/evaluation/people_report.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "processes/tools/evaluate_command.h"

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

void RunPeople(const PeopleArguments& arguments) {
  const OutputFiles outputs({arguments.json}, {{arguments.people, arguments.joints,
                                                arguments.estimate, arguments.ground_truth},
                                               arguments.force});
  constexpr double kMaxTimeDifferenceS = 0.001;
  const MatchedTrajectories cameras =
      Associate(ReadTrajectory(arguments.estimate), ReadTrajectory(arguments.ground_truth),
                kMaxTimeDifferenceS);
  const PeopleReport report =
      EvaluatePeople(ReadPeople(arguments.people), ReadTruePeople(arguments.joints), cameras);
  std::fputs(ToTable(report).c_str(), stdout);
  if (!arguments.json.empty()) WriteJson(ToJson(report), arguments.json);
}

}  // namespace

void AddPeopleCommand(CLI::App* app) {
  const auto arguments = std::make_shared<PeopleArguments>();
  CLI::App* const command =
      app->add_subcommand("people", "Errors of people: joints, identities, lengths of segments");
  AddFile("--people", &arguments->people, "people.jsonl of a map", command)->required();
  AddFile("--joints", &arguments->joints, "true joints: joints_gt.json, or its .gz", command)
      ->required();
  AddFile("--estimate", &arguments->estimate, "trajectory.tum of the same map", command)
      ->required();
  AddFile("--ground-truth", &arguments->ground_truth,
          "TUM file of the true camera, optical axes, in the world of the true joints", command)
      ->required();
  AddFile("--json", &arguments->json, "file to write all figures to", command);
  AddForce(&arguments->force, command);
  command->callback([arguments] { RunPeople(*arguments); });
}

}  // namespace airdos
