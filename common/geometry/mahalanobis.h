#ifndef AIRDOS_COMMON_GEOMETRY_MAHALANOBIS_H_
#define AIRDOS_COMMON_GEOMETRY_MAHALANOBIS_H_

#include <Eigen/Core>

#include "common/geometry/se3.h"

namespace airdos {

/// The squared Mahalanobis distance e^T S^-1 e of an error with covariance S: chi-squared of as
/// many degrees of freedom as the error has. NaN if S is.
double SquaredMahalanobis(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance);
double SquaredMahalanobis(const Vector6d& error, const Matrix6d& covariance);

}  // namespace airdos

#endif  // AIRDOS_COMMON_GEOMETRY_MAHALANOBIS_H_
