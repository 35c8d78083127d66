#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/evaluation/trajectory_plot.h"
#include "common/evaluation/trajectory_report.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "processes/tools/evaluate/evaluate_command.h"

namespace airdos {
namespace {

struct TrajectoryArguments {
  std::string estimate;
  std::string ground_truth;
  std::string times;
  std::string axes = "auto";
  std::string inverted;
  double max_difference_s = 0.01;
  std::size_t num_frames = 0;
  std::string json;
  std::string plot;
  bool force = false;
};

void RunTrajectory(const TrajectoryArguments& arguments) {
  const OutputFiles outputs(
      {arguments.json, arguments.plot},
      {{arguments.estimate, arguments.ground_truth, arguments.times}, arguments.force});
  Trajectory estimate = ReadTrajectory(arguments.estimate);
  Trajectory ground_truth = ReadTrajectory(arguments.ground_truth);
  if (!arguments.times.empty()) SetTimesOfPair(arguments.times, &estimate, &ground_truth);
  EvaluationOptions options;
  options.max_time_difference_s = arguments.max_difference_s;
  options.num_frames = arguments.num_frames;
  if (arguments.axes != "auto") options.axes = GroundTruthAxes::Parse(arguments.axes);
  options.is_estimate_inverted = arguments.inverted == "estimate";
  options.is_truth_inverted = arguments.inverted == "ground-truth";
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
  SayWarnings(report.remarks);
}

}  // namespace

void SayWarnings(const Remarks& remarks) {
  for (const Remark& remark : remarks) {
    if (remark.is_warning) std::fprintf(stderr, "airdos-evaluate: %s\n", ToLine(remark).c_str());
  }
}

void AddTrajectoryCommand(CommandLine* app) {
  const auto arguments = std::make_shared<TrajectoryArguments>();
  CommandLine command = app->AddCommand("trajectory", "Errors of a camera trajectory");
  command
      .AddFile("--estimate", &arguments->estimate,
               "trajectory in optical axes: TUM, KITTI, EuRoC csv or TartanAir")
      .Required();
  command.AddFile("--ground-truth", &arguments->ground_truth, "true trajectory, likewise")
      .Required();
  command.AddFile("--times", &arguments->times,
                  "times for the rows of a file without times (KITTI), one line per row");
  command
      .Add("--gt-axes", &arguments->axes,
           "axes of the ground truth: optical, ned, where right, down and forward lie (such "
           "as y,-z,x), or auto: compares motions with the estimate's")
      .Check([](const std::string& text) -> std::string {
        if (text == "auto" || GroundTruthAxes::Parse(text)) return "";
        return "'" + text + "' is none of auto, optical, ned, three axes such as y,-z,x";
      })
      .ShowDefault();
  command
      .Add("--inverted", &arguments->inverted,
           "the file whose poses are T_C_W (as ORB-SLAM's Tcw) instead of T_W_C: estimate "
           "or ground-truth")
      .OneOfFew({"estimate", "ground-truth"});
  command.Add("--max-diff", &arguments->max_difference_s, "largest time difference (s)")
      .NotNegative()
      .ShowDefault();
  command.Add("--frames", &arguments->num_frames,
              "number of images in the sequence, for the completeness (default: as many as the "
              "ground truth has rows, or the estimate if the truth has a higher rate)");
  command.AddFile("--json", &arguments->json, "JSON file for all figures");
  command.AddFile("--plot", &arguments->plot, "PNG file for a plot of trajectories and errors");
  command.AddForce(&arguments->force);
  command.OnGiven([arguments] { RunTrajectory(*arguments); });
}

}  // namespace airdos
