#include "common/geometry/se3.h"

#include <cmath>

namespace airdos {
namespace {
constexpr double kSmallAngle =
    1e-5;  // below it the second-order series is exact to double precision
}  // namespace

Eigen::Matrix3d Skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Quaterniond ExpSo3(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  const double half_sinc =
      angle < kSmallAngle ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = half_sinc * rotation_vector;
  return q.normalized();
}

Eigen::Vector3d LogSo3(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;  // the shorter way around
  const double sine = q.vec().norm();
  const double cosine = sign * q.w();
  const double factor = sine < kSmallAngle ? 2.0 / cosine : 2.0 * std::atan2(sine, cosine) / sine;
  return sign * factor * q.vec();
}

Eigen::Matrix3d RightJacobianSo3(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  const Eigen::Matrix3d K = Skew(v);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() - 0.5 * K + K * K / 6.0;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / a2 * K +
         (angle - std::sin(angle)) / (a2 * angle) * K * K;
}

Eigen::Matrix3d RightJacobianInverseSo3(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  const Eigen::Matrix3d K = Skew(v);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() + 0.5 * K + K * K / 12.0;
  const double half = 0.5 * angle;
  const double factor = (1 - half * std::cos(half) / std::sin(half)) / (angle * angle);
  return Eigen::Matrix3d::Identity() + 0.5 * K + factor * K * K;
}

Se3 Se3::inverse() const {
  const Eigen::Quaterniond q = rotation.conjugate();
  return {q, -(q * translation)};
}

Eigen::Matrix4d Se3::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
  m.topRightCorner<3, 1>() = translation;
  return m;
}

Se3 operator*(const Se3& T_A_B, const Se3& T_B_C) {
  return {(T_A_B.rotation * T_B_C.rotation).normalized(), T_A_B * T_B_C.translation};
}

Eigen::Vector3d operator*(const Se3& T_A_B, const Eigen::Vector3d& p_B) {
  return T_A_B.rotation * p_B + T_A_B.translation;
}

Se3 Boxplus(const Se3& T_A_B, const Vector6d& delta) {
  return {(T_A_B.rotation * ExpSo3(delta.tail<3>())).normalized(),
          T_A_B.translation + T_A_B.rotation * delta.head<3>()};
}

Vector6d Boxminus(const Se3& T_A_B2, const Se3& T_A_B) {
  Vector6d delta;
  delta.head<3>() = T_A_B.rotation.conjugate() * (T_A_B2.translation - T_A_B.translation);
  delta.tail<3>() = LogSo3(T_A_B.rotation.conjugate() * T_A_B2.rotation);
  return delta;
}

}  // namespace airdos
