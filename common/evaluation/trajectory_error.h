#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_ERROR_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_ERROR_H_

#include <vector>

#include "common/evaluation/trajectory.h"

namespace airdos {

// Notation: P_i is the pose of the estimate and Q_i that of the ground truth for the matched poses
// i = 0 .. n-1. Path lengths are those of the ground truth's matched poses. The error of the
// relative motion from i to j is E_ij = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) (Sturm et al., IROS 2012).

/// Absolute trajectory error: distance between the positions (m) at each matched pose.
std::vector<double> PositionErrors(const std::vector<TrajectoryPose>& estimate,
                                   const std::vector<TrajectoryPose>& ground_truth);

/// Error of one relative motion.
struct RelativeError {
  double translation_m = 0;  ///< |trans(E_ij)|
  double rotation_deg = 0;   ///< angle of rot(E_ij)
  double path_m = 0;         ///< path length from i to j
};
RelativeError ErrorOfMotion(const MatchedTrajectories& matched, std::size_t i, std::size_t j);

/// Relative pose error from each matched pose to the next. If the estimate lacks frames, the next
/// matched pose is not the next frame.
std::vector<RelativeError> ErrorsPerFrame(const MatchedTrajectories& matched);

/// A step with an error above one of these limits has lost the camera: at walking pace, the camera
/// moves about this far between two frames, and half of that is no tracking any more.
constexpr double kLostTranslationM = 0.10;
constexpr double kLostRotationDeg = 2.0;
/// Number of lost frames: those without a pose (out of `num_frames`, which is at least the number
/// of matched ones), and those whose step from the last frame with a pose has an error above
/// kLostTranslationM or kLostRotationDeg (see ErrorsPerFrame). The first pose has no step and is
/// never lost.
std::size_t CountLostFrames(const MatchedTrajectories& matched, std::size_t num_frames);

/// Errors of the motions from each i to the first j that is at least `length_m` of path away; poses
/// without such a j are left out.
std::vector<RelativeError> ErrorsOverLength(const MatchedTrajectories& matched, double length_m);

/// Mean error of all segments of one length, as in the KITTI benchmark: translation error divided
/// by the length, in %, and rotation error divided by the length. A segment starts at every pose.
struct SegmentDrift {
  double length_m = 0;
  std::size_t num_segments = 0;
  double translation_percent = 0;
  double rotation_deg_per_m = 0;
};
/// Drift over the lengths 5, 10, 20, 50, 100, 200, 300, ... 800 m, as far as the path is long
/// enough. (KITTI's own figures are those for 100 m and more.)
std::vector<SegmentDrift> SegmentDrifts(const MatchedTrajectories& matched);

/// |trans(E_ij)| from the first matched pose to the last, in % of the path length; 0 if that is 0.
double EndPointDriftPercent(const MatchedTrajectories& matched);

/// Angle (deg) of a rotation matrix that is orthogonal up to rounding.
double RotationAngleDeg(const Eigen::Matrix3d& R);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_ERROR_H_
