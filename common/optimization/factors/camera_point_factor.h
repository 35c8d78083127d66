#ifndef AIRDOS_COMMON_OPTIMIZATION_FACTORS_CAMERA_POINT_FACTOR_H_
#define AIRDOS_COMMON_OPTIMIZATION_FACTORS_CAMERA_POINT_FACTOR_H_

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "common/optimization/solver/pose_manifold.h"

namespace airdos {

/// A point measured in the camera frame with the same noise on each axis, as in the paper's
/// simulation:
///
///   r = (R_W_C^T (p_W - t_W_C) - z_C) / sigma
///
/// Blocks: T_W_C (7), p_W (3). z_C and sigma in m.
class CameraPointFactor final : public ceres::SizedCostFunction<3, kPoseBlockSize, 3> {
 public:
  CameraPointFactor(const Eigen::Vector3d& z_C, double sigma_m) : z_C_(z_C), weight_(1 / sigma_m) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Vector3d z_C_;
  double weight_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_FACTORS_CAMERA_POINT_FACTOR_H_
