#include "common/optimization/pose_information.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "common/optimization/camera_acceleration_factor.h"
#include "common/optimization/reprojection_factor.h"

namespace airdos {
namespace {

using Matrix63 = Eigen::Matrix<double, 6, 3>;

/// Dense Hessian over the free poses, and per landmark what couples it to them.
class Hessian {
 public:
  explicit Hessian(const BundleProblem& problem) : problem_(problem) {
    for (const BundleProblem::Frame& frame : problem.frames) {
      slots_.push_back(frame.is_fixed ? -1 : num_free_++);
      blocks_.push_back(ToPoseBlock(frame.T_W_C));
    }
    poses_ = Eigen::MatrixXd::Zero(6 * num_free_, 6 * num_free_);
    landmarks_.resize(problem.landmarks.size());
  }

  int slot(int frame) const { return slots_[static_cast<std::size_t>(frame)]; }

  template <int kRows>
  void Add(const BundleProblem::LandmarkObservation& observation, double huber_sigma,
           int newest_frame, Matrix6d* newest_information) {
    const ReprojectionFactor<kRows> factor(&problem_.camera, observation.uvu_px,
                                           observation.sigma_px);
    Eigen::Matrix<double, kRows, 1> r;
    Eigen::Matrix<double, kRows, kPoseBlockSize, Eigen::RowMajor> J_pose;
    Eigen::Matrix<double, kRows, 3, Eigen::RowMajor> J_point;
    const auto index = static_cast<std::size_t>(observation.landmark);
    const double* parameters[] = {blocks_[static_cast<std::size_t>(observation.frame)].data(),
                                  problem_.landmarks[index].p_W.data()};
    double* jacobians[] = {J_pose.data(), J_point.data()};
    factor.Evaluate(parameters, r.data(), jacobians);
    const double weight = std::min(1.0, huber_sigma / std::max(r.norm(), 1e-12));
    const Eigen::Matrix<double, kRows, 6> J = J_pose.template leftCols<6>();
    landmarks_[index].information += weight * J_point.transpose() * J_point;
    if (observation.frame == newest_frame) *newest_information += weight * J.transpose() * J;
    const int s = slot(observation.frame);
    if (s < 0) return;
    poses_.block<6, 6>(6 * s, 6 * s) += weight * J.transpose() * J;
    landmarks_[index].coupling.emplace_back(s, weight * J.transpose() * J_point);
  }

  void Add(const BundleProblem::CameraAcceleration& acceleration) {
    const auto [a, b, c] = acceleration.frames;
    const auto frame = [this](int i) { return static_cast<std::size_t>(i); };
    const double step_1_s = problem_.frames[frame(b)].time_s - problem_.frames[frame(a)].time_s;
    const double step_2_s = problem_.frames[frame(c)].time_s - problem_.frames[frame(b)].time_s;
    if (!(step_1_s > 0 && step_2_s > 0)) return;
    const CameraAccelerationFactor factor(step_1_s, step_2_s, acceleration.sigma);
    Vector6d r;
    Eigen::Matrix<double, 6, kPoseBlockSize, Eigen::RowMajor> J[3];
    const double* parameters[] = {blocks_[frame(a)].data(), blocks_[frame(b)].data(),
                                  blocks_[frame(c)].data()};
    double* jacobians[] = {J[0].data(), J[1].data(), J[2].data()};
    factor.Evaluate(parameters, r.data(), jacobians);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const int s_i = slot(acceleration.frames[i]);
        const int s_j = slot(acceleration.frames[j]);
        if (s_i < 0 || s_j < 0) continue;
        poses_.block<6, 6>(6 * s_i, 6 * s_j) += J[i].leftCols<6>().transpose() * J[j].leftCols<6>();
      }
    }
  }

  /// Covariance of one pose after elimination of the landmarks and of the other poses.
  Matrix6d Marginal(int newest_slot) {
    constexpr double kTiny = 1.0 / (kUnobservedSigma * kUnobservedSigma);
    for (const LandmarkTerms& landmark : landmarks_) {
      if (landmark.coupling.empty()) continue;
      const Eigen::Matrix3d inverse =
          (landmark.information + kTiny * Eigen::Matrix3d::Identity()).inverse();
      for (const auto& [s_i, H_i] : landmark.coupling) {
        const Matrix63 H_i_inverse = H_i * inverse;
        for (const auto& [s_j, H_j] : landmark.coupling) {
          poses_.block<6, 6>(6 * s_i, 6 * s_j).noalias() -= H_i_inverse * H_j.transpose();
        }
      }
    }
    poses_.diagonal().array() += kTiny;
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(poses_.rows(), 6);
    columns.block<6, 6>(6 * newest_slot, 0).setIdentity();
    const Eigen::MatrixXd solution = poses_.ldlt().solve(columns);
    const Matrix6d covariance = solution.block<6, 6>(6 * newest_slot, 0);
    return 0.5 * (covariance + covariance.transpose());
  }

 private:
  struct LandmarkTerms {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    std::vector<std::pair<int, Matrix63>> coupling;  // slot of a free pose
  };

  const BundleProblem& problem_;
  int num_free_ = 0;
  std::vector<int> slots_;
  std::vector<PoseBlock> blocks_;
  Eigen::MatrixXd poses_;
  std::vector<LandmarkTerms> landmarks_;
};

}  // namespace

PoseInformation NewestPoseInformation(const BundleProblem& problem, double huber_sigma) {
  PoseInformation result;
  if (problem.frames.empty()) return result;
  const int newest = static_cast<int>(problem.frames.size()) - 1;
  Hessian hessian(problem);
  for (const BundleProblem::LandmarkObservation& observation : problem.observations) {
    if (observation.is_eliminated) continue;
    if (observation.has_right) {
      hessian.Add<3>(observation, huber_sigma, newest, &result.observation_information);
    } else {
      hessian.Add<2>(observation, huber_sigma, newest, &result.observation_information);
    }
  }
  for (const BundleProblem::CameraAcceleration& acceleration : problem.accelerations) {
    hessian.Add(acceleration);
  }
  const int slot = hessian.slot(newest);
  if (slot >= 0) result.covariance = hessian.Marginal(slot);
  return result;
}

}  // namespace airdos
