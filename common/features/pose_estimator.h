#ifndef AIRDOS_COMMON_FEATURES_POSE_ESTIMATOR_H_
#define AIRDOS_COMMON_FEATURES_POSE_ESTIMATOR_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// A point and where a stereo frame sees it.
struct PoseObservation {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();  ///< u_left, v, u_right
  bool has_right = false;
  double sigma_px = 1;
  double weight = 1;  ///< in the estimate, 0..1; does not affect who is an inlier
  Eigen::Matrix3d covariance_W = Eigen::Matrix3d::Zero();  ///< m^2, of p_W; zero if p_W is exact
};

/// Prior knowledge of a pose: mean, and covariance of its tangent in C (see Boxplus).
struct PosePrior {
  Se3 T_W_C;
  Matrix6d covariance = Matrix6d::Identity();  ///< m, rad
};
/// A prior with the same sigmas on all axes.
PosePrior IsotropicPrior(const Se3& T_W_C, double sigma_position_m, double sigma_orientation_rad);

/// A pose and what it rests on.
struct PoseEstimate {
  Se3 T_W_C;
  std::vector<bool> is_inlier;  ///< per observation: within the 95 % chi-square bound
  int num_inliers = 0;
  Matrix6d information =
      Matrix6d::Zero();  ///< of the tangent, from the inliers only, without the prior
};

/// Estimates the pose of one frame from stereo reprojection errors (paper, eq. 1) by Gauss-Newton
/// with Huber weights, starting at `start`. After each of a few rounds, observations beyond the 95
/// % chi-square bound are excluded; they may come back in the next round. Without a prior and
/// without enough observations the result is `start`.
/// Few observations cannot check each other: with fewer than 20, those that contradict a given
/// prior are left out from the beginning.
PoseEstimate EstimatePose(const StereoCamera& camera,
                          const std::vector<PoseObservation>& observations, const Se3& start,
                          const std::optional<PosePrior>& prior);

/// An initial pose without prior knowledge: AP3P in RANSAC (seeded), on the left image only.
/// Nothing if fewer than 6 points agree.
std::optional<Se3> EstimatePoseRansac(const StereoCamera& camera,
                                      const std::vector<PoseObservation>& observations,
                                      double max_error_px);

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_POSE_ESTIMATOR_H_
