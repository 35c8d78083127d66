#ifndef AIRDOS_COMMON_GEOMETRY_SE3_H_
#define AIRDOS_COMMON_GEOMETRY_SE3_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace airdos {

/// A tangent of SE(3), translation first, and a covariance of it: see Boxplus().
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The skew-symmetric matrix [v]_x: Skew(v) * w = v x w.
Eigen::Matrix3d Skew(const Eigen::Vector3d& v);

/// Rotation vector (rad) to unit quaternion, and back. The angle of LogSo3 is in [0, pi].
Eigen::Quaterniond ExpSo3(const Eigen::Vector3d& rotation_vector);
Eigen::Vector3d LogSo3(const Eigen::Quaterniond& q);

/// Right Jacobian of SO(3): ExpSo3(v + d) ~ ExpSo3(v) * ExpSo3(RightJacobianSo3(v) * d), and its
/// inverse.
Eigen::Matrix3d RightJacobianSo3(const Eigen::Vector3d& v);
Eigen::Matrix3d RightJacobianInverseSo3(const Eigen::Vector3d& v);

/// A rigid transform T_A_B as unit quaternion and translation: p_A = T_A_B * p_B.
struct Se3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Se3 inverse() const;
  Eigen::Matrix4d matrix() const;
  friend Se3 operator*(const Se3& T_A_B, const Se3& T_B_C);
  friend Eigen::Vector3d operator*(const Se3& T_A_B, const Eigen::Vector3d& p_B);
};

/// The tangent used everywhere: delta = (translation in m, rotation in rad), both in the body frame
/// B, applied as
///   translation' = translation + R * delta_t,   R' = R * Exp(delta_r).
/// Boxminus is the inverse: Boxplus(T, Boxminus(T2, T)) = T2.
Se3 Boxplus(const Se3& T_A_B, const Vector6d& delta);
Vector6d Boxminus(const Se3& T_A_B2, const Se3& T_A_B);

}  // namespace airdos

#endif  // AIRDOS_COMMON_GEOMETRY_SE3_H_
