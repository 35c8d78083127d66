#ifndef AIRDOS_COMMON_OPTIMIZATION_FACTORS_CAMERA_ACCELERATION_FACTOR_H_
#define AIRDOS_COMMON_OPTIMIZATION_FACTORS_CAMERA_ACCELERATION_FACTOR_H_

#include <ceres/sized_cost_function.h>

#include "common/optimization/factors/acceleration_sigma.h"
#include "common/optimization/solver/pose_manifold.h"

namespace airdos {

// clang-format off
/// Acceleration of the camera between three consecutive frames 0, 1, 2 (not in the paper):
///
///   v_i = (t_i - t_{i-1}) / h_i,    w_i = Log(R_{i-1}^T R_i) / h_i    (i = 1, 2)
///   h   = (h_1 + h_2) / 2
///   r   = ((v_2 - v_1) / (h sigma_linear), (w_2 - w_1) / (h sigma_angular))
// clang-format on
///
/// h_i are the time steps in s, so a dropped frame or an uneven frame rate does not look like a
/// jerk.
/// Blocks: T_W_C of the three frames (7 each).
class CameraAccelerationFactor final
    : public ceres::SizedCostFunction<6, kPoseBlockSize, kPoseBlockSize, kPoseBlockSize> {
 public:
  /// Both steps must be positive.
  CameraAccelerationFactor(double step_1_s, double step_2_s, const AccelerationSigma& sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double step_1_s_;
  double step_2_s_;
  double weight_linear_;
  double weight_angular_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_FACTORS_CAMERA_ACCELERATION_FACTOR_H_
