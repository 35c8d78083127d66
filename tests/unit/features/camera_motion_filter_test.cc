#include "common/features/camera_motion_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

namespace airdos {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kForever_s = 1e12;  // a memory that does not end
const Matrix6d kNothing = Matrix6d::Zero();
const Matrix6d kExactly = 1e14 * Matrix6d::Identity();

CameraMotionFilterOptions WithMemory(double memory_s) {
  CameraMotionFilterOptions options;
  options.memory_s = memory_s;
  return options;
}

Vector6d Twist() {
  Vector6d twist;
  twist << 0.8, -0.2, 1.1, 0.1, -0.4, 0.2;
  return twist;
}

/// Drives the filter and keeps the camera's pose.
struct Carrier {
  explicit Carrier(const CameraMotionFilterOptions& options) : filter(options) {}

  PosePrior Predict(double step_s = kStep_s) const { return filter.Predict(T_W_C, step_s); }
  void See(const Se3& T_W_C_seen, const Matrix6d& information, bool is_learnable = false,
           double step_s = kStep_s) {
    filter.Update(Predict(step_s), step_s, T_W_C_seen, information, is_learnable);
    T_W_C = T_W_C_seen;
  }
  /// Moves on by a velocity.
  void Move(const Vector6d& velocity, const Matrix6d& information, bool is_learnable = false) {
    See(Boxplus(T_W_C, kStep_s * velocity), information, is_learnable);
  }
  /// A frame that sees nothing.
  void Coast() { See(Predict().T_W_C, kNothing); }

  CameraMotionFilter filter;
  Se3 T_W_C;
};

double Error(const Se3& a, const Se3& b) { return Boxminus(a, b).norm(); }

TEST(CameraMotionFilter, AConstantVelocityIsPredictedOnceItWasSeen) {
  Carrier carrier(WithMemory(kForever_s));
  EXPECT_EQ(Error(carrier.Predict().T_W_C, Se3()), 0);
  for (int k = 0; k < 10; ++k) {
    carrier.Move(Twist(), kExactly);
    for (const double step_s : {0.02, kStep_s, 0.4}) {
      EXPECT_LT(Error(carrier.Predict(step_s).T_W_C, Boxplus(carrier.T_W_C, step_s * Twist())),
                1e-8)
          << "frame " << k;
    }
  }
}

TEST(CameraMotionFilter, AVelocityThatNobodyMeasuresFallsOff) {
  constexpr double kMemory_s = 0.5;
  Carrier carrier(WithMemory(kMemory_s));
  carrier.Move(Twist(), kExactly);
  const double memory = std::exp(-kStep_s / kMemory_s);
  double expected = memory * kStep_s * Twist().norm();
  for (int k = 0; k < 20; ++k) {
    const Se3 last = carrier.T_W_C;
    carrier.Coast();
    EXPECT_NEAR(Error(carrier.T_W_C, last), expected, 1e-9) << "frame " << k;
    expected *= memory;
  }
}

TEST(CameraMotionFilter, AFrameThatSeesNothingLeavesTheVelocityAndIsLessCertain) {
  Carrier carrier(WithMemory(kForever_s));
  for (int k = 0; k < 3; ++k) carrier.Move(Twist(), kExactly);
  for (int k = 0; k < 5; ++k) {
    const Vector6d before = carrier.filter.pose_covariance().diagonal();
    const PosePrior prior = carrier.Predict();
    carrier.Coast();
    EXPECT_LT((carrier.filter.pose_covariance() - prior.covariance).norm(), 1e-12);
    EXPECT_TRUE((carrier.filter.pose_covariance().diagonal().array() > before.array()).all());
    EXPECT_LT(Error(carrier.Predict().T_W_C, Boxplus(carrier.T_W_C, kStep_s * Twist())), 1e-8);
  }
}

TEST(CameraMotionFilter, AWeakFrameMovesTheVelocityLittleAndAStrongOneFully) {
  // Three frames at rest, then one that is 1 cm further on. What it says of the velocity is the
  // share of the prediction's variance that its information takes away; only that share of the
  // centimetre reaches the pose, and with it the velocity.
  for (const double sigma_m : {1e-6, 0.02, 10.0}) {
    Carrier carrier(WithMemory(kForever_s));
    for (int k = 0; k < 3; ++k) carrier.Move(Vector6d::Zero(), kExactly);
    const double variance_m2 = carrier.Predict().covariance(0, 0);
    const double share = variance_m2 / (variance_m2 + sigma_m * sigma_m);
    Vector6d seen = Vector6d::Zero();
    seen[0] = share * 0.01;
    carrier.See(Boxplus(carrier.T_W_C, seen), Matrix6d::Identity() / (sigma_m * sigma_m));
    const double predicted_m = Boxminus(carrier.Predict().T_W_C, carrier.T_W_C).x();
    // The pose before was exact: all of the shift is velocity.
    EXPECT_NEAR(predicted_m, share * 0.01, 1e-6) << sigma_m;
  }
}

TEST(CameraMotionFilter, OneAxisIsTheTextbooksKalmanFilter) {
  // State (x, v): x' = x + dt v', v' = m v + dt a; a measurement of x with variance r.
  const CameraMotionFilterOptions options = WithMemory(2);
  Carrier carrier(options);
  Eigen::Vector2d state(0, 0);
  Eigen::Matrix2d P = Eigen::Matrix2d::Zero();
  P(1, 1) = options.initial_speed_m_s * options.initial_speed_m_s;
  const double steps_s[] = {0.1, 0.1, 0.25, 0.05};
  const double sigmas_m[] = {0.01, 0.3, 1e6, 0.05, 0.002};
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int k = 0; k < 40; ++k) {
    const double dt = steps_s[k % 4];
    const double m = std::exp(-dt / options.memory_s);
    Eigen::Matrix2d A;
    A << 1, m * dt, 0, m;
    const Eigen::Vector2d noise = options.linear_start_m_s2 * Eigen::Vector2d(dt * dt, dt);
    state = (A * state).eval();
    P = (A * P * A.transpose() + noise * noise.transpose()).eval();
    const PosePrior prior = carrier.Predict(dt);
    EXPECT_NEAR(prior.T_W_C.translation.x(), state[0], 1e-9) << "frame " << k;
    EXPECT_NEAR(prior.covariance(0, 0), P(0, 0), 1e-9 * P(0, 0)) << "frame " << k;

    const double r = sigmas_m[k % 5] * sigmas_m[k % 5];
    const Eigen::Vector2d gain = P.col(0) / (P(0, 0) + r);
    state += gain * (place(random) - state[0]);
    P = (P - gain * P.row(0)).eval();
    Se3 T_W_C;
    T_W_C.translation.x() = state[0];
    carrier.See(T_W_C, Matrix6d::Identity() / r, false, dt);
    EXPECT_NEAR(carrier.filter.pose_covariance()(0, 0), P(0, 0), 1e-9 * (1e-6 + P(0, 0)));
  }
}

