#ifndef AIRDOS_COMMON_FEATURES_CAMERA_MOTION_FILTER_H_
#define AIRDOS_COMMON_FEATURES_CAMERA_MOTION_FILTER_H_

#include <deque>

#include "common/features/pose_estimator.h"
#include "common/geometry/se3.h"

namespace airdos {

/// Settings of the CameraMotionFilter.
struct CameraMotionFilterOptions {
  /// Standard deviation per axis of the acceleration: first `start`, then three times the median
  /// over the last frames, limited to `floor` .. `ceiling`.
  double linear_start_m_s2 = 5;
  double linear_floor_m_s2 = 3;
  double linear_ceiling_m_s2 = 30;
  double angular_start_rad_s2 = 10;
  double angular_floor_rad_s2 = 3;
  double angular_ceiling_rad_s2 = 50;
  /// Standard deviation of the velocity before the first step.
  double initial_speed_m_s = 2;
  double initial_turn_rad_s = 1;
  /// Without measurements, the velocity decays to 1/e in this time.
  double memory_s = 3;
};

/// Predicts where the camera will be: a constant-velocity filter. Pose and velocity (in the tangent
/// of common/geometry/se3.h, in C) change from frame to frame by
///
///   T_k = T_km1 [+] dt v_k,   v_k = exp(-dt / memory) v_km1 + dt a_k,   a_k ~ N(0, sigma_a^2),
///
/// and each frame's pose, with its information, corrects both. A frame that saw little changes the
/// velocity little, and the prediction from it is less certain. Because the velocity decays, a
/// camera that sees nothing for several frames comes to rest instead of running away.
class CameraMotionFilter {
 public:
  explicit CameraMotionFilter(const CameraMotionFilterOptions& options);

  /// Predicts the next frame, `step_s` after the last, from the last frame's pose.
  PosePrior Predict(const Se3& T_W_C_last, double step_s) const;

  /// Takes in a frame's pose. `prior` is the output of Predict() for it; `information` is what the
  /// frame's own measurements contribute to T_W_C, without the prior: zero for none. Only frames
  /// that are `learnable` are used to estimate the carrier's acceleration.
  void Update(const PosePrior& prior, double step_s, const Se3& T_W_C, const Matrix6d& information,
              bool is_learnable);

  /// Covariance of the last pose relative to the landmarks that it was measured from.
  const Matrix6d& pose_covariance() const { return pose_; }
  double linear_sigma_m_s2() const { return linear_sigma_m_s2_; }
  double angular_sigma_rad_s2() const { return angular_sigma_rad_s2_; }

 private:
  double Memory(double step_s) const;
  /// Joint covariance of pose and velocity after the prediction, before the measurement.
  struct Joint {
    Matrix6d pose;
    Matrix6d velocity;
    Matrix6d velocity_pose;  ///< cross covariance
    Matrix6d process;        ///< the unknown acceleration's part of `pose`
  };
  Joint Propagate(double step_s) const;
  void LearnAcceleration(const Joint& predicted, const Vector6d& innovation,
                         const Matrix6d& information, double step_s);

  CameraMotionFilterOptions options_;
  Vector6d velocity_ = Vector6d::Zero();
  Matrix6d pose_ = Matrix6d::Zero();
  Matrix6d velocity_covariance_ = Matrix6d::Zero();
  Matrix6d velocity_pose_ = Matrix6d::Zero();
  double linear_sigma_m_s2_;
  double angular_sigma_rad_s2_;
  std::deque<Vector6d> accelerations_;  // of the last frames that measured them well
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_CAMERA_MOTION_FILTER_H_
