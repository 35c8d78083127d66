#ifndef AIRDOS_COMMON_OPTIMIZATION_FACTORS_REPROJECTION_FACTOR_H_
#define AIRDOS_COMMON_OPTIMIZATION_FACTORS_REPROJECTION_FACTOR_H_

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <algorithm>

#include "common/geometry/stereo_camera.h"
#include "common/optimization/solver/pose_manifold.h"

namespace airdos {

/// Reprojection of a point, a static landmark (paper, eq. 1) or a joint (eq. 2), into a stereo
/// frame:
///
///   p_C = R_W_C^T (p_W - t_W_C)
///   r   = U (project(p_C) - (u_left, v, u_right)),   U^T U = covariance^-1
///
/// in standard deviations. kRows is 3, or 2 where the right image has no measurement. With the
/// pose's tangent (d_t, d_r): d p_C = -d_t + [p_C]_x d_r + R_W_C^T d p_W.
/// A point that is closer than kMinDepth_m, or behind the camera, is projected as if it were at
/// that depth, so the error stays finite and pulls the point forward again.
/// Blocks: T_W_C (7), p_W (3).
template <int kRows>
class ReprojectionFactor final : public ceres::SizedCostFunction<kRows, kPoseBlockSize, 3> {
  static_assert(kRows == 2 || kRows == 3, "left only, or left and right");

 public:
  static constexpr double kMinDepth_m = 0.05;

  using Weight = Eigen::Matrix<double, kRows, kRows>;

  /// `camera` is not owned and must outlive the factor. All coordinates share one standard
  /// deviation.
  ReprojectionFactor(const StereoCamera* camera, const Eigen::Vector3d& uvu_px, double sigma_px)
      : ReprojectionFactor(camera, uvu_px, Weight(Weight::Identity() / sigma_px)) {}
  /// `sqrt_information` is U, in 1 / px.
  ReprojectionFactor(const StereoCamera* camera, const Eigen::Vector3d& uvu_px,
                     const Weight& sqrt_information)
      : camera_(camera), uvu_px_(uvu_px), weight_(sqrt_information) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Se3 T_W_C = FromPoseBlock(parameters[0]);
    const Eigen::Map<const Eigen::Vector3d> p_W(parameters[1]);
    const Eigen::Matrix3d R_C_W = T_W_C.rotation.toRotationMatrix().transpose();
    Eigen::Vector3d p_C = R_C_W * (p_W - T_W_C.translation);
    p_C.z() = std::max(p_C.z(), kMinDepth_m);
    Eigen::Map<Eigen::Matrix<double, kRows, 1>> r(residuals);
    r = weight_ * (camera_->ProjectStereo(p_C) - uvu_px_).template head<kRows>();
    if (jacobians == nullptr) return true;

    const Eigen::Matrix<double, kRows, 3> J_p_C =
        weight_ * camera_->ProjectStereoJacobian(p_C).template topRows<kRows>();
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, kRows, kPoseBlockSize, Eigen::RowMajor>> J(jacobians[0]);
      J.template leftCols<3>() = -J_p_C;
      J.template middleCols<3>(3) = J_p_C * Skew(p_C);
      J.col(6).setZero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, kRows, 3, Eigen::RowMajor>> J(jacobians[1]);
      J = J_p_C * R_C_W;
    }
    return true;
  }

 private:
  const StereoCamera* camera_;
  Eigen::Vector3d uvu_px_;
  Weight weight_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_FACTORS_REPROJECTION_FACTOR_H_
