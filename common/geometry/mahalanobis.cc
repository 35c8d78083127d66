#include "common/geometry/mahalanobis.h"

#include <Eigen/Cholesky>

namespace airdos {

double SquaredMahalanobis(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

double SquaredMahalanobis(const Vector6d& error, const Matrix6d& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

}  // namespace airdos
