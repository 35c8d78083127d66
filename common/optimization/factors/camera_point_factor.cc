#include "common/optimization/factors/camera_point_factor.h"

namespace airdos {

bool CameraPointFactor::Evaluate(double const* const* parameters, double* residuals,
                                 double** jacobians) const {
  const Se3 T_W_C = FromPoseBlock(parameters[0]);
  const Eigen::Map<const Eigen::Vector3d> p_W(parameters[1]);
  const Eigen::Matrix3d R_C_W = T_W_C.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d p_C = R_C_W * (p_W - T_W_C.translation);
  Eigen::Map<Eigen::Vector3d>{residuals} = weight_ * (p_C - z_C_);
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 3, kPoseBlockSize, Eigen::RowMajor>> J(jacobians[0]);
    J.leftCols<3>() = -weight_ * Eigen::Matrix3d::Identity();
    J.middleCols<3>(3) = weight_ * Skew(p_C);
    J.col(6).setZero();
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{jacobians[1]} = weight_ * R_C_W;
  }
  return true;
}

}  // namespace airdos
