#include "common/optimization/factors/human_factors.h"

namespace airdos {
namespace {

using ConstPoint = Eigen::Map<const Eigen::Vector3d>;
using Point = Eigen::Map<Eigen::Vector3d>;
using PointJacobian = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
using PoseJacobian = Eigen::Map<Eigen::Matrix<double, 3, kPoseBlockSize, Eigen::RowMajor>>;

void SetScaledIdentity(double** jacobians, int block, double scale) {
  if (jacobians == nullptr || jacobians[block] == nullptr) return;
  PointJacobian{jacobians[block]} = scale * Eigen::Matrix3d::Identity();
}

}  // namespace

bool RigidityFactor::Evaluate(double const* const* parameters, double* residuals,
                              double** jacobians) const {
  const Eigen::Vector3d b_to_a = ConstPoint(parameters[0]) - ConstPoint(parameters[1]);
  const double distance = b_to_a.norm();
  residuals[0] = weight_ * (distance - parameters[2][0]);
  if (jacobians == nullptr) return true;
  const Eigen::Vector3d direction =
      distance > 0 ? Eigen::Vector3d(b_to_a / distance) : Eigen::Vector3d::Zero();
  if (jacobians[0] != nullptr) Point{jacobians[0]} = weight_ * direction;
  if (jacobians[1] != nullptr) Point{jacobians[1]} = -weight_ * direction;
  if (jacobians[2] != nullptr) jacobians[2][0] = -weight_;
  return true;
}

bool LengthPriorFactor::Evaluate(double const* const* parameters, double* residuals,
                                 double** jacobians) const {
  residuals[0] = weight_ * (parameters[0][0] - known_m_);
  if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = weight_;
  return true;
}

bool VelocityFactor::Evaluate(double const* const* parameters, double* residuals,
                              double** jacobians) const {
  Point r(residuals);
  r = weight_ *
      (ConstPoint(parameters[1]) - ConstPoint(parameters[0]) - dt_s_ * ConstPoint(parameters[2]));
  SetScaledIdentity(jacobians, 0, -weight_);
  SetScaledIdentity(jacobians, 1, weight_);
  SetScaledIdentity(jacobians, 2, -weight_ * dt_s_);
  return true;
}

bool VelocitySmoothnessFactor::Evaluate(double const* const* parameters, double* residuals,
                                        double** jacobians) const {
  Point r(residuals);
  r = weight_ * (ConstPoint(parameters[1]) - ConstPoint(parameters[0]));
  SetScaledIdentity(jacobians, 0, -weight_);
  SetScaledIdentity(jacobians, 1, weight_);
  return true;
}

bool VelocityPriorFactor::Evaluate(double const* const* parameters, double* residuals,
                                   double** jacobians) const {
  Point r(residuals);
  r = weight_ * ConstPoint(parameters[0]);
  SetScaledIdentity(jacobians, 0, weight_);
  return true;
}

bool PartMotionFactor::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
  const Se3 motion = FromPoseBlock(parameters[2]);
  const Eigen::Matrix3d R = motion.rotation.toRotationMatrix();
  const Eigen::Vector3d from_centroid = ConstPoint(parameters[0]) - centroid_W_;
  Point r(residuals);
  r = weight_ * (ConstPoint(parameters[1]) - R * from_centroid - centroid_W_ - motion.translation);
  SetScaledIdentity(jacobians, 1, weight_);
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) PointJacobian{jacobians[0]} = -weight_ * R;
  if (jacobians[2] != nullptr) {
    PoseJacobian J(jacobians[2]);
    J.leftCols<3>() = -weight_ * R;
    J.middleCols<3>(3) = weight_ * R * Skew(from_centroid);
    J.col(6).setZero();
  }
  return true;
}

bool PartSmoothnessFactor::Evaluate(double const* const* parameters, double* residuals,
                                    double** jacobians) const {
  Eigen::Map<Vector6d> r(residuals);
  r.setZero();
  for (std::size_t i = 0; i < 2; ++i) {
    const double sign = i == 0 ? -1 : 1;
    const Se3 motion = FromPoseBlock(parameters[i]);
    const Eigen::Vector3d turn = LogSo3(motion.rotation);
    const double linear = sign * weight_linear_ / step_s_[i];
    const double angular = sign * weight_angular_ / step_s_[i];
    r.head<3>() += linear * motion.translation;
    r.tail<3>() += angular * turn;
    if (jacobians == nullptr || jacobians[i] == nullptr) continue;
    Eigen::Map<Eigen::Matrix<double, 6, kPoseBlockSize, Eigen::RowMajor>> J(jacobians[i]);
    J.setZero();
    J.topLeftCorner<3, 3>() = linear * motion.rotation.toRotationMatrix();
    J.block<3, 3>(3, 3) = angular * RightJacobianInverseSo3(turn);
  }
  return true;
}

bool RotationDampingFactor::Evaluate(double const* const* parameters, double* residuals,
                                     double** jacobians) const {
  const Eigen::Vector3d turn = LogSo3(FromPoseBlock(parameters[0]).rotation);
  Point r(residuals);
  r = sqrt_information_ * turn;
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  PoseJacobian J(jacobians[0]);
  J.setZero();
  J.middleCols<3>(3) = sqrt_information_ * RightJacobianInverseSo3(turn);
  return true;
}

}  // namespace airdos
