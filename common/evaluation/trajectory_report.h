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

namespace airdos {

struct EvaluationOptions {
  double max_time_difference_s = 0.01;
  std::optional<GroundTruthAxes> axes;  ///< nothing: find out
  /// Images of the sequence, for the completeness; 0: as many as the ground truth has poses.
  std::size_t num_frames = 0;
};

/// Other axes of the ground truth that the motion fits as well, and what follows from them.
struct AxesAlternative {
  GroundTruthAxes axes;
  Statistics ate_se3_m;
};

/// Everything that is said of one estimated trajectory.
struct TrajectoryReport {
  std::size_t num_estimate = 0;
  std::size_t num_ground_truth = 0;
  std::size_t num_matched = 0;
  double completeness = 0;     ///< matched poses / frames (see EvaluationOptions::num_frames)
  std::size_t num_frames = 0;  ///< EvaluationOptions::num_frames, or what stands for it
  std::size_t num_lost = 0;    ///< see CountLostFrames()
  double path_m = 0;           ///< of the ground truth's matched poses
  double duration_s = 0;       ///< of the matched poses; 0 for KITTI rows

  GroundTruthAxes axes;
  std::string axes_reason;
  std::vector<AxesAlternative> alternatives;  ///< none where the axes were given

  Statistics ate_none_m;
  Statistics ate_se3_m;   ///< after the best rigid motion of the estimate's world
  Statistics ate_sim3_m;  ///< and scale
  double sim3_scale = 1;

  Statistics rpe_translation_per_frame_m;
  Statistics rpe_rotation_per_frame_deg;
  /// Errors over the first motion of at least 1 m from each pose, divided by its path.
  Statistics rpe_translation_per_metre_m;
  Statistics rpe_rotation_per_metre_deg;

  double end_point_drift_percent = 0;
  std::vector<SegmentDrift> segment_drifts;

  // For the plot: in optical axes, the estimate after SE(3) alignment.
  bool has_times = false;
  MatchedTrajectories aligned;
};

/// Throws InputError where fewer than two poses match or the ground truth's axes remain unknown.
TrajectoryReport EvaluateTrajectory(const Trajectory& estimate, const Trajectory& ground_truth,
                                    const EvaluationOptions& options);

/// Aligned columns for a terminal.
std::string ToTable(const TrajectoryReport& report);
/// The same figures; the unit is in each key.
nlohmann::json ToJson(const TrajectoryReport& report);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_REPORT_H_
