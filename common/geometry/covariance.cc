#include "common/geometry/covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace airdos {

double SquaredMahalanobis(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

double SquaredMahalanobis(const Vector6d& error, const Matrix6d& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

Eigen::Matrix3d Propagated(const Eigen::Matrix3d& J, const Eigen::Matrix3d& covariance) {
  return J * covariance * J.transpose();
}

Eigen::Matrix3d Propagated(const Eigen::Matrix<double, 3, 6>& J, const Matrix6d& covariance) {
  return J * covariance * J.transpose();
}

Matrix6d Propagated(const Matrix6d& J, const Matrix6d& covariance) {
  return J * covariance * J.transpose();
}

Eigen::Matrix3d Inverse(const Eigen::Matrix3d& covariance) { return covariance.inverse(); }

Matrix6d Inverse(const Matrix6d& covariance) { return covariance.inverse(); }

std::optional<Vector6d> SolvePositive(const Matrix6d& H, const Vector6d& b) {
  const Eigen::LDLT<Matrix6d> ldlt(H);
  if (ldlt.info() != Eigen::Success || !ldlt.isPositive()) return std::nullopt;
  return ldlt.solve(b);
}

}  // namespace airdos
