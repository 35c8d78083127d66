#include "common/optimization/solver/pose_manifold.h"

#include <algorithm>

namespace airdos {

PoseBlock ToPoseBlock(const Se3& T_A_B) {
  PoseBlock block;
  Eigen::Map<Eigen::Vector3d>{block.data()} = T_A_B.translation;
  Eigen::Map<Eigen::Vector4d>(block.data() + 3) = T_A_B.rotation.coeffs();
  return block;
}

Se3 FromPoseBlock(const double* block) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(block + 3)),
          Eigen::Map<const Eigen::Vector3d>(block)};
}

bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const PoseBlock block = ToPoseBlock(Boxplus(FromPoseBlock(x), Eigen::Map<const Vector6d>(delta)));
  std::copy(block.begin(), block.end(), x_plus_delta);
  return true;
}

bool PoseManifold::PlusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> J(jacobian);
  J.setZero();
  J.topRows<6>().setIdentity();
  return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  Eigen::Map<Vector6d>{y_minus_x} = Boxminus(FromPoseBlock(y), FromPoseBlock(x));
  return true;
}

bool PoseManifold::MinusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobian);
  J.setZero();
  J.leftCols<6>().setIdentity();
  return true;
}

}  // namespace airdos
