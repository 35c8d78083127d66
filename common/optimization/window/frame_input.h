#ifndef AIRDOS_COMMON_OPTIMIZATION_WINDOW_FRAME_INPUT_H_
#define AIRDOS_COMMON_OPTIMIZATION_WINDOW_FRAME_INPUT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/geometry/se3.h"
#include "common/util/ids.h"

namespace airdos {

/// A static landmark as the front end saw it in one frame.
struct StaticObservation {
  LandmarkId id;
  Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();  ///< u_left, v, u_right
  bool has_right = true;                             ///< if false, u_right is not a measurement
  double sigma_px = 1;
};

/// One joint of one person in one frame.
struct JointObservation {
  int joint = 0;  ///< COCO-18, 0..13
  Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();
  /// Of uvu_px; positive definite. Where the disparity was measured in the images, u_left and
  /// u_right err together: the depth is known far better than either says by itself.
  Eigen::Matrix3d covariance_px2 = Eigen::Matrix3d::Identity();
};

struct HumanObservation {
  HumanId id;
  std::vector<JointObservation> joints;  ///< sorted by joint, each at most once
};

/// Everything that was measured in one stereo frame.
struct FrameInput {
  FrameId id;
  double time_s = 0;
  /// The front end's pose in its odometry frame O, which is never corrected: only the change from
  /// frame to frame is used. Nothing where the front end said nothing.
  std::optional<Se3> T_O_C;
  /// First frame of O: poses in different O cannot be compared (the front end was started again).
  FrameId odometry_start;
  /// The front end's pose in W as it knows it from earlier answers. Used in the first frame only,
  /// which it ties to W; without it T_O_C does.
  std::optional<Se3> T_W_C;
  /// By how much constant velocity may be wrong in this frame, as the front end has learnt of its
  /// carrier: standard deviation per axis of the pose. Nothing if it did not say.
  std::optional<double> motion_sigma_position_m;
  std::optional<double> motion_sigma_orientation_rad;
  std::vector<StaticObservation> features;
  std::vector<HumanObservation> humans;  ///< sorted by id
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_WINDOW_FRAME_INPUT_H_