/// The same filter over all twelve dimensions at once, with the derivative of the motion by
/// central differences.
class DenseFilter {
 public:
  explicit DenseFilter(const CameraMotionFilterOptions& options) : options_(options) {
    P_.diagonal().segment<3>(6).setConstant(std::pow(options.initial_speed_m_s, 2));
    P_.diagonal().segment<3>(9).setConstant(std::pow(options.initial_turn_rad_s, 2));
  }
  void Predict(double dt) {
    const double m = std::exp(-dt / options_.memory_s);
    const Vector6d step = m * dt * velocity_;
    const Se3 moved = Boxplus(T_W_C_, step);
    Matrix12d A = Matrix12d::Zero();
    for (int i = 0; i < 6; ++i) {
      constexpr double kDelta = 1e-5;
      const Vector6d delta = kDelta * Vector6d::Unit(i);
      A.block<6, 1>(0, i) = (Boxminus(Boxplus(Boxplus(T_W_C_, delta), step), moved) -
                             Boxminus(Boxplus(Boxplus(T_W_C_, -delta), step), moved)) /
                            (2 * kDelta);
    }
    A.topRightCorner<6, 6>() = m * dt * Matrix6d::Identity();
    A.bottomRightCorner<6, 6>() = m * Matrix6d::Identity();
    Vector6d variance;
    variance.head<3>().setConstant(std::pow(options_.linear_start_m_s2, 2));
    variance.tail<3>().setConstant(std::pow(options_.angular_start_rad_s2, 2));
    Eigen::Matrix<double, 12, 6> N;
    N << dt * dt * Matrix6d::Identity(), dt * Matrix6d::Identity();
    P_ = (A * P_ * A.transpose() + N * variance.asDiagonal() * N.transpose()).eval();
    T_W_C_ = moved;
    velocity_ *= m;
  }
  /// `seen` is the measured tangent at the prediction.
  void Update(const Vector6d& seen, const Matrix6d& information) {
    Matrix12d J = Matrix12d::Zero();
    J.topLeftCorner<6, 6>() = information;
    P_ = (P_ * (Matrix12d::Identity() + J * P_).inverse()).eval();
    const Eigen::Matrix<double, 12, 1> shift = P_.leftCols<6>() * information * seen;
    T_W_C_ = Boxplus(T_W_C_, shift.head<6>());
    velocity_ += shift.tail<6>();
  }
  const Se3& T_W_C() const { return T_W_C_; }
  Matrix6d pose_covariance() const { return P_.topLeftCorner<6, 6>(); }

