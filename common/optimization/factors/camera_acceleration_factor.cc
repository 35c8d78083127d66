#include "common/optimization/factors/camera_acceleration_factor.h"

namespace airdos {

CameraAccelerationFactor::CameraAccelerationFactor(double step_1_s, double step_2_s,
                                                   const AccelerationSigma& sigma)
    : step_1_s_(step_1_s), step_2_s_(step_2_s) {
  const double mean_step_s = 0.5 * (step_1_s + step_2_s);
  weight_linear_ = 1 / (mean_step_s * sigma.linear_m_s2);
  weight_angular_ = 1 / (mean_step_s * sigma.angular_rad_s2);
}

bool CameraAccelerationFactor::Evaluate(double const* const* parameters, double* residuals,
                                        double** jacobians) const {
  const Se3 T_W_C_0 = FromPoseBlock(parameters[0]);
  const Se3 T_W_C_1 = FromPoseBlock(parameters[1]);
  const Se3 T_W_C_2 = FromPoseBlock(parameters[2]);
  const Eigen::Vector3d turn_1 = LogSo3(T_W_C_0.rotation.conjugate() * T_W_C_1.rotation);
  const Eigen::Vector3d turn_2 = LogSo3(T_W_C_1.rotation.conjugate() * T_W_C_2.rotation);
  const double a_1 = weight_linear_ / step_1_s_, a_2 = weight_linear_ / step_2_s_;
  const double b_1 = weight_angular_ / step_1_s_, b_2 = weight_angular_ / step_2_s_;

  Eigen::Map<Vector6d> r(residuals);
  r.head<3>() = a_2 * (T_W_C_2.translation - T_W_C_1.translation) -
                a_1 * (T_W_C_1.translation - T_W_C_0.translation);
  r.tail<3>() = b_2 * turn_2 - b_1 * turn_1;
  if (jacobians == nullptr) return true;

  // Log(R_0^T R_1): d / d d_r1 = Jr^-1(turn), d / d d_r0 = -Jr^-1(-turn).
  const auto fill = [&](int block, const Se3& T_W_C, double linear,
                        const Eigen::Matrix3d& angular) {
    if (jacobians[block] == nullptr) return;
    Eigen::Map<Eigen::Matrix<double, 6, kPoseBlockSize, Eigen::RowMajor>> J(jacobians[block]);
    J.setZero();
    J.topLeftCorner<3, 3>() = linear * T_W_C.rotation.toRotationMatrix();
    J.block<3, 3>(3, 3) = angular;
  };
  fill(0, T_W_C_0, a_1, b_1 * RightJacobianInverseSo3(-turn_1));
  fill(1, T_W_C_1, -a_1 - a_2,
       -b_1 * RightJacobianInverseSo3(turn_1) - b_2 * RightJacobianInverseSo3(-turn_2));
  fill(2, T_W_C_2, a_2, b_2 * RightJacobianInverseSo3(turn_2));
  return true;
}

}  // namespace airdos
