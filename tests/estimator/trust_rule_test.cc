#include "common/optimization/window/trust_rule.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace airdos {
namespace {

/// Limits that binary numbers meet exactly.
TrustOptions Exact() {
  TrustOptions options;
  options.min_static_observations = 15;
  options.min_motion_factors = 20;
  options.max_rejected_share = 0.25;
  options.max_relative_sigma = 0.5;
  options.max_shift_chi2 = 16;
  return options;
}

class TrustRule : public ::testing::Test {
 protected:
  TrustRule() {
    without_.newest_covariance = 0.25 * Matrix6d::Identity();
    with_.newest_covariance = 0.0625 * Matrix6d::Identity();
    with_.num_motion = 40;
  }
  bool Trusts() const { return TrustsPeople(options_, num_static_, without_, with_, shift_); }

  TrustOptions options_ = Exact();
  int num_static_ = 14;
  BundleSummary without_, with_;
  Vector6d shift_ = Vector6d::Zero();
};

TEST_F(TrustRule, TheStaticScene) {
  EXPECT_TRUE(Trusts());
  num_static_ = 15;
  EXPECT_FALSE(Trusts());
}

TEST_F(TrustRule, TheNumberOfMotions) {
  with_.num_motion = 20;
  without_.num_motion = 1000;
  EXPECT_TRUE(Trusts());
  with_.num_motion = 19;
  EXPECT_FALSE(Trusts());
}

TEST_F(TrustRule, HowManyAgree) {
  without_.num_motion_rejected = with_.num_rigidity_rejected = 1000;
  with_.num_motion_rejected = 10;
  EXPECT_TRUE(Trusts());
  with_.num_motion_rejected = 11;
  EXPECT_FALSE(Trusts());
}

TEST_F(TrustRule, HowMuchMoreCertainTheyMakeThePosition) {
  // Only the position counts, by its whole trace: (0.25 + 0.25 + 0.25) / 4.
  with_.newest_covariance->diagonal() << 0.125, 0.03125, 0.03125, 9, 9, 9;
  EXPECT_TRUE(Trusts());
  with_.newest_covariance->diagonal()[2] = 0.032;
  EXPECT_FALSE(Trusts());
  // A ratio of the variances between the square of the limit and the limit.
  with_.newest_covariance = 0.4 * 0.25 * Matrix6d::Identity();
  EXPECT_FALSE(Trusts());
  with_.newest_covariance->setConstant(std::nan(""));
  EXPECT_FALSE(Trusts());
}

TEST_F(TrustRule, HowFarTheyMoveThePose) {
  shift_[4] = 2;  // 2^2 / 0.25
  EXPECT_TRUE(Trusts());
  shift_[4] = 2.001;
  EXPECT_FALSE(Trusts());
  shift_[4] = std::nan("");
  EXPECT_FALSE(Trusts());
  // Along the sure direction of a covariance that is not diagonal; (1, -1) has variance 2 (1 -
  // 0.9).
  shift_.setZero();
  shift_[0] = 1;
  shift_[1] = -1;
  without_.newest_covariance = Matrix6d::Identity();
  (*without_.newest_covariance)(0, 1) = (*without_.newest_covariance)(1, 0) = 0.9;
  EXPECT_FALSE(Trusts()) << "chi2 is 2 / 0.1 = 20";
  shift_ *= std::sqrt(15.9 / 20);
  EXPECT_TRUE(Trusts());
  // The covariance is that of the pose without people, not the sharper one.
  with_.newest_covariance = 1e-6 * Matrix6d::Identity();
  EXPECT_TRUE(Trusts());
}

TEST_F(TrustRule, BothCovariancesAreNeeded) {
  const auto covariance = with_.newest_covariance;
  with_.newest_covariance.reset();
  EXPECT_FALSE(Trusts());
  with_.newest_covariance = covariance;
  without_.newest_covariance.reset();
  EXPECT_FALSE(Trusts());
}

}  // namespace
}  // namespace airdos
