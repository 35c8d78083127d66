#include "common/features/pose_estimator.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "common/geometry/covariance.h"

namespace airdos {
namespace {

constexpr int kNumRounds = 4;
constexpr int kIterationsPerRound = 6;
constexpr double kChi2Stereo = 7.815;  // 95 %, 3 degrees of freedom
constexpr double kChi2Mono = 5.991;    // 95 %, 2 degrees of freedom
constexpr double kMinDepth_m = 0.05;
constexpr double kConverged = 1e-8;
constexpr std::size_t kMinRedundant = 20;  // observations that can check each other

struct Residual {
  Eigen::Vector3d value;  // whitened; the last row is zero without a right observation
  Eigen::Matrix<double, 3, 6> jacobian;
  bool is_in_front = false;
};

/// `J_C` is the derivative of the residual with respect to p_C.
void Whiten(const Eigen::Matrix3d& J_C, const Eigen::Quaterniond& q_C_W,
            const PoseObservation& observation, Residual* residual) {
  const double variance_px2 = observation.sigma_px * observation.sigma_px;
  if (observation.covariance_W.isZero(0)) {
    residual->value /= observation.sigma_px;
    residual->jacobian /= observation.sigma_px;
    return;
  }
  const Eigen::Matrix3d J = J_C * q_C_W.toRotationMatrix();  // with respect to p_W
  Eigen::Matrix3d S = Propagated(J, observation.covariance_W);
  if (!observation.has_right) {
    S.row(2).setZero();
    S.col(2).setZero();
  }
  S.diagonal().array() += variance_px2;
  const Eigen::LLT<Eigen::Matrix3d> llt(S);
  llt.matrixL().solveInPlace(residual->value);
  llt.matrixL().solveInPlace(residual->jacobian);
}

/// r = L^-1 (z - pi(T_C_W p_W)) and its derivative with respect to the tangent of T_W_C: p_C(delta)
/// ~ p_C - delta_t + [p_C]_x delta_r. L L^T is the covariance of z - pi: of the pixels, plus that
/// of the point if it is not known exactly.
Residual Evaluate(const StereoCamera& camera, const Se3& T_C_W,
                  const PoseObservation& observation) {
  Residual residual;
  const Eigen::Vector3d p_C = T_C_W * observation.p_W;
  residual.is_in_front = p_C.z() > kMinDepth_m;
  if (!residual.is_in_front) return residual;
  residual.value = observation.uvu_px - camera.ProjectStereo(p_C);
  const Eigen::Matrix3d J = -camera.ProjectStereoJacobian(p_C);
  residual.jacobian.leftCols<3>() = -J;
  residual.jacobian.rightCols<3>() = J * Skew(p_C);
  if (!observation.has_right) {
    residual.value.z() = 0;
    residual.jacobian.row(2).setZero();
  }
  Whiten(J, T_C_W.rotation, observation, &residual);
  return residual;
}

double Chi2Bound(const PoseObservation& observation) {
  return observation.has_right ? kChi2Stereo : kChi2Mono;
}

/// Adds the prior's normal equations: e = Boxminus(T_W_C, mean). Its Jacobian is taken as the
/// identity, which is close for the small e that a prior allows.
void AddPrior(const PosePrior& prior, const Matrix6d& information, const Se3& T_W_C, Matrix6d* H,
              Vector6d* b) {
  const Vector6d error = Boxminus(T_W_C, prior.T_W_C);
  Matrix6d J = Matrix6d::Identity();
  J.topLeftCorner<3, 3>() = (prior.T_W_C.rotation.conjugate() * T_W_C.rotation).toRotationMatrix();
  J.bottomRightCorner<3, 3>() = RightJacobianInverseSo3(error.tail<3>());
  *H += J.transpose() * information * J;
  *b -= J.transpose() * information * error;
}

/// What stays the same from iteration to iteration.
struct Knowledge {
  const StereoCamera& camera;
  const std::vector<PoseObservation>& observations;
  const std::optional<PosePrior>& prior;
  Matrix6d prior_information;
};

/// One Gauss-Newton step; false if the system cannot be solved.
bool Step(const Knowledge& known, const std::vector<bool>& is_used, bool robust, Se3* T_W_C,
          double* step_norm) {
  const std::vector<PoseObservation>& observations = known.observations;
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  const Se3 T_C_W = T_W_C->inverse();
  int num_used = 0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!is_used[i]) continue;
    const Residual residual = Evaluate(known.camera, T_C_W, observations[i]);
    if (!residual.is_in_front) continue;
    const double norm = residual.value.norm();
    const double huber = std::sqrt(Chi2Bound(observations[i]));
    const double weight = observations[i].weight * (robust && norm > huber ? huber / norm : 1.0);
    H.noalias() += weight * residual.jacobian.transpose() * residual.jacobian;
    b.noalias() -= weight * residual.jacobian.transpose() * residual.value;
    ++num_used;
  }
  if (known.prior) AddPrior(*known.prior, known.prior_information, *T_W_C, &H, &b);
  if (!known.prior && num_used < 3) return false;
  const std::optional<Vector6d> delta = SolvePositive(H, b);
  if (!delta || !delta->allFinite() || delta->norm() > 50) return false;
  *T_W_C = Boxplus(*T_W_C, *delta);
  *step_norm = delta->norm();
  return true;
}

