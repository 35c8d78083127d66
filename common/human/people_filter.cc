#include "common/human/people_filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/geometry/covariance.h"

namespace airdos {
namespace {

constexpr double kNominalStep_s = 0.1;  // time step that PeopleFilterOptions::wobble_m refers to
constexpr double kAccelerationRate = 0.2;

std::optional<int> PlaceOf(int joint) {
  const auto it = std::find(kBodyJoints.begin(), kBodyJoints.end(), joint);
  if (it == kBodyJoints.end()) return std::nullopt;
  return static_cast<int>(it - kBodyJoints.begin());
}

/// Derivative of T_W_C p_C with respect to the tangent of T_W_C.
Eigen::Matrix<double, 3, 6> PointJacobian(const Eigen::Matrix3d& R_W_C,
                                          const Eigen::Vector3d& p_C) {
  Eigen::Matrix<double, 3, 6> J;
  J << R_W_C, -R_W_C * Skew(p_C);
  return J;
}

}  // namespace

void PeopleFilter::Predict(double step_s) {
  const double wobble = options_.wobble_m * options_.wobble_m * step_s / kNominalStep_s;
  for (auto& [id, person] : people_) {
    const double change_m_s = person.acceleration_m_s2 * step_s;
    person.covariance.topLeftCorner<3, 3>().diagonal().array() += change_m_s * change_m_s;
    // F is the identity, and step_s in the columns of the velocity: x = F x, P = F P F^T.
    Covariance& P = person.covariance;
    for (int row = 3; row < kStateSize; row += 3) {
      person.state.segment<3>(row) += step_s * person.state.head<3>();
      P.middleRows<3>(row) += step_s * P.topRows<3>();
    }
    for (int column = 3; column < kStateSize; column += 3) {
      P.middleCols<3>(column) += step_s * P.leftCols<3>();
    }
    person.covariance.bottomRightCorner<kStateSize - 3, kStateSize - 3>().diagonal().array() +=
        wobble;
  }
}

std::optional<PeopleFilter::Match> PeopleFilter::MatchJoints(
    const Person& person, const HumanMeasurement& measurement, const Se3& T_W_C,
    const Matrix6d& pose_covariance) const {
  Match match;
  const Eigen::Matrix3d R_W_C = T_W_C.rotation.toRotationMatrix();
  std::vector<Eigen::Vector3d> residuals;
  std::vector<Eigen::Matrix3d> measured;
  const double max_error2 = options_.max_joint_sigmas * options_.max_joint_sigmas;
  for (const HumanMeasurement::Joint& joint : measurement.joints) {
    const std::optional<int> place = PlaceOf(joint.joint);
    if (!place || !person.is_known[static_cast<std::size_t>(*place)]) continue;
    const int row = 3 + 3 * *place;
    const Eigen::Vector3d residual_W = T_W_C * joint.p_C - person.state.segment<3>(row);
    const Eigen::Matrix3d measured_W = Propagated(R_W_C, joint.covariance_C);
    const auto J = PointJacobian(R_W_C, joint.p_C);
    const Eigen::Matrix3d S =
        person.covariance.block<3, 3>(row, row) + measured_W + Propagated(J, pose_covariance);
    if (!(SquaredMahalanobis(residual_W, S) <= max_error2)) continue;
    match.places.push_back(*place);
    match.p_C.push_back(joint.p_C);
    residuals.push_back(residual_W);
    measured.push_back(measured_W);
  }
  const auto n = static_cast<int>(match.places.size());
  if (n == 0) return std::nullopt;
  match.residual_W.resize(3 * n);
  match.predicted_W.resize(3 * n, 3 * n);
  match.measured_W = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  match.jacobian.resize(3 * n, 6);
  for (int a = 0; a < n; ++a) {
    const auto index = static_cast<std::size_t>(a);
    match.residual_W.segment<3>(3 * a) = residuals[index];
    match.measured_W.block<3, 3>(3 * a, 3 * a) = measured[index];
    match.jacobian.middleRows<3>(3 * a) = PointJacobian(R_W_C, match.p_C[index]);
    for (int b = 0; b < n; ++b) {
      match.predicted_W.block<3, 3>(3 * a, 3 * b) = person.covariance.block<3, 3>(
          3 + 3 * match.places[index], 3 + 3 * match.places[static_cast<std::size_t>(b)]);
    }
  }
  return match;
}

std::vector<HumanConstraint> PeopleFilter::Constrain(const std::vector<HumanMeasurement>& people,
                                                     const Se3& T_W_C,
                                                     const Matrix6d& pose_covariance) const {
  std::vector<HumanConstraint> constraints;
  for (const HumanMeasurement& measurement : people) {
    const auto known = people_.find(measurement.id);
    if (known == people_.end() || known->second.num_seen < options_.min_seen_frames) continue;
    const Person& person = known->second;
    const auto match = MatchJoints(person, measurement, T_W_C, pose_covariance);
    if (!match) continue;
    HumanConstraint constraint;
    constraint.id = measurement.id;
    constraint.p_C = match->p_C;
    for (const int place : match->places) {
      constraint.p_W.emplace_back(person.state.segment<3>(3 + 3 * place));
    }
    constraint.covariance_W = match->predicted_W + match->measured_W;
    constraints.push_back(std::move(constraint));
  }
  return constraints;
}

PeopleFilter::Person PeopleFilter::Begin() const {
  Person person;
  person.acceleration_m_s2 = options_.acceleration_m_s2;
  person.covariance.topLeftCorner<3, 3>().diagonal().setConstant(options_.initial_speed_m_s *
                                                                 options_.initial_speed_m_s);
  return person;
}

void PeopleFilter::Correct(const Match& match, const Matrix6d& pose_covariance,
                           Person* person) const {
  const auto n = static_cast<int>(match.places.size());
  const Eigen::MatrixXd S = match.predicted_W + match.measured_W +
                            match.jacobian * pose_covariance * match.jacobian.transpose();
  Eigen::MatrixXd PHt(kStateSize, 3 * n);
  for (int a = 0; a < n; ++a) {
    PHt.middleCols<3>(3 * a) =
        person->covariance.middleCols<3>(3 + 3 * match.places[static_cast<std::size_t>(a)]);
  }
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(S);
  person->state += PHt * ldlt.solve(match.residual_W);
  const Covariance reduced = person->covariance - PHt * ldlt.solve(PHt.transpose());
  person->covariance = 0.5 * (reduced + reduced.transpose());
}

void PeopleFilter::LearnAcceleration(const Match& match, const Matrix6d& pose_covariance,
                                     Person* person) const {
  // The component common to all joints is the body's step; its square is compared with the expected
  // variance.
  const auto n = static_cast<int>(match.places.size());
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(3, 3 * n);
  for (int a = 0; a < n; ++a) mean.middleCols<3>(3 * a) = Eigen::Matrix3d::Identity() / n;
  const Eigen::MatrixXd S = match.predicted_W + match.measured_W +
                            match.jacobian * pose_covariance * match.jacobian.transpose();
  const Eigen::Matrix3d expected = mean * S * mean.transpose();
  const Eigen::Vector3d error = mean * match.residual_W;
  const double ratio = SquaredMahalanobis(error, expected) / 3;
  if (!std::isfinite(ratio)) return;
  // Robust: one bad frame counts at most three times the expected variance.
  const double factor = 1 + kAccelerationRate * (std::min(ratio, 3.0) - 1);
  person->acceleration_m_s2 =
      std::clamp(person->acceleration_m_s2 * std::sqrt(factor),
                 options_.min_acceleration_factor * options_.acceleration_m_s2,
                 options_.max_acceleration_factor * options_.acceleration_m_s2);
}

void PeopleFilter::AddNewJoints(const HumanMeasurement& measurement, const Se3& T_W_C,
                                const Matrix6d& pose_covariance, Person* person) const {
  const Eigen::Matrix3d R_W_C = T_W_C.rotation.toRotationMatrix();
  for (const HumanMeasurement::Joint& joint : measurement.joints) {
    const std::optional<int> place = PlaceOf(joint.joint);
    if (!place || person->is_known[static_cast<std::size_t>(*place)]) continue;
    const int row = 3 + 3 * *place;
    const auto J = PointJacobian(R_W_C, joint.p_C);
    person->is_known[static_cast<std::size_t>(*place)] = true;
    person->state.segment<3>(row) = T_W_C * joint.p_C;
    person->covariance.middleRows<3>(row).setZero();
    person->covariance.middleCols<3>(row).setZero();
    person->covariance.block<3, 3>(row, row) =
        Propagated(R_W_C, joint.covariance_C) + Propagated(J, pose_covariance);
  }
}

void PeopleFilter::Update(const std::vector<HumanMeasurement>& people, const Se3& T_W_C,
                          const Matrix6d& pose_covariance) {
  for (auto& [id, person] : people_) ++person.num_missed;
  for (const HumanMeasurement& measurement : people) {
    Person& person = people_.try_emplace(measurement.id, Begin()).first->second;
    const auto match = MatchJoints(person, measurement, T_W_C, pose_covariance);
    if (person.num_seen > 0 && !match) {
      person = Begin();  // in an impossible place: another person, or a jump
    } else if (match) {
      if (person.num_seen >= options_.min_seen_frames) {
        LearnAcceleration(*match, pose_covariance, &person);
      }
      Correct(*match, pose_covariance, &person);
    }
    AddNewJoints(measurement, T_W_C, pose_covariance, &person);
    ++person.num_seen;
    person.num_missed = 0;
  }
  for (auto it = people_.begin(); it != people_.end();) {
    it = it->second.num_missed > options_.max_missed_frames ? people_.erase(it) : std::next(it);
  }
}

void PeopleFilter::Transform(const Se3& T_Wnew_Wold) {
  const Eigen::Matrix3d R = T_Wnew_Wold.rotation.toRotationMatrix();
  for (auto& [id, person] : people_) {
    for (int row = 0; row < kStateSize; row += 3) {
      person.state.segment<3>(row) = (R * person.state.segment<3>(row)).eval();
      if (row > 0) person.state.segment<3>(row) += T_Wnew_Wold.translation;
      for (int column = 0; column < kStateSize; column += 3) {
        const Eigen::Matrix3d block = person.covariance.block<3, 3>(row, column);
        person.covariance.block<3, 3>(row, column) = Propagated(R, block);
      }
    }
  }
}

}  // namespace airdos
