#ifndef AIRDOS_COMMON_OPTIMIZATION_WINDOW_FRAME_INPUT_H_
#define AIRDOS_COMMON_OPTIMIZATION_WINDOW_FRAME_INPUT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/geometry/se3.h"
#include "common/util/ids.h"

namespace airdos {

/// A static landmark as the frontend saw it in one frame.
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
  /// Of uvu_px; positive definite. Where the disparity was measured in the images, the errors of
  /// u_left and u_right are correlated: depth is known far better than either column alone would
  /// suggest.
  Eigen::Matrix3d covariance_px2 = Eigen::Matrix3d::Identity();
};

/// One person in one frame.
struct HumanObservation {
  HumanId id;
  std::vector<JointObservation> joints;  ///< sorted by joint, each at most once
};

/// Everything that was measured in one stereo frame.
struct FrameInput {
  FrameId id;
  double time_s = 0;
  /// The frontend's pose in its odometry frame O, which is never corrected: only the change between
  /// frames is used. Nothing if the frontend did not report one.
  std::optional<Se3> T_O_C;
  /// First frame of O. Poses in different O cannot be compared: the frontend was restarted in
  /// between.
  FrameId odometry_start;
  /// The frontend's pose in W, as it knows it from earlier answers of the optimizer. Used in the
  /// first frame only, to tie it to W; without it, T_O_C does so.
  std::optional<Se3> T_W_C;
  /// Error of the constant-velocity prediction in this frame, as the frontend has learnt it for its
  /// carrier: standard deviation per axis of the pose. Nothing if it did not report one.
  std::optional<double> motion_sigma_position_m;
  std::optional<double> motion_sigma_orientation_rad;
  std::vector<StaticObservation> features;
  std::vector<HumanObservation> humans;  ///< sorted by id
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_WINDOW_FRAME_INPUT_H_
