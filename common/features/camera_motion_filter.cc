#include "common/features/camera_motion_filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace airdos {
namespace {

constexpr std::size_t kNumAccelerations = 20;
constexpr std::size_t kMinAccelerations = 3;

double MedianOfNorms(const std::deque<Vector6d>& values, int begin) {
  std::vector<double> norms;
  for (const Vector6d& value : values) norms.push_back(value.segment<3>(begin).norm());
  const auto middle = norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2);
  std::nth_element(norms.begin(), middle, norms.end());
  return *middle;
}

Matrix6d Symmetric(const Matrix6d& m) { return 0.5 * (m + m.transpose()); }

double Trace(const Matrix6d& m, int begin) { return m.block<3, 3>(begin, begin).trace(); }

}  // namespace

CameraMotionFilter::CameraMotionFilter(const CameraMotionFilterOptions& options)
    : options_(options),
      linear_sigma_m_s2_(options.linear_start_m_s2),
      angular_sigma_rad_s2_(options.angular_start_rad_s2) {
  velocity_covariance_.diagonal().head<3>().setConstant(options.initial_speed_m_s *
                                                        options.initial_speed_m_s);
  velocity_covariance_.diagonal().tail<3>().setConstant(options.initial_turn_rad_s *
                                                        options.initial_turn_rad_s);
}

double CameraMotionFilter::Memory(double step_s) const {
  return std::exp(-step_s / options_.memory_s);
}

CameraMotionFilter::Joint CameraMotionFilter::Propagate(double step_s) const {
  // The error of the pose, expressed in the axes of the next frame:
  //   d_t' = R^T (d_t - [v dt]_x d_r) + dt d_v,   d_r' = R^T d_r + dt d_w,   R = Exp(w dt).
  const double memory = Memory(step_s);
  const Vector6d step = memory * step_s * velocity_;
  const Eigen::Matrix3d R_transposed = ExpSo3(step.tail<3>()).toRotationMatrix().transpose();
  Matrix6d F = Matrix6d::Zero();
  F.topLeftCorner<3, 3>() = R_transposed;
  F.topRightCorner<3, 3>() = -R_transposed * Skew(step.head<3>());
  F.bottomRightCorner<3, 3>() = R_transposed;

  Vector6d q;  // variance of the change of velocity
  q.head<3>().setConstant(linear_sigma_m_s2_ * linear_sigma_m_s2_ * step_s * step_s);
  q.tail<3>().setConstant(angular_sigma_rad_s2_ * angular_sigma_rad_s2_ * step_s * step_s);
  const Matrix6d velocity = memory * memory * velocity_covariance_ + Matrix6d(q.asDiagonal());
  const Matrix6d velocity_pose =
      memory * velocity_pose_ * F.transpose();  // before the step in velocity
  Joint joint;
  joint.velocity = velocity;
  joint.velocity_pose = velocity_pose + step_s * velocity;
  joint.pose =
      Symmetric(F * pose_ * F.transpose() + step_s * (velocity_pose + velocity_pose.transpose()) +
                step_s * step_s * velocity);
  joint.process = step_s * step_s * Matrix6d(q.asDiagonal());
  return joint;
}

PosePrior CameraMotionFilter::Predict(const Se3& T_W_C_last, double step_s) const {
  return {Boxplus(T_W_C_last, Memory(step_s) * step_s * velocity_), Propagate(step_s).pose};
}

void CameraMotionFilter::Update(const PosePrior& prior, double step_s, const Se3& T_W_C,
                                const Matrix6d& information, bool is_learnable) {
  const Joint predicted = Propagate(step_s);
  const Vector6d innovation = Boxminus(T_W_C, prior.T_W_C);
  const Eigen::LDLT<Matrix6d> ldlt(predicted.pose);
  // P+ = (P^-1 + H)^-1 = P (I + H P)^-1, which needs no inverse of H.
  const Matrix6d posterior =
      Symmetric(predicted.pose * (Matrix6d::Identity() + information * predicted.pose).inverse());
  const Matrix6d gain = ldlt.solve(predicted.velocity_pose.transpose()).transpose();
  if (is_learnable) LearnAcceleration(predicted, innovation, information, step_s);
  velocity_ = Memory(step_s) * velocity_ + gain * innovation;
  velocity_covariance_ =
      Symmetric(predicted.velocity - gain * (predicted.pose - posterior) * gain.transpose());
  velocity_pose_ = gain * posterior;
  pose_ = posterior;
}

void CameraMotionFilter::LearnAcceleration(const Joint& predicted, const Vector6d& innovation,
                                           const Matrix6d& information, double step_s) {
  // In a frame that sees little, or right after one, the prediction is off because little is known.
  // That must not make it less certain for the very frames that depend on it.
  constexpr double kUnobserved = 1e-6;  // information; a sigma of a kilometre
  const Matrix6d measured = (information + kUnobserved * Matrix6d::Identity()).inverse();
  for (const int begin : {0, 3}) {
    const double process = Trace(predicted.process, begin);
    if (!(Trace(measured, begin) < 0.25 * process)) return;
    if (!(Trace(predicted.pose, begin) < 2 * process)) return;
  }
  accelerations_.push_back(innovation / (step_s * step_s));
  if (accelerations_.size() > kNumAccelerations) accelerations_.pop_front();
  if (accelerations_.size() < kMinAccelerations) return;
  linear_sigma_m_s2_ = std::clamp(3 * MedianOfNorms(accelerations_, 0), options_.linear_floor_m_s2,
                                  options_.linear_ceiling_m_s2);
  angular_sigma_rad_s2_ =
      std::clamp(3 * MedianOfNorms(accelerations_, 3), options_.angular_floor_rad_s2,
                 options_.angular_ceiling_rad_s2);
}

}  // namespace airdos