 private:
  using Matrix12d = Eigen::Matrix<double, 12, 12>;
  CameraMotionFilterOptions options_;
  Se3 T_W_C_;
  Vector6d velocity_ = Vector6d::Zero();
  Matrix12d P_ = Matrix12d::Zero();
};

/// A positive semi-definite matrix of that rank.
Matrix6d RandomInformation(int rank, double scale, std::mt19937_64* random) {
  std::normal_distribution<double> normal;
  Matrix6d information = Matrix6d::Zero();
  for (int i = 0; i < rank; ++i) {
    Vector6d direction;
    for (int j = 0; j < 6; ++j) direction[j] = normal(*random);
    information += scale * direction * direction.transpose();
  }
  return information;
}

TEST(CameraMotionFilter, ATurningCameraIsTheDenseFilter) {
  const CameraMotionFilterOptions options = WithMemory(1.5);
  DenseFilter dense(options);
  Carrier carrier(options);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 30; ++k) {
    const double dt = k % 3 == 0 ? 0.15 : 0.1;
    const PosePrior prior = carrier.Predict(dt);
    dense.Predict(dt);
    ASSERT_LT(Error(prior.T_W_C, dense.T_W_C()), 1e-7) << "frame " << k;
    ASSERT_LT((prior.covariance - dense.pose_covariance()).norm(),
              1e-7 * dense.pose_covariance().norm())
        << "frame " << k;
    Vector6d seen;
    for (int i = 0; i < 6; ++i) seen[i] = 0.1 * normal(random);
    const Matrix6d information = RandomInformation(k % 7, 1e3, &random);
    dense.Update(seen, information);
    carrier.See(dense.T_W_C(), information, false, dt);
    EXPECT_LT((carrier.filter.pose_covariance() - dense.pose_covariance()).norm(),
              1e-7 * (1e-3 + dense.pose_covariance().norm()));
  }
}

/// The camera's velocity changes by that acceleration to and fro.
void Shake(double linear_m_s2, double angular_rad_s2, const Matrix6d& information,
           bool is_learnable, Carrier* carrier) {
  Vector6d change = Vector6d::Zero();
  change[1] = linear_m_s2 * kStep_s;
  change[4] = angular_rad_s2 * kStep_s;
  for (int k = 0; k < 30; ++k)
    carrier->Move(k % 2 == 0 ? change : Vector6d(Vector6d::Zero()), information, is_learnable);
}

TEST(CameraMotionFilter, TheCarriersAccelerationIsLearnt) {
  const CameraMotionFilterOptions options = WithMemory(kForever_s);
  Carrier carrier(options);
  EXPECT_EQ(carrier.filter.linear_sigma_m_s2(), options.linear_start_m_s2);
  EXPECT_EQ(carrier.filter.angular_sigma_rad_s2(), options.angular_start_rad_s2);
  const double linear_m_s2 = 0.6 * options.linear_ceiling_m_s2 / 3;
  const double angular_rad_s2 = 0.5 * options.angular_ceiling_rad_s2 / 3;
  Shake(linear_m_s2, angular_rad_s2, kExactly, true, &carrier);
  // Turning and shifting at once, the axes of the two velocities differ a little.
  EXPECT_NEAR(carrier.filter.linear_sigma_m_s2(), 3 * linear_m_s2, 0.05 * linear_m_s2);
  EXPECT_NEAR(carrier.filter.angular_sigma_rad_s2(), 3 * angular_rad_s2, 0.05 * angular_rad_s2);
}