/// With few observations, a single one can pull the pose towards itself, so those that contradict
/// the prior are excluded. The bound is wide because the prior is linearised coarsely.
void GateByPrior(const Knowledge& known, std::vector<bool>* is_possible) {
  constexpr double kMaxChi2 = 16;
  const Se3 T_C_W = known.prior->T_W_C.inverse();
  for (std::size_t i = 0; i < known.observations.size(); ++i) {
    const Residual residual = Evaluate(known.camera, T_C_W, known.observations[i]);
    if (!residual.is_in_front) {
      (*is_possible)[i] = false;
      continue;
    }
    const Eigen::Matrix3d S =
        Propagated(residual.jacobian, known.prior->covariance) + Eigen::Matrix3d::Identity();
    (*is_possible)[i] = SquaredMahalanobis(residual.value, S) <= kMaxChi2;
  }
}

}  // namespace

PosePrior IsotropicPrior(const Se3& T_W_C, double sigma_position_m, double sigma_orientation_rad) {
  PosePrior prior{T_W_C, Matrix6d::Zero()};
  prior.covariance.diagonal().head<3>().setConstant(sigma_position_m * sigma_position_m);
  prior.covariance.diagonal().tail<3>().setConstant(sigma_orientation_rad * sigma_orientation_rad);
  return prior;
}

PoseEstimate EstimatePose(const StereoCamera& camera,
                          const std::vector<PoseObservation>& observations, const Se3& start,
                          const std::optional<PosePrior>& prior) {
  Knowledge known{camera, observations, prior, Matrix6d::Zero()};
  if (prior) known.prior_information = Inverse(prior->covariance);
  PoseEstimate estimate;
  estimate.T_W_C = start;
  estimate.is_inlier.assign(observations.size(), true);
  if (prior && observations.size() < kMinRedundant) {
    GateByPrior(known, &estimate.is_inlier);
  }
  const std::vector<bool> is_possible = estimate.is_inlier;
  for (int round = 0; round < kNumRounds; ++round) {
    const bool robust = round < kNumRounds - 1;
    for (int iteration = 0; iteration < kIterationsPerRound; ++iteration) {
      double step_norm = 0;
      if (!Step(known, estimate.is_inlier, robust, &estimate.T_W_C, &step_norm)) break;
      if (step_norm < kConverged) break;
    }
    estimate.num_inliers = 0;
    estimate.information.setZero();
    const Se3 T_C_W = estimate.T_W_C.inverse();
    for (std::size_t i = 0; i < observations.size(); ++i) {
      const Residual residual = Evaluate(camera, T_C_W, observations[i]);
      estimate.is_inlier[i] = is_possible[i] && residual.is_in_front &&
                              residual.value.squaredNorm() <= Chi2Bound(observations[i]);
      if (!estimate.is_inlier[i]) continue;
      ++estimate.num_inliers;
      estimate.information.noalias() +=
          observations[i].weight * residual.jacobian.transpose() * residual.jacobian;
    }
  }
  return estimate;
}

std::optional<Se3> EstimatePoseRansac(const StereoCamera& camera,
                                      const std::vector<PoseObservation>& observations,
                                      double max_error_px) {
  constexpr int kMinPoints = 6;
  constexpr int kMaxIterations = 300;
  constexpr double kConfidence = 0.999;
  if (observations.size() < static_cast<std::size_t>(kMinPoints)) return std::nullopt;
  std::vector<cv::Point3d> points_W;
  std::vector<cv::Point2d> points_px;
  for (const PoseObservation& observation : observations) {
    points_W.emplace_back(observation.p_W.x(), observation.p_W.y(), observation.p_W.z());
    points_px.emplace_back(observation.uvu_px.x(), observation.uvu_px.y());
  }
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  cv::Vec3d rotation_vector;
  cv::Vec3d translation;
  std::vector<int> inliers;
  // OpenCV's RANSAC seeds its own generator with a constant on every call.
  const bool found = cv::solvePnPRansac(
      points_W, points_px, K, cv::noArray(), rotation_vector, translation, false, kMaxIterations,
      static_cast<float>(max_error_px), kConfidence, inliers, cv::SOLVEPNP_AP3P);
  if (!found || inliers.size() < static_cast<std::size_t>(kMinPoints)) return std::nullopt;
  const Se3 T_C_W{ExpSo3({rotation_vector[0], rotation_vector[1], rotation_vector[2]}),
                  {translation[0], translation[1], translation[2]}};
  if (!T_C_W.translation.allFinite() || !T_C_W.rotation.coeffs().allFinite()) return std::nullopt;
  return T_C_W.inverse();
}

}  // namespace airdos
