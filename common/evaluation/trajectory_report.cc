#include "common/evaluation/trajectory_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/evaluation/alignment.h"
#include "common/evaluation/trajectory_doubts.h"
#include "common/evaluation/trajectory_times.h"
#include "common/util/error.h"
#include "common/util/format.h"

namespace airdos {
namespace {

constexpr double kMetre = 1.0;

Statistics AlignedError(const MatchedTrajectories& matched, const Similarity& similarity) {
  return ComputeStatistics(
      PositionErrors(Apply(similarity, matched.estimate), matched.ground_truth));
}

Statistics ErrorAlignedBy(const MatchedTrajectories& matched, Alignment alignment) {
  return AlignedError(matched, ComputeAlignment(matched, alignment));
}

/// Determines whether one of the files contains positions only.
void FindRotations(const Trajectory& estimate, const Trajectory& ground_truth,
                   const MatchedTrajectories& matched, TrajectoryReport* report) {
  const bool has_truth_none =
      !ground_truth.has_rotations || HasPositionsOnly(matched.ground_truth, matched.estimate);
  const bool has_estimate_none =
      !estimate.has_rotations || HasPositionsOnly(matched.estimate, matched.ground_truth);
  report->truth_has_rotations = !has_truth_none;
  if (!has_truth_none && !has_estimate_none) return;
  const std::string name =
      has_truth_none ? NameOf("ground truth", ground_truth) : NameOf("estimate", estimate);
  report->no_rotations_because =
      std::string("the ") + (has_truth_none ? "ground truth" : "estimate") + " has positions only";
  report->remarks.push_back(
      {true, name + ": holds positions only (no rotation, or the same in all rows while the other "
                    "file's turn): rotation and relative pose figures are omitted, and the axes "
                    "are unknown"});
}

std::string Describe(const PoseReading& reading, const TrajectoryReport& report) {
  const auto order = [](QuaternionOrder read) {
    return read == QuaternionOrder::kXyzw ? "w x y z" : "x y z w";
  };
  std::string text;
  if (reading.has_other_order_in_estimate) {
    text = std::string("the estimate's quaternions as ") + order(report.estimate_order);
  }
  if (reading.has_other_order_in_truth) {
    text += (text.empty() ? "" : " and ") + std::string("the ground truth's quaternions as ") +
            order(report.truth_order);
  }
  if (reading.is_estimate_inverted || reading.is_truth_inverted) {
    text += (text.empty() ? "" : " and ") +
            std::string(reading.is_estimate_inverted ? "the estimate" : "the ground truth") +
            " inverted";
  }
  return text;
}

/// Reads quaternions in the other order if the motions require it; refuses inverted poses.
void DecideReading(const Trajectory& estimate, const Trajectory& ground_truth,
                   const EvaluationOptions& options, MatchedTrajectories* matched,
                   TrajectoryReport* report) {
  report->estimate_order = estimate.order;
  report->truth_order = ground_truth.order;
  const std::optional<ReadingDoubt> doubt =
      FindBetterReading(*matched, estimate.order, ground_truth.order);
  if (!doubt) return;
  const PoseReading& reading = doubt->reading;
  const std::string evidence = "motions of both agree by " + Format("%.3f", doubt->agreement) +
                               " with " + Describe(reading, *report) + ", by " +
                               Format("%.3f", doubt->agreement_as_read) + " as read";
  if (reading.is_estimate_inverted || reading.is_truth_inverted) {
    const bool is_stated = options.is_estimate_inverted || options.is_truth_inverted;
    throw InputError(
        (reading.is_estimate_inverted ? NameOf("estimate", estimate)
                                      : NameOf("ground truth", ground_truth)) +
        ": looks like inverted poses (T_C_W, like ORB-SLAM's Tcw; T_W_C is expected): " + evidence +
        (doubt->do_both_inversions_fit ? ", and as well with the ground truth inverted" : "") +
        (is_stated ? "; omit --inverted, or name the other file"
                   : std::string("; use --inverted ") +
                         (reading.is_estimate_inverted ? "estimate" : "ground-truth")));
  }
  *matched = ReadAs(reading, estimate.order, ground_truth.order, std::move(*matched));
  report->remarks.push_back(
      {true, (reading.has_other_order_in_truth ? NameOf("ground truth", ground_truth)
                                               : NameOf("estimate", estimate)) +
                 ": its quaternions look like another order: " + evidence +
                 "; the figures are for that reading; write TUM files with x y z w"});
}

/// Sets the axes when rotations do not determine them: as given, or as they are.
void KeepAxes(const EvaluationOptions& options, const std::string& why, TrajectoryReport* report) {
  report->axes = options.axes.value_or(GroundTruthAxes::Optical());
  report->axes_reason = std::string(options.axes ? "as given; " : "not determined: ") + why;
}

void CheckGivenAxes(const MatchedTrajectories& matched, const AxesDecision& decision,
                    TrajectoryReport* report) {
  constexpr double kWorse = 0.1;
  const double agreement = AgreementIn(report->axes, matched);
  if (!decision.is_known || agreement > decision.best_agreement - kWorse) return;
  report->remarks.push_back(
      {true, "axes of the ground truth as given, " + report->axes.Name() +
                 ": motions of both agree by " + Format("%.3f", agreement) + " only in them, by " +
                 Format("%.3f", decision.agreement) + " if they are " + decision.axes.Name() +
                 ": rotation and relative pose figures are wrong if the axes are"});
}

/// If the positions fit but the motions in body axes do not, the rotations of one file are wrong.
bool CheckContradiction(const MatchedTrajectories& matched, const AxesDecision& decision,
                        TrajectoryReport* report) {
  constexpr double kAgree = 0.9;
  const bool can_tell = decision.uses_rotation || decision.uses_translation;
  if (!can_tell || decision.best_agreement >= kAgree || !DoPositionsFit(matched)) {
    return false;
  }
  report->remarks.push_back(
      {true, "contradiction: the positions fit, but motions in body axes agree by " +
                 Format("%.3f", decision.best_agreement) +
                 " only (1 = same): the rotations of one file are wrong or belong to another body "
                 "(order of the quaternion, an IMU instead of the camera?); do not trust "
                 "rotation and relative pose figures"});
  return true;
}

void DecideAxes(const MatchedTrajectories& matched, const EvaluationOptions& options,
                TrajectoryReport* report) {
  const AxesDecision decision = DetectAxes(matched);
  report->axes = options.axes.value_or(decision.axes);
  report->axes_reason = (options.axes ? "as given; " : "detected: ") + decision.Explain();
  const bool is_contradiction = CheckContradiction(matched, decision, report);
  if (options.axes) {
    CheckGivenAxes(matched, decision, report);
    return;
  }
  // Mirrored axes, or none, would spoil positions that do fit.
  constexpr double kNothingFits = 0.7;
  if (is_contradiction &&
      (decision.best_agreement < kNothingFits || !decision.axes.is_right_handed())) {
    report->no_rotations_because = "rotations of both contradict each other";
    KeepAxes(options, decision.Explain(), report);
    return;
  }
  if (!decision.is_known) {
    std::string warnings;  // one of these may be the reason
    for (const Remark& remark : report->remarks) {
      if (remark.is_warning) warnings += "; " + remark.text;
    }
    throw InputError("ground truth: its axes cannot be determined, " + decision.Explain() +
                     ": specify --gt-axes optical, ned or e.g. y,-z,x" + warnings);
  }
  for (const GroundTruthAxes& axes : decision.alternatives) {
    MatchedTrajectories other = matched;
    for (TrajectoryPose& pose : other.ground_truth) pose = ToOptical(pose, axes);
    report->alternatives.push_back({axes, ErrorAlignedBy(other, Alignment::kSe3)});
  }
}

void CountFrames(const Trajectory& estimate, const Trajectory& ground_truth,
                 const EvaluationOptions& options, TrajectoryReport* report) {
  const std::size_t num_of_slower =
      report->has_times ? FramesOfSlowerEstimate(estimate, ground_truth) : 0;
  report->has_truth_higher_rate = num_of_slower > 0;
  report->are_frames_given = options.num_frames > 0;
  report->num_frames = options.num_frames > 0 ? options.num_frames
                       : num_of_slower > 0    ? num_of_slower
                                              : ground_truth.num_rows();
  if (report->num_frames < report->num_matched) {
    throw InputError("--frames " + std::to_string(options.num_frames) + ": fewer than the " +
                     std::to_string(report->num_matched) +
                     " poses compared; specify the number of images of the whole sequence");
  }
  if (report->has_truth_higher_rate) {
    report->num_without_truth = report->num_estimate - report->num_matched;
  }
  report->completeness =
      static_cast<double>(report->num_matched) / static_cast<double>(report->num_frames);
}

/// Frames without a pose, and those whose step is wrong. A pose without a partner in a ground truth
/// of higher rate is not lost.
std::size_t CountLost(const MatchedTrajectories& aligned, const TrajectoryReport& report) {
  std::size_t num_with_pose = report.num_matched;
  if (report.has_truth_higher_rate) {
    num_with_pose = std::min(report.num_estimate, report.num_frames);
  }
  const std::size_t num_without = report.num_frames - num_with_pose;
  if (report.no_rotations_because.empty()) {
    return num_without + CountLostFrames(aligned, report.num_matched);
  }
  std::size_t num_wrong = 0;  // judged by displacements in the aligned world
  for (std::size_t i = 1; i < aligned.estimate.size(); ++i) {
    const Eigen::Vector3d step =
        aligned.estimate[i].position_m - aligned.estimate[i - 1].position_m;
    const Eigen::Vector3d true_step =
        aligned.ground_truth[i].position_m - aligned.ground_truth[i - 1].position_m;
    if ((step - true_step).norm() > kLostTranslationM) ++num_wrong;
  }
  return num_without + num_wrong;
}

void FillRelativeErrors(const MatchedTrajectories& matched, TrajectoryReport* report) {
  if (!report->no_rotations_because.empty()) return;
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
  report->end_point_drift_percent = EndPointDriftPercent(matched);
  report->segment_drifts = SegmentDrifts(matched);
}

/// Adds remarks on what the figures themselves make doubtful.
void RemarkOnFigures(const MatchedTrajectories& matched, TrajectoryReport* report) {
  constexpr double kSameUnit = 0.1;
  for (const double factor : {1000.0, 100.0, 0.01, 0.001}) {
    if (std::abs(report->sim3_scale / factor - 1) > kSameUnit || !DoPositionsFit(matched)) continue;
    report->remarks.push_back({true, "the positions fit with a scale of " +
                                         Format("%.4g", report->sim3_scale) +
                                         ": those of one file are in mm or cm; convert them to m"});
  }
  const std::size_t num_frozen = CountFrozenPoses(matched);
  constexpr std::size_t kMostByChance = 2;
  if (num_frozen > kMostByChance) {
    report->remarks.push_back(
        {true, std::to_string(num_frozen) +
                   " poses of the estimate repeat the previous one in all digits while the truth "
                   "moves: lost frames written as the last pose count as frames with one"});
  }
  if (report->ate_none_m.max == 0 && report->path_m > 0) {
    report->remarks.push_back(
        {true, "all positions of both files are the same: one file compared with itself?"});
  }
}

}  // namespace

TrajectoryReport EvaluateTrajectory(const Trajectory& estimate, const Trajectory& ground_truth,
                                    const EvaluationOptions& options) {
  TrajectoryReport report;
  for (const Trajectory* const trajectory : {&estimate, &ground_truth}) {
    report.remarks.insert(report.remarks.end(), trajectory->remarks.begin(),
                          trajectory->remarks.end());
  }
  MatchedTrajectories matched =
      MatchPoses(estimate, ground_truth, options.max_time_difference_s, &report.remarks);
  report.has_times = estimate.has_times;
  report.num_estimate = estimate.poses.size();
  report.num_ground_truth = ground_truth.poses.size();
  report.num_matched = matched.estimate.size();
  CountFrames(estimate, ground_truth, options, &report);
  PoseReading stated;
  stated.is_estimate_inverted = options.is_estimate_inverted;
  stated.is_truth_inverted = options.is_truth_inverted;
  matched = ReadAs(stated, estimate.order, ground_truth.order, std::move(matched));
  FindRotations(estimate, ground_truth, matched, &report);
  if (report.no_rotations_because.empty()) {
    DecideReading(estimate, ground_truth, options, &matched, &report);
    DecideAxes(matched, options, &report);
  } else {
    KeepAxes(options, report.no_rotations_because, &report);
  }
  for (TrajectoryPose& pose : matched.ground_truth) pose = ToOptical(pose, report.axes);

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
  RemarkOnFigures(matched, &report);
  report.aligned = {Apply(se3, matched.estimate), matched.ground_truth};
  report.matched = std::move(matched);
  report.num_lost = CountLost(report.aligned, report);
  return report;
}

}  // namespace airdos
