// airdos-evaluate: how good an estimate is, given the truth.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/evaluation/people_report.h"
#include "common/evaluation/trajectory_plot.h"
#include "common/evaluation/trajectory_report.h"
#include "common/simulation/settings.h"
#include "common/util/error.h"
#include "common/util/version.h"
#include "processes/tools/ablation_report.h"
#include "processes/tools/do_no_harm.h"

namespace airdos {
namespace {

struct TrajectoryArguments {
  std::string estimate;
  std::string ground_truth;
  std::string times;
  std::string axes = "auto";
  double max_difference_s = 0.01;
  std::size_t num_frames = 0;
  std::string json;
  std::string plot;
};

CLI::App* AddTrajectoryCommand(CLI::App* app, TrajectoryArguments* arguments) {
  CLI::App* const command = app->add_subcommand("trajectory", "Errors of a camera trajectory");
  command->add_option("--estimate", arguments->estimate, "TUM or KITTI file, optical axes")
      ->required();
  command->add_option("--ground-truth", arguments->ground_truth, "TUM or KITTI file")->required();
  command->add_option("--times", arguments->times,
                      "times (s) of the rows of a KITTI file, one a line, to compare it with TUM");
  command
      ->add_option("--gt-axes", arguments->axes,
                   "axes of the ground truth; auto compares motions with the estimate's")
      ->check(CLI::IsMember({"auto", "optical", "ned"}))
      ->capture_default_str();
  command->add_option("--max-diff", arguments->max_difference_s, "largest time difference (s)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--frames", arguments->num_frames,
                      "images of the sequence, for the completeness (default: as many as the "
                      "ground truth has poses)");
  command->add_option("--json", arguments->json, "file to write all figures to");
  command->add_option("--plot", arguments->plot, "PNG file to draw trajectories and errors into");
  return command;
}

void WriteJson(const nlohmann::json& json, const std::string& path) {
  std::ofstream file(path);
  file << json.dump(1) << "\n";
  if (!file.flush()) throw InputError(path + ": cannot be written");
}

void RunTrajectory(const TrajectoryArguments& arguments) {
  Trajectory estimate = ReadTrajectory(arguments.estimate);
  Trajectory ground_truth = ReadTrajectory(arguments.ground_truth);
  if (!arguments.times.empty()) {
    if (!estimate.has_times) SetTimes(arguments.times, &estimate);
    if (!ground_truth.has_times) SetTimes(arguments.times, &ground_truth);
  }
  EvaluationOptions options;
  options.max_time_difference_s = arguments.max_difference_s;
  options.num_frames = arguments.num_frames;
  if (arguments.axes == "ned") options.axes = GroundTruthAxes::kNed;
  if (arguments.axes == "optical") options.axes = GroundTruthAxes::kOptical;
  const TrajectoryReport report = EvaluateTrajectory(estimate, ground_truth, options);
  std::fputs(ToTable(report).c_str(), stdout);
  if (!arguments.json.empty()) {
    nlohmann::json json = ToJson(report);
    json["estimate"] = arguments.estimate;
    json["ground_truth"] = arguments.ground_truth;
    WriteJson(json, arguments.json);
  }
  if (!arguments.plot.empty()) {
    WritePng(DrawEvaluation(report, arguments.estimate), arguments.plot);
  }
}

struct PeopleArguments {
  std::string people;
  std::string joints;
  std::string estimate;
  std::string ground_truth;
  double max_distance_m = 0.5;
  std::string json;
};

CLI::App* AddPeopleCommand(CLI::App* app, PeopleArguments* arguments) {
  CLI::App* const command = app->add_subcommand("people", "Errors of people's joints, in 3-D");
  command->add_option("--people", arguments->people, "people.jsonl of a map")->required();
  command->add_option("--joints", arguments->joints, "true joints: joints_gt.json, or its .gz")
      ->required();
  command->add_option("--estimate", arguments->estimate, "trajectory.tum of the same map")
      ->required();
  command
      ->add_option("--ground-truth", arguments->ground_truth,
                   "TUM file of the true camera, optical axes, in the world of the true joints")
      ->required();
  command->add_option("--max-distance", arguments->max_distance_m, "of a match, mean of joints (m)")
      ->capture_default_str();
  command->add_option("--json", arguments->json, "file to write all figures to");
  return command;
}

void RunPeople(const PeopleArguments& arguments) {
  constexpr double kMaxTimeDifferenceS = 0.001;
  const MatchedTrajectories cameras =
      Associate(ReadTrajectory(arguments.estimate), ReadTrajectory(arguments.ground_truth),
                kMaxTimeDifferenceS);
  const PeopleReport report =
      EvaluatePeople(ReadPeople(arguments.people), ReadTruePeople(arguments.joints), cameras,
                     arguments.max_distance_m);
  std::fputs(ToTable(report).c_str(), stdout);
  if (!arguments.json.empty()) WriteJson(ToJson(report), arguments.json);
}

struct AblationArguments {
  std::vector<std::string> groups;
  bool do_no_harm = false;
  int num_sequences = 0;
  std::uint64_t seed = 1;
  std::string json;
};

CLI::App* AddAblationCommand(CLI::App* app, AblationArguments* arguments) {
  CLI::App* const command = app->add_subcommand(
      "ablation", "The paper's table: bundle adjustment of simulated sequences, with and without");
  command
      ->add_option("--groups", arguments->groups,
                   "settings of the simulator (default: the paper's four groups)")
      ->check(CLI::IsMember(SettingNames()));
  command->add_flag("--do-no-harm", arguments->do_no_harm,
                    "instead: how people change the camera's errors, in every setting");
  command
      ->add_option("--sequences", arguments->num_sequences,
                   "of each group (default: 10; do-no-harm: 100)")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", arguments->seed, "of each group's first sequence")
      ->capture_default_str();
  command->add_option("--json", arguments->json, "file to write all figures to");
  return command;
}

void RunAblationCommand(AblationArguments arguments) {
  const bool do_no_harm = arguments.do_no_harm;
  if (arguments.groups.empty()) arguments.groups = do_no_harm ? SettingNames() : PaperGroups();
  if (arguments.num_sequences == 0) arguments.num_sequences = do_no_harm ? 100 : 10;
  nlohmann::json json;
  const auto show = [](const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  };
  if (do_no_harm) show(DoNoHarmTitle());
  for (const std::string& setting : arguments.groups) {
    if (do_no_harm) {
      const DoNoHarmSetting runs = RunDoNoHarm(DefaultDoNoHarmOptions(), setting, arguments.seed,
                                               arguments.num_sequences, nullptr);
      show(ToLine(runs));
      json.push_back(ToJson(runs));
    } else {
      const AblationGroup group =
          RunAblation({}, setting, arguments.seed, arguments.num_sequences, nullptr);
      show(ToTable(group) + "\n");
      json.push_back(ToJson(group));
    }
  }
  if (!arguments.json.empty()) WriteJson(json, arguments.json);
}

}  // namespace
}  // namespace airdos

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  CLI::App app("How good an estimate is, given the truth");
  app.set_version_flag("--version", airdos::kVersion);
  app.require_subcommand(1);
  airdos::TrajectoryArguments trajectory;
  airdos::PeopleArguments people;
  CLI::App* const of_trajectory = airdos::AddTrajectoryCommand(&app, &trajectory);
  airdos::AddPeopleCommand(&app, &people);
  airdos::AblationArguments ablation;
  CLI::App* const of_ablation = airdos::AddAblationCommand(&app, &ablation);
  try {
    app.parse(argc, argv);
    if (of_trajectory->parsed()) {
      airdos::RunTrajectory(trajectory);
    } else if (of_ablation->parsed()) {
      airdos::RunAblationCommand(ablation);
    } else {
      airdos::RunPeople(people);
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : airdos::kExitBadInput;
  } catch (const airdos::InputError& error) {
    std::fprintf(stderr, "airdos-evaluate: %s\n", error.what());
    return airdos::kExitBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "airdos-evaluate: %s\n", error.what());
    return 1;
  }
  return 0;
}
