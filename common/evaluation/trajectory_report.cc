#include "common/evaluation/trajectory_report.h"

#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/evaluation/alignment.h"
#include "common/util/error.h"

namespace airdos {
namespace {

constexpr double kMetre = 1.0;

std::string Format(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string Format(const char* format, ...) {
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

Statistics AlignedError(const MatchedTrajectories& matched, const Similarity& similarity) {
  return ComputeStatistics(
      PositionErrors(Apply(similarity, matched.estimate), matched.ground_truth));
}

Statistics ErrorAlignedBy(const MatchedTrajectories& matched, Alignment alignment) {
  return AlignedError(matched, ComputeAlignment(matched, alignment));
}

void DecideAxes(const MatchedTrajectories& matched, const EvaluationOptions& options,
                TrajectoryReport* report) {
  const AxesDecision decision = DetectAxes(matched);
  report->axes = options.axes.value_or(decision.axes);
  report->axes_reason = (options.axes ? "as given; " : "detected: ") + decision.Explain();
  if (options.axes) return;
  if (!decision.is_known) {
    throw InputError("ground truth: its axes cannot be told, " + decision.Explain() +
                     ": give --gt-axes optical, ned or such as y,-z,x");
  }
  for (const GroundTruthAxes& axes : decision.alternatives) {
    MatchedTrajectories other = matched;
    for (TrajectoryPose& pose : other.ground_truth) pose = ToOptical(pose, axes);
    report->alternatives.push_back({axes, ErrorAlignedBy(other, Alignment::kSe3)});
  }
}

void FillRelativeErrors(const MatchedTrajectories& matched, TrajectoryReport* report) {
  std::vector<double> translation_m;
  std::vector<double> rotation_deg;
  for (const RelativeError& error : ErrorsPerFrame(matched)) {
    translation_m.push_back(error.translation_m);
    rotation_deg.push_back(error.rotation_deg);
  }
  report->rpe_translation_per_frame_m = ComputeStatistics(translation_m);
  report->rpe_rotation_per_frame_deg = ComputeStatistics(rotation_deg);
  translation_m.clear();
  rotation_deg.clear();
  for (const RelativeError& error : ErrorsOverLength(matched, kMetre)) {
    translation_m.push_back(error.translation_m / error.path_m);
    rotation_deg.push_back(error.rotation_deg / error.path_m);
  }
  report->rpe_translation_per_metre_m = ComputeStatistics(translation_m);
  report->rpe_rotation_per_metre_deg = ComputeStatistics(rotation_deg);
}

std::string Row(const char* name, const char* unit, const Statistics& s) {
  if (s.count == 0) return Format("  %-24s %-6s (no such motion)\n", name, unit);
  return Format("  %-24s %-6s %9.4f %9.4f %9.4f %9.4f %9.4f\n", name, unit, s.rmse, s.mean,
                s.median, s.max, s.std);
}

nlohmann::json StatisticsToJson(const Statistics& s) {
  if (s.count == 0) return nullptr;
  return {{"count", s.count},   {"rmse", s.rmse}, {"mean", s.mean},
          {"median", s.median}, {"max", s.max},   {"std", s.std}};
}

}  // namespace

TrajectoryReport EvaluateTrajectory(const Trajectory& estimate, const Trajectory& ground_truth,
                                    const EvaluationOptions& options) {
  MatchedTrajectories matched = Associate(estimate, ground_truth, options.max_time_difference_s);
  TrajectoryReport report;
  report.has_times = estimate.has_times;
  report.num_estimate = estimate.poses.size();
  report.num_ground_truth = ground_truth.poses.size();
  report.num_matched = matched.estimate.size();
  if (report.num_matched < 2) {
    throw InputError("only " + std::to_string(report.num_matched) + " of " +
                     std::to_string(report.num_estimate) + " estimated poses match one of the " +
                     std::to_string(report.num_ground_truth) +
                     " of the ground truth: at least 2 are needed (see --max-diff)");
  }
  report.num_frames = options.num_frames > 0 ? options.num_frames : report.num_ground_truth;
  report.completeness =
      static_cast<double>(report.num_matched) / static_cast<double>(report.num_frames);
  DecideAxes(matched, options, &report);
  for (TrajectoryPose& pose : matched.ground_truth) pose = ToOptical(pose, report.axes);

  report.num_lost = CountLostFrames(matched, report.num_frames);
  report.path_m = PathLengths(matched.ground_truth).back();
  if (report.has_times) {
    report.duration_s = matched.ground_truth.back().time_s - matched.ground_truth.front().time_s;
  }
  const Similarity se3 = ComputeAlignment(matched, Alignment::kSe3);
  const Similarity sim3 = ComputeAlignment(matched, Alignment::kSim3);
  report.sim3_scale = sim3.scale;
  report.ate_none_m = AlignedError(matched, Similarity());
  report.ate_se3_m = AlignedError(matched, se3);
  report.ate_sim3_m = AlignedError(matched, sim3);
  FillRelativeErrors(matched, &report);
  report.end_point_drift_percent = EndPointDriftPercent(matched);
  report.segment_drifts = SegmentDrifts(matched);
  report.aligned = {Apply(se3, matched.estimate), std::move(matched.ground_truth)};
  return report;
}

std::string ToTable(const TrajectoryReport& r) {
  std::string text =
      Format("%zu poses estimated, %zu in the ground truth, %zu matched: %.1f %% complete\n",
             r.num_estimate, r.num_ground_truth, r.num_matched, 100 * r.completeness);
  text += Format("%zu of %zu frames lost (no pose, or a step wrong by over %.2f m or %.0f deg)\n",
                 r.num_lost, r.num_frames, kLostTranslationM, kLostRotationDeg);
  text += Format("path %.3f m", r.path_m);
  if (r.has_times) text += Format(" in %.3f s", r.duration_s);
  text += "\nground truth axes: " + r.axes.Name() + ", " + r.axes_reason + "\n";
  for (const AxesAlternative& other : r.alternatives) {
    text += "  AMBIGUOUS: the motion fits axes " + other.axes.Name() +
            (other.axes.is_right_handed() ? " (right-handed)" : " (left-handed)") +
            Format(" as well, with ATE %.4f m\n", other.ate_se3_m.rmse);
  }
  text += "\n";
  text += Format("  %-24s %-6s %9s %9s %9s %9s %9s\n", "error", "unit", "rmse", "mean", "median",
                 "max", "std");
  text += Row("ATE, SE(3) aligned", "m", r.ate_se3_m);
  text += Row("ATE, Sim(3) aligned", "m", r.ate_sim3_m);
  text += Row("ATE, not aligned", "m", r.ate_none_m);
  text += Row("RPE per frame", "m", r.rpe_translation_per_frame_m);
  text += Row("RPE per frame", "deg", r.rpe_rotation_per_frame_deg);
  text += Row("RPE per metre travelled", "m/m", r.rpe_translation_per_metre_m);
  text += Row("RPE per metre travelled", "deg/m", r.rpe_rotation_per_metre_deg);
  text += Format("\n  Sim(3) scale %.6f; drift of the end point %.3f %% of the path\n",
                 r.sim3_scale, r.end_point_drift_percent);
  for (const SegmentDrift& drift : r.segment_drifts) {
    text += Format("  drift over %3.0f m: %.3f %%, %.5f deg/m (%zu segments)\n", drift.length_m,
                   drift.translation_percent, drift.rotation_deg_per_m, drift.num_segments);
  }
  return text;
}

nlohmann::json ToJson(const TrajectoryReport& r) {
  nlohmann::json segments = nlohmann::json::array();
  for (const SegmentDrift& drift : r.segment_drifts) {
    segments.push_back({{"length_m", drift.length_m},
                        {"num_segments", drift.num_segments},
                        {"translation_percent", drift.translation_percent},
                        {"rotation_deg_per_m", drift.rotation_deg_per_m}});
  }
  nlohmann::json alternatives = nlohmann::json::array();
  for (const AxesAlternative& other : r.alternatives) {
    alternatives.push_back({{"axes", other.axes.Name()},
                            {"right_handed", other.axes.is_right_handed()},
                            {"ate_se3_m", StatisticsToJson(other.ate_se3_m)}});
  }
  return {{"poses_estimated", r.num_estimate},
          {"poses_ground_truth", r.num_ground_truth},
          {"poses_matched", r.num_matched},
          {"completeness", r.completeness},
          {"frames", r.num_frames},
          {"frames_lost", r.num_lost},
          {"path_m", r.path_m},
          {"duration_s", r.has_times ? nlohmann::json(r.duration_s) : nlohmann::json(nullptr)},
          {"ground_truth_axes", r.axes.Name()},
          {"ground_truth_right_handed", r.axes.is_right_handed()},
          {"ground_truth_axes_alternatives", alternatives},
          {"ground_truth_axes_reason", r.axes_reason},
          {"ate_none_m", StatisticsToJson(r.ate_none_m)},
          {"ate_se3_m", StatisticsToJson(r.ate_se3_m)},
          {"ate_sim3_m", StatisticsToJson(r.ate_sim3_m)},
          {"sim3_scale", r.sim3_scale},
          {"rpe_translation_per_frame_m", StatisticsToJson(r.rpe_translation_per_frame_m)},
          {"rpe_rotation_per_frame_deg", StatisticsToJson(r.rpe_rotation_per_frame_deg)},
          {"rpe_translation_per_metre_m", StatisticsToJson(r.rpe_translation_per_metre_m)},
          {"rpe_rotation_per_metre_deg", StatisticsToJson(r.rpe_rotation_per_metre_deg)},
          {"end_point_drift_percent", r.end_point_drift_percent},
          {"segment_drifts", segments}};
}

}  // namespace airdos
