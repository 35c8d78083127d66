#include "common/features/people_pose.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>

#include "common/geometry/covariance.h"

namespace airdos {
namespace {

constexpr int kMaxIterations = 10;
constexpr double kConverged = 1e-8;
constexpr double kHuberPerson = 1.5;  // sigmas, RMS over a person's joints

/// Adds the normal equations of r = T_W_C p_C - p_W for the person's joints.
void AddPerson(const HumanConstraint& person, const Se3& T_W_C, Matrix6d* H, Vector6d* b) {
  const auto n = static_cast<Eigen::Index>(person.p_W.size());
  const Eigen::Matrix3d R_W_C = T_W_C.rotation.toRotationMatrix();
  Eigen::VectorXd r(3 * n);
  Eigen::MatrixXd J(3 * n, 6);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d& p_C = person.p_C[static_cast<std::size_t>(i)];
    r.segment<3>(3 * i) = T_W_C * p_C - person.p_W[static_cast<std::size_t>(i)];
    J.middleRows<3>(3 * i) << R_W_C, -R_W_C * Skew(p_C);
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(person.covariance_W);
  if (llt.info() != Eigen::Success) return;
  llt.matrixL().solveInPlace(r);
  llt.matrixL().solveInPlace(J);
  const double norm = r.norm() / std::sqrt(static_cast<double>(3 * n));
  const double weight = norm > kHuberPerson ? kHuberPerson / norm : 1.0;
  H->noalias() += weight * J.transpose() * J;
  b->noalias() -= weight * J.transpose() * r;
}

}  // namespace

PeoplePose EstimatePoseFromPeople(const PosePrior& prior,
                                  const std::vector<HumanConstraint>& people) {
  PeoplePose pose{prior, Matrix6d::Zero(), static_cast<int>(people.size())};
  if (people.empty()) return pose;
  const Matrix6d prior_information = Inverse(prior.covariance);
  Se3& T_W_C = pose.prior.T_W_C;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    pose.information.setZero();
    Vector6d b = -prior_information * Boxminus(T_W_C, prior.T_W_C);
    for (const HumanConstraint& person : people) AddPerson(person, T_W_C, &pose.information, &b);
    const std::optional<Vector6d> delta = SolvePositive(prior_information + pose.information, b);
    if (!delta || !delta->allFinite()) return {prior, Matrix6d::Zero(), pose.num_people};
    T_W_C = Boxplus(T_W_C, *delta);
    if (delta->norm() < kConverged) break;
  }
  const Matrix6d information = prior_information + pose.information;
  pose.prior.covariance = Inverse(information);
  return pose;
}

}  // namespace airdos
