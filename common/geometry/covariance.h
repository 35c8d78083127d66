#ifndef AIRDOS_COMMON_GEOMETRY_COVARIANCE_H_
#define AIRDOS_COMMON_GEOMETRY_COVARIANCE_H_

#include <Eigen/Core>
#include <optional>

#include "common/geometry/se3.h"

namespace airdos {

// What is done with covariances in many places: Eigen's code for it takes seconds to compile, here
// once.

/// The squared Mahalanobis distance e^T S^-1 e of an error with covariance S: chi-squared of as
/// many degrees of freedom as the error has. NaN if S is.
double SquaredMahalanobis(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance);
double SquaredMahalanobis(const Vector6d& error, const Matrix6d& covariance);

/// J S J^T: the covariance of J x, if that of x is S.
Eigen::Matrix3d Propagated(const Eigen::Matrix3d& J, const Eigen::Matrix3d& covariance);
Eigen::Matrix3d Propagated(const Eigen::Matrix<double, 3, 6>& J, const Matrix6d& covariance);
Matrix6d Propagated(const Matrix6d& J, const Matrix6d& covariance);

/// From covariance to information and back; not finite if it is singular.
Eigen::Matrix3d Inverse(const Eigen::Matrix3d& covariance);
Matrix6d Inverse(const Matrix6d& covariance);

/// x with H x = b; nullopt if H is not positive.
std::optional<Vector6d> SolvePositive(const Matrix6d& H, const Vector6d& b);

}  // namespace airdos

#endif  // AIRDOS_COMMON_GEOMETRY_COVARIANCE_H_
