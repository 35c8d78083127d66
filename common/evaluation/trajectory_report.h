#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_REPORT_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_REPORT_H_

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/evaluation/ground_truth_axes.h"
#include "common/evaluation/statistics.h"
#include "common/evaluation/trajectory.h"
#include "common/evaluation/trajectory_error.h"
#include "common/evaluation/trajectory_file.h"

namespace airdos {

/// How a trajectory is compared with the ground truth.
struct EvaluationOptions {
  double max_time_difference_s = 0.01;
  std::optional<GroundTruthAxes> axes;  ///< if not set, they are detected
  /// Number of images of the sequence, for the completeness; 0 means the number of rows of the
  /// ground truth or, if that has a higher rate, of the estimate (see FramesOfSlowerEstimate()).
  std::size_t num_frames = 0;
  bool is_estimate_inverted = false;  ///< the poses are T_C_W
  bool is_truth_inverted = false;
};

/// Other axes of the ground truth that fit the motion equally well, and the resulting errors.
struct AxesAlternative {
  GroundTruthAxes axes;
  Statistics ate_se3_m;
};

/// All results for one estimated trajectory.
struct TrajectoryReport {
  std::size_t num_estimate = 0;
  std::size_t num_ground_truth = 0;
  std::size_t num_matched = 0;
  double completeness = 0;     ///< matched poses / frames (see EvaluationOptions::num_frames)
  std::size_t num_frames = 0;  ///< EvaluationOptions::num_frames, or its substitute
  bool are_frames_given = false;
  bool has_truth_higher_rate = false;  ///< if so, the estimate's rows are the frames
  std::size_t num_without_truth = 0;   ///< poses without a partner in such a truth: not lost
  std::size_t num_lost = 0;            ///< see CountLostFrames()
  double path_m = 0;                   ///< of the ground truth's matched poses
  double duration_s = 0;               ///< of the matched poses; 0 for KITTI rows

  GroundTruthAxes axes;
  std::string axes_reason;
  std::vector<AxesAlternative> alternatives;  ///< empty if the axes were given

  /// Why the figures that need the rotations of both are missing; empty if they are not.
  std::string no_rotations_because;
  bool truth_has_rotations = true;
  QuaternionOrder estimate_order = QuaternionOrder::kNone;  ///< as read from the files
  QuaternionOrder truth_order = QuaternionOrder::kNone;
  Remarks remarks;  ///< on the files and on this comparison

  Statistics ate_none_m;
  Statistics ate_se3_m;   ///< after rigid alignment of the estimate's world
  Statistics ate_sim3_m;  ///< with scale as well
  double sim3_scale = 1;

  Statistics rpe_translation_per_frame_m;
  Statistics rpe_rotation_per_frame_deg;
  /// Errors over the first motion of at least 1 m from each pose, divided by its path length.
  Statistics rpe_translation_per_metre_m;
  Statistics rpe_rotation_per_metre_deg;

  double end_point_drift_percent = 0;
  std::vector<SegmentDrift> segment_drifts;

  bool has_times = false;
  MatchedTrajectories matched;  ///< the poses compared, with the truth in optical axes
  // The same after SE(3) alignment of the estimate, for the plot.
  MatchedTrajectories aligned;
};

/// Compares whatever can be compared and records in `remarks` what was assumed and what is
/// doubtful. Throws InputError if no figure would be right: fewer than two poses match, rows
/// without times differ in number, poses are inverted, there are more poses than frames, or the
/// ground truth's axes remain unknown although the positions do not fit.
TrajectoryReport EvaluateTrajectory(const Trajectory& estimate, const Trajectory& ground_truth,
                                    const EvaluationOptions& options);

/// Aligned columns for a terminal, with the remarks last.
std::string ToTable(const TrajectoryReport& report);
/// The same figures as JSON; each key includes its unit.
nlohmann::json ToJson(const TrajectoryReport& report);
nlohmann::json RemarksToJson(const Remarks& remarks);
/// "WARNING: ..." or "NOTE: ..."
std::string ToLine(const Remark& remark);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_REPORT_H_
