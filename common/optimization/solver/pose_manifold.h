#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_POSE_MANIFOLD_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_POSE_MANIFOLD_H_

#include <ceres/manifold.h>

#include <array>

#include "common/geometry/se3.h"

namespace airdos {

inline constexpr int kPoseBlockSize = 7;
/// A rigid transform T_A_B in Ceres' layout: translation (m), then the quaternion x, y, z, w.
using PoseBlock = std::array<double, kPoseBlockSize>;

PoseBlock ToPoseBlock(const Se3& T_A_B);
Se3 FromPoseBlock(const double* block);

/// Moves a PoseBlock along the tangent of common/geometry/se3.h. PlusJacobian is [I6; 0], so a
/// factor writes its derivatives with respect to that tangent into the first six columns and zeros
/// into the seventh.
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPoseBlockSize; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_POSE_MANIFOLD_H_