TEST(CameraMotionFilter, TheLearntAccelerationStaysWithinItsBounds) {
  const CameraMotionFilterOptions options = WithMemory(kForever_s);
  Carrier steady(options);
  Shake(0.1 * options.linear_floor_m_s2, 0.1 * options.angular_floor_rad_s2, kExactly, true,
        &steady);
  EXPECT_EQ(steady.filter.linear_sigma_m_s2(), options.linear_floor_m_s2);
  EXPECT_EQ(steady.filter.angular_sigma_rad_s2(), options.angular_floor_rad_s2);
  Carrier wild(options);
  Shake(2 * options.linear_ceiling_m_s2, 2 * options.angular_ceiling_rad_s2, kExactly, true, &wild);
  EXPECT_EQ(wild.filter.linear_sigma_m_s2(), options.linear_ceiling_m_s2);
  EXPECT_EQ(wild.filter.angular_sigma_rad_s2(), options.angular_ceiling_rad_s2);
}

TEST(CameraMotionFilter, OnlyFramesThatSeeWellTeachTheAcceleration) {
  const CameraMotionFilterOptions options = WithMemory(kForever_s);
  const auto learnt_m_s2 = [&options](const Matrix6d& information, bool is_learnable) {
    Carrier carrier(options);
    Shake(0.5 * options.linear_ceiling_m_s2, 0.5 * options.angular_ceiling_rad_s2, information,
          is_learnable, &carrier);
    return carrier.filter.linear_sigma_m_s2();
  };
  EXPECT_NE(learnt_m_s2(kExactly, true), options.linear_start_m_s2);
  EXPECT_EQ(learnt_m_s2(kExactly, false), options.linear_start_m_s2);
  EXPECT_EQ(learnt_m_s2(kNothing, true), options.linear_start_m_s2);
  EXPECT_EQ(learnt_m_s2(Matrix6d::Identity(), true), options.linear_start_m_s2);
  // Nor do frames that leave one axis open.
  Matrix6d without_z = kExactly;
  without_z(2, 2) = 0;
  EXPECT_EQ(learnt_m_s2(without_z, true), options.linear_start_m_s2);
}

TEST(CameraMotionFilter, AJumpAfterACoastIsNoAcceleration) {
  // The camera went another way while nothing was seen: the prediction was off because it did not
  // know, not because the carrier is wild.
  const CameraMotionFilterOptions options = WithMemory(kForever_s);
  Carrier carrier(options);
  Shake(0.1, 0.1, kExactly, true, &carrier);
  for (int round = 0; round < 30; ++round) {
    for (int k = 0; k < 5; ++k) carrier.Coast();
    Vector6d jump = Vector6d::Zero();
    jump[0] = round % 2 == 0 ? 0.5 : -0.5;
    carrier.See(Boxplus(carrier.T_W_C, jump), kExactly, true);
  }
  EXPECT_EQ(carrier.filter.linear_sigma_m_s2(), options.linear_floor_m_s2);
}

void ExpectCovariance(const Matrix6d& covariance, int k) {
  ASSERT_TRUE(covariance.allFinite()) << "frame " << k;
  EXPECT_EQ((covariance - covariance.transpose()).norm(), 0) << "frame " << k;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(covariance);
  EXPECT_GT(eigen.eigenvalues()[0], -1e-12 * eigen.eigenvalues()[5]) << "frame " << k;
}

TEST(CameraMotionFilter, TheCovarianceStaysOne) {
  Carrier carrier{CameraMotionFilterOptions()};
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 2000; ++k) {
    const double dt = 0.02 + 0.3 * uniform(random);
    const PosePrior prior = carrier.Predict(dt);
    ExpectCovariance(prior.covariance, k);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(prior.covariance).eigenvalues()[0], 0);
    const int rank = static_cast<int>(9 * uniform(random));
    const Matrix6d information =
        RandomInformation(rank, std::pow(10, 9 * uniform(random) - 1), &random);
    Vector6d shift;
    for (int i = 0; i < 6; ++i) shift[i] = 0.05 * normal(random);
    carrier.See(Boxplus(prior.T_W_C, shift), information, uniform(random) < 0.7, dt);
    ExpectCovariance(carrier.filter.pose_covariance(), k);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace airdos
