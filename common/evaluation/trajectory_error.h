#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_ERROR_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_ERROR_H_

#include <vector>

#include "common/evaluation/trajectory.h"

namespace airdos {

// Notation: P_i pose of the estimate, Q_i of the ground truth, i = 0 .. n-1 the matched poses; the
// path length is that of the ground truth's matched poses. The error of the relative motion from i
// to j is E_ij = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) (Sturm et al., IROS 2012).

/// Absolute trajectory error: distance of the positions (m) at each matched pose.
std::vector<double> PositionErrors(const std::vector<TrajectoryPose>& estimate,
                                   const std::vector<TrajectoryPose>& ground_truth);

/// The error of one relative motion.
struct RelativeError {
  double translation_m = 0;  ///< |trans(E_ij)|
  double rotation_deg = 0;   ///< angle of rot(E_ij)
  double path_m = 0;         ///< path length from i to j
};
RelativeError ErrorOfMotion(const MatchedTrajectories& matched, std::size_t i, std::size_t j);

/// Relative pose error from each matched pose to the next. Where the estimate lacks frames, the
/// next matched pose is not the next frame.
std::vector<RelativeError> ErrorsPerFrame(const MatchedTrajectories& matched);

/// A step that is wrong by more than one of these has lost the camera: at walking pace it moves
/// about as far from one frame to the next, and half of that is no tracking any more.
constexpr double kLostTranslationM = 0.10;
constexpr double kLostRotationDeg = 2.0;
/// Frames lost: those without a pose (of `num_frames`, at least the matched ones), and those whose
/// step from the last frame with a pose is wrong by more than kLostTranslationM or kLostRotationDeg
/// (see ErrorsPerFrame). The first pose has no step and is never lost.
std::size_t CountLostFrames(const MatchedTrajectories& matched, std::size_t num_frames);

/// The error of the motion from each i to the first j with a path of at least `length_m` between
/// them; poses with no such j are left out.
std::vector<RelativeError> ErrorsOverLength(const MatchedTrajectories& matched, double length_m);

/// Mean error of all segments of one length as in the KITTI benchmark: translation error divided by
/// the length, in %, and rotation error divided by the length. Segments start at every pose.
struct SegmentDrift {
  double length_m = 0;
  std::size_t num_segments = 0;
  double translation_percent = 0;
  double rotation_deg_per_m = 0;
};
/// For the lengths 5, 10, 20, 50, 100, 200, 300, ... 800 m that the path is long enough for.
/// (KITTI's own figures are those of 100 m and more.)
std::vector<SegmentDrift> SegmentDrifts(const MatchedTrajectories& matched);

/// |trans(E_ij)| from the first matched pose to the last, in % of the path length; 0 where the path
/// is.
double EndPointDriftPercent(const MatchedTrajectories& matched);

/// Angle (deg) of a rotation matrix that is orthogonal up to rounding.
double RotationAngleDeg(const Eigen::Matrix3d& R);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_ERROR_H_
