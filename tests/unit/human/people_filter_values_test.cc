#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "common/human/people_filter.h"

// One joint before a camera that is not the identity and itself uncertain, with covariances of
// which no two entries are the same: worked by hand, and with Jacobians by differences.

namespace airdos {
namespace {

Se3 Camera() { return {ExpSo3({0.4, -0.7, 0.2}), {1, -2, 3}}; }
const Eigen::Vector3d kNeckC(0.6, -0.4, 4);

Eigen::Matrix3d Measured() {
  Eigen::Matrix3d S;
  S << 0.0009, 0.0002, 0.0011, 0.0002, 0.0006, -0.0004, 0.0011, -0.0004, 0.02;
  return S;
}

Matrix6d PoseCovariance() {
  Matrix6d A;
  for (int i = 0; i < 36; ++i) A(i / 6, i % 6) = std::sin(1.7 * i);
  Vector6d scale;
  scale << 0.02, 0.03, 0.04, 0.006, 0.004, 0.005;
  return scale.asDiagonal() * A * A.transpose() * scale.asDiagonal();
}

HumanMeasurement See(const Eigen::Vector3d& neck_C, std::int64_t id = 7) {
  return {HumanId{id}, {{kNeck, neck_C, Measured()}}};
}

Eigen::Matrix3d MeasuredW() {
  const Eigen::Matrix3d R = Camera().rotation.toRotationMatrix();
  return R * Measured() * R.transpose();
}

/// What the camera's own uncertainty adds to the point, by differences.
Eigen::Matrix3d OfCamera(const Eigen::Vector3d& p_C) {
  Eigen::Matrix<double, 3, 6> J;
  for (int i = 0; i < 6; ++i) {
    const Vector6d d = 1e-6 * Vector6d::Unit(i);
    J.col(i) = (Boxplus(Camera(), d) * p_C - Boxplus(Camera(), -d) * p_C) / 2e-6;
  }
  return J * PoseCovariance() * J.transpose();
}

PeopleFilterOptions Options() {
  PeopleFilterOptions options;
  options.acceleration_m_s2 = 3;
  options.initial_speed_m_s = 1.5;
  options.wobble_m = 0.05;
  options.max_joint_sigmas = 3;
  options.max_missed_frames = 2;
  options.min_seen_frames = 1;
  return options;
}

HumanConstraint Only(const std::vector<HumanConstraint>& constraints) {
  EXPECT_EQ(constraints.size(), 1U);
  return constraints.at(0);
}

TEST(PeopleFilterValues, AJointIsAsUncertainAsMeasurementAndCamera) {
  PeopleFilter filter(Options());
  filter.Update({See(kNeckC)}, Camera(), PoseCovariance());
  const HumanConstraint said = Only(filter.Constrain({See(kNeckC)}, Camera(), PoseCovariance()));
  EXPECT_EQ(said.id.value, 7);
  EXPECT_LT((said.p_W[0] - Camera() * kNeckC).norm(), 1e-12);
  EXPECT_EQ(said.p_C[0], kNeckC);
  // Of the prediction (with the camera that saw it first) and of the measurement; the camera of now
  // is what is asked for.
  const Eigen::Matrix3d expected = 2 * MeasuredW() + OfCamera(kNeckC);
  EXPECT_LT((said.covariance_W - expected).norm(), 1e-9);
}

TEST(PeopleFilterValues, WithTimeVelocityAccelerationAndWobbleComeIn) {
  PeopleFilter filter(Options());
  filter.Update({See(kNeckC)}, Camera(), PoseCovariance());
  filter.Predict(0.25);
  const HumanConstraint said = Only(filter.Constrain({See(kNeckC)}, Camera(), PoseCovariance()));
  const double motion_m2 = 0.0625 * (2.25 + 0.75 * 0.75) + 0.0025 * 2.5;
  const Eigen::Matrix3d expected =
      2 * MeasuredW() + OfCamera(kNeckC) + motion_m2 * Eigen::Matrix3d::Identity();
  EXPECT_LT((said.covariance_W - expected).norm(), 1e-9);
}

TEST(PeopleFilterValues, AJointThatIsSeenLaterOwesTheOthersNothing) {
  PeopleFilter filter(Options());
  filter.Update({See(kNeckC)}, Camera(), PoseCovariance());
  filter.Predict(0.25);
  const Eigen::Vector3d nose_C(0.6, -0.7, 4.1);
  HumanMeasurement both = See(kNeckC);
  both.joints.push_back({kNose, nose_C, Measured()});
  filter.Update({both}, Camera(), PoseCovariance());
  const HumanMeasurement nose{HumanId{7}, {{kNose, nose_C, Measured()}}};
  const auto covariance = [&](double step_s) {
    PeopleFilter later = filter;
    later.Predict(step_s);
    return Eigen::Matrix3d(Only(later.Constrain({nose}, Camera(), PoseCovariance())).covariance_W);
  };
  const Eigen::Matrix3d now = covariance(0);
  EXPECT_LT((now - 2 * MeasuredW() - OfCamera(nose_C)).norm(), 1e-9);
  // What the velocity brings in goes with the square of time, as nothing is known of both.
  const auto velocity = [&](double step_s) {
    const double other_m2 = 0.0025 * step_s / 0.1 + std::pow(3 * step_s * step_s, 2);
    return Eigen::Matrix3d((covariance(step_s) - now - other_m2 * Eigen::Matrix3d::Identity()) /
                           (step_s * step_s));
  };
  // Whatever the filter learnt of the acceleration in between is in both.
  EXPECT_LT((velocity(0.1) - velocity(0.2)).norm(), 0.2);
  EXPECT_GT(velocity(0.1).trace(), 0.1);
}

TEST(PeopleFilterValues, ASecondLookCorrectsByItsWeight) {
  PeopleFilter filter(Options());
  filter.Update({See(kNeckC)}, Camera(), PoseCovariance());
  const Eigen::Vector3d moved_C = kNeckC + Eigen::Vector3d(0.01, 0.02, -0.05);
  filter.Update({See(moved_C)}, Camera(), PoseCovariance());
  const HumanConstraint said = Only(filter.Constrain({See(kNeckC)}, Camera(), PoseCovariance()));
  const Eigen::Matrix3d P = MeasuredW() + OfCamera(kNeckC);
  const Eigen::Matrix3d gain = P * (P + MeasuredW() + OfCamera(moved_C)).inverse();
  const Eigen::Vector3d step_W = Camera() * moved_C - Camera() * kNeckC;
  EXPECT_LT((said.p_W[0] - (Camera() * kNeckC + gain * step_W)).norm(), 1e-9);
  EXPECT_LT((said.covariance_W - (P - gain * P + MeasuredW())).norm(), 1e-9);
}

/// Whether a neck that is off by `sigmas` along a direction is taken for the same.
bool IsTaken(double sigmas) {
  PeopleFilter filter(Options());
  filter.Update({See(kNeckC)}, Camera(), PoseCovariance());
  const Eigen::Vector3d direction_C = Eigen::Vector3d(0.6, 0, 0.8);
  // Solved by iteration, as the camera's part depends on where the point is.
  double length_m = 0;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p_C = kNeckC + length_m * direction_C;
    const Eigen::Matrix3d S = 2 * MeasuredW() + OfCamera(kNeckC) + OfCamera(p_C);
    const Eigen::Vector3d direction_W = Camera().rotation * direction_C;
    length_m = sigmas / std::sqrt(direction_W.dot(S.inverse() * direction_W));
  }
  return !filter.Constrain({See(kNeckC + length_m * direction_C)}, Camera(), PoseCovariance())
              .empty();
}

TEST(PeopleFilterValues, AJointFurtherOffThanTheLimitIsLeftOut) {
  EXPECT_TRUE(IsTaken(2.99));
  EXPECT_FALSE(IsTaken(3.01));
}

TEST(PeopleFilterValues, WhoIsNotWhereHeCanBeBeginsAnew) {
  PeopleFilter filter(Options());
  filter.Update({See(kNeckC)}, Camera(), PoseCovariance());
  const Eigen::Vector3d elsewhere_C = kNeckC + Eigen::Vector3d(2, 0, 0);
  filter.Update({See(elsewhere_C)}, Camera(), PoseCovariance());
  const HumanConstraint said =
      Only(filter.Constrain({See(elsewhere_C)}, Camera(), PoseCovariance()));
  EXPECT_LT((said.p_W[0] - Camera() * elsewhere_C).norm(), 1e-12);
  EXPECT_LT((said.covariance_W - 2 * MeasuredW() - OfCamera(elsewhere_C)).norm(), 1e-9);
}

TEST(PeopleFilterValues, SpeaksAndIsForgottenAtExactlyTheLimits) {
  PeopleFilterOptions options = Options();
  options.min_seen_frames = 3;
  PeopleFilter filter(options);
  for (int i = 1; i <= 3; ++i) {
    filter.Update({See(kNeckC)}, Camera(), PoseCovariance());
    EXPECT_EQ(filter.Constrain({See(kNeckC)}, Camera(), PoseCovariance()).size(), i == 3 ? 1U : 0U);
  }
  for (int i = 0; i < 2; ++i) filter.Update({See(kNeckC, 8)}, Camera(), PoseCovariance());
  EXPECT_EQ(filter.num_people(), 2U);
  filter.Update({See(kNeckC), See(kNeckC, 8)}, Camera(), PoseCovariance());  // just in time
  for (int i = 0; i < 2; ++i) filter.Update({See(kNeckC, 8)}, Camera(), PoseCovariance());
  EXPECT_EQ(filter.num_people(), 2U);
  filter.Update({See(kNeckC, 8)}, Camera(), PoseCovariance());
  EXPECT_EQ(filter.num_people(), 1U);
}

TEST(PeopleFilterValues, EveryoneMovesAlongWithTheWorld) {
  PeopleFilter filter(Options());
  filter.Update({See(kNeckC)}, Camera(), PoseCovariance());
  filter.Predict(0.25);
  filter.Update({See(kNeckC + Eigen::Vector3d(0.1, 0, 0.02))}, Camera(), PoseCovariance());
  PeopleFilter moved = filter;
  const Se3 T_new_old{ExpSo3({0.3, 1.1, -0.5}), {5, 6, -7}};
  moved.Transform(T_new_old);
  filter.Predict(0.25);
  moved.Predict(0.25);
  const Eigen::Vector3d next_C = kNeckC + Eigen::Vector3d(0.2, 0, 0.04);
  const HumanConstraint before = Only(filter.Constrain({See(next_C)}, Camera(), PoseCovariance()));
  const HumanConstraint after =
      Only(moved.Constrain({See(next_C)}, T_new_old * Camera(), PoseCovariance()));
  EXPECT_LT((after.p_W[0] - T_new_old * before.p_W[0]).norm(), 1e-9);
  const Eigen::Matrix3d R = T_new_old.rotation.toRotationMatrix();
  EXPECT_LT((after.covariance_W - R * before.covariance_W * R.transpose()).norm(), 1e-9);
}

TEST(PeopleFilterValues, HowMuchSomebodyAcceleratesIsLearntByTheRatioOfTheErrors) {
  PeopleFilterOptions options = Options();
  options.min_seen_frames = 1;
  options.max_joint_sigmas = 100;
  const auto learnt_m2 = [&options](double sigmas) {
    PeopleFilter filter(options);
    filter.Update({See(kNeckC)}, Camera(), PoseCovariance());
    const Eigen::Matrix3d S = 2 * MeasuredW() + OfCamera(kNeckC);
    // Across the ray; with no time gone the covariances before are those after.
    const Eigen::Vector3d direction_W = Camera().rotation * Eigen::Vector3d(1, 0, 0);
    double length_m = 0;
    for (int i = 0; i < 50; ++i) {
      const Eigen::Matrix3d all = S + OfCamera(kNeckC + length_m * Eigen::Vector3d(1, 0, 0));
      length_m = sigmas / std::sqrt(direction_W.dot(all.inverse() * direction_W));
    }
    const Eigen::Vector3d p_C = kNeckC + length_m * Eigen::Vector3d(1, 0, 0);
    filter.Update({See(p_C)}, Camera(), PoseCovariance());
    const auto variance = [&](double step_s) {
      PeopleFilter later = filter;
      later.Predict(step_s);
      return Only(later.Constrain({See(p_C)}, Camera(), PoseCovariance())).covariance_W(0, 0);
    };
    // P + h^2 (v^2 + a^2 h^2) + wobble^2 h / 0.1: what goes with h^4.
    const double wobble_m2 = options.wobble_m * options.wobble_m;
    const double rest = variance(1) - variance(0) - 10 * wobble_m2 - 2.25;
    return std::sqrt(rest);
  };
  // The squared error over 3, at most 3; a fifth of what it exceeds 1.
  EXPECT_NEAR(learnt_m2(std::sqrt(3.0)), 3, 1e-6);
  EXPECT_NEAR(learnt_m2(std::sqrt(6.0)), 3 * std::sqrt(1.2), 1e-6);
  EXPECT_NEAR(learnt_m2(std::sqrt(9.0)), 3 * std::sqrt(1.4), 1e-6);
  EXPECT_NEAR(learnt_m2(9), 3 * std::sqrt(1.4), 1e-6);
  EXPECT_NEAR(learnt_m2(0), 3 * std::sqrt(0.8), 1e-6);
}

}  // namespace
}  // namespace airdos
