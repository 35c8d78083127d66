// The estimate of a pose: that it is the least of its cost, whom it leaves out, and what it says of
// its certainty.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

#include "common/features/pose_estimator.h"

namespace airdos {
namespace {

const StereoCamera kCamera{640, 360, 700, 650, 310, 190, 0.25};

/// In front of the camera at `T_W_C`, seen without error.
PoseObservation Seen(const Se3& T_W_C, const Eigen::Vector3d& p_C, double sigma_px,
                     bool has_right) {
  PoseObservation observation;
  observation.p_W = T_W_C * p_C;
  observation.uvu_px = kCamera.ProjectStereo(p_C);
  observation.sigma_px = sigma_px;
  observation.has_right = has_right;
  return observation;
}

std::vector<PoseObservation> Scattered(const Se3& T_W_C, int num, double sigma_px) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<PoseObservation> observations;
  for (int i = 0; i < num; ++i) {
    const double z = 6 + 3 * uniform(generator);
    const Eigen::Vector3d p_C{0.3 * z * uniform(generator), 0.2 * z * uniform(generator), z};
    observations.push_back(Seen(T_W_C, p_C, sigma_px, i % 2 == 0));
  }
  return observations;
}

/// Half the sum of squares of all residuals and of the prior.
double Cost(const std::vector<PoseObservation>& observations, const PosePrior& prior,
            const Se3& T_W_C) {
  const Vector6d error = Boxminus(T_W_C, prior.T_W_C);
  double cost = error.dot(prior.covariance.inverse() * error);
  for (const PoseObservation& observation : observations) {
    const Eigen::Vector3d difference =
        observation.uvu_px - kCamera.ProjectStereo(T_W_C.inverse() * observation.p_W);
    const double squares =
        observation.has_right ? difference.squaredNorm() : difference.head<2>().squaredNorm();
    cost += observation.weight * squares / (observation.sigma_px * observation.sigma_px);
  }
  return 0.5 * cost;
}

template <class Function>
Vector6d Gradient(const Function& cost, const Se3& at) {
  constexpr double kStep = 1e-5;
  Vector6d gradient;
  for (int i = 0; i < 6; ++i) {
    const Vector6d d = kStep * Vector6d::Unit(i);
    gradient[i] = (cost(Boxplus(at, d)) - cost(Boxplus(at, -d))) / (2 * kStep);
  }
  return gradient;
}

// A prior half a radian off pulls at a pose that is seen only roughly. Where the two balance the
// slope of the cost is none, by its definition and not by our Jacobians.
TEST(PoseEstimatorValues, TheEstimateIsTheLeastOfItsCost) {
  const Se3 truth{ExpSo3({0.2, -0.1, 0.3}), {0.5, -0.25, 1}};
  std::vector<PoseObservation> observations = Scattered(truth, 40, 20);
  for (std::size_t i = 0; i < observations.size(); ++i)
    observations[i].weight = 0.4 + 0.015 * static_cast<double>(i);
  Vector6d off;
  off << 0.1, -0.2, 0.15, 0.5, -0.4, 0.3;
  Matrix6d A;
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 36; ++i) A(i / 6, i % 6) = normal(generator);
  const PosePrior prior{Boxplus(truth, off), 0.02 * (A * A.transpose() + Matrix6d::Identity())};
  const PoseEstimate estimate = EstimatePose(kCamera, observations, truth, prior);
  ASSERT_EQ(estimate.num_inliers, 40);
  const Vector6d of_all =
      Gradient([&](const Se3& at) { return Cost(observations, prior, at); }, estimate.T_W_C);
  const Vector6d of_prior =
      Gradient([&](const Se3& at) { return Cost({}, prior, at); }, estimate.T_W_C);
  EXPECT_GT(Boxminus(estimate.T_W_C, truth).norm(), 1e-3) << "the prior has no say";
  EXPECT_LT(of_all.norm(), 1e-3 * of_prior.norm());
}

// The prior knows the place to 5 cm and is 4.2 sigma off, sideways. Points 20 m away agree with it,
// as for them that is 7 px of which the prior may be 1.75 px off; those at 2 m do not. In the end
// the far ones have moved the pose to where the near ones would agree: they stay out.
TEST(PoseEstimatorValues, WhomThePriorDoesNotAllowStaysOut) {
  const Se3 truth;
  Se3 mean;
  mean.translation = {0.21, 0, 0};
  std::vector<PoseObservation> observations;
  for (int i = 0; i < 16; ++i)
    observations.push_back(Seen(truth, {0.4 * i - 3, 0.2 * (i % 5), 20}, 1, false));
  for (const double x : {-0.3, 0.3}) observations.push_back(Seen(truth, {x, 0.1, 2}, 1, false));
  const PoseEstimate estimate =
      EstimatePose(kCamera, observations, mean, IsotropicPrior(mean, 0.05, 1e-4));
  for (std::size_t i = 0; i < 16; ++i) EXPECT_TRUE(estimate.is_inlier[i]) << i;
  EXPECT_FALSE(estimate.is_inlier[16]);
  EXPECT_FALSE(estimate.is_inlier[17]);
  EXPECT_EQ(estimate.num_inliers, 16);
  for (std::size_t i = 16; i < 18; ++i) {
    const Eigen::Vector3d seen =
        kCamera.ProjectStereo(estimate.T_W_C.inverse() * observations[i].p_W);
    EXPECT_LT((seen - observations[i].uvu_px).head<2>().norm(), 2.4) << "they would agree";
  }
  // Without a prior, or with more that check each other, nobody is asked to begin with.
  std::vector<PoseObservation> more = observations;
  for (int i = 0; i < 4; ++i) more.push_back(Seen(truth, {0.5 * i, -0.5, 15}, 1, false));
  EXPECT_EQ(EstimatePose(kCamera, more, mean, IsotropicPrior(mean, 0.05, 1e-4)).num_inliers, 22);
}

TEST(PoseEstimatorValues, TheInformationIsThatOfTheWeightedInliers) {
  const Se3 truth{ExpSo3({0.2, -0.1, 0.3}), {0.5, -0.25, 1}};
  std::vector<PoseObservation> observations = Scattered(truth, 30, 0.7);
  Matrix6d expected = Matrix6d::Zero();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    PoseObservation& observation = observations[i];
    observation.weight = 0.1 + 0.03 * static_cast<double>(i);
    const int num_rows = observation.has_right ? 3 : 2;
    for (int row = 0; row < num_rows; ++row) {
      const Vector6d slope = Gradient(
          [&](const Se3& at) {
            return kCamera.ProjectStereo(at.inverse() * observation.p_W)[row] / 0.7;
          },
          truth);
      expected += observation.weight * slope * slope.transpose();
    }
  }
  observations.push_back(observations[3]);  // once more, but seen elsewhere: not an inlier
  observations.back().uvu_px.x() += 30;
  const PoseEstimate estimate = EstimatePose(kCamera, observations, truth, std::nullopt);
  EXPECT_EQ(estimate.num_inliers, 30);
  EXPECT_LT((estimate.information - expected).norm(), 1e-5 * expected.norm());
}

// Of a point that is itself known to L only: S = J L J^T + sigma^2 I in pixels.
TEST(PoseEstimatorValues, AnUncertainPointSaysLess) {
  const Se3 truth{ExpSo3({0.2, -0.1, 0.3}), {0.5, -0.25, 1}};
  Eigen::Matrix3d L;
  L << 4e-3, 1e-3, -2e-3, 1e-3, 3e-3, 5e-4, -2e-3, 5e-4, 9e-3;
  for (const bool has_right : {true, false}) {
    std::vector<PoseObservation> observations = Scattered(truth, 30, 0.7);
    Matrix6d expected = Matrix6d::Zero();
    for (PoseObservation& observation : observations) {
      observation.has_right = has_right;
      observation.covariance_W = L;
      const int num_rows = has_right ? 3 : 2;
      Eigen::MatrixXd by_pose(num_rows, 6), by_point(num_rows, 3);
      for (int row = 0; row < num_rows; ++row) {
        const auto pixel = [&](const Se3& T_W_C, const Eigen::Vector3d& p_W) {
          return kCamera.ProjectStereo(T_W_C.inverse() * p_W)[row];
        };
        by_pose.row(row) =
            Gradient([&](const Se3& at) { return pixel(at, observation.p_W); }, truth);
        for (int i = 0; i < 3; ++i) {
          const Eigen::Vector3d d = 1e-5 * Eigen::Vector3d::Unit(i);
          by_point(row, i) =
              (pixel(truth, observation.p_W + d) - pixel(truth, observation.p_W - d)) / 2e-5;
        }
      }
      const Eigen::MatrixXd S = by_point * L * by_point.transpose() +
                                0.49 * Eigen::MatrixXd::Identity(num_rows, num_rows);
      expected += by_pose.transpose() * S.inverse() * by_pose;
    }
    const PoseEstimate estimate = EstimatePose(kCamera, observations, truth, std::nullopt);
    EXPECT_LT((estimate.information - expected).norm(), 1e-5 * expected.norm()) << has_right;
  }
}

// 95 %: 7.815 of three numbers, 5.991 of two.
TEST(PoseEstimatorValues, TheBoundOfAnInlierIsThatOfItsNumbers) {
  const Se3 truth;
  for (const bool has_right : {true, false}) {
    const double bound = std::sqrt(has_right ? 7.815 : 5.991);
    for (const double factor : {0.97, 1.03}) {
      std::vector<PoseObservation> observations;
      for (int i = 0; i < 300; ++i) {
        const double z = 5 + 0.01 * i;
        observations.push_back(
            Seen(truth, {0.1 * (i % 17) - 0.8, 0.1 * (i % 9) - 0.4, z}, 1, true));
      }
      observations.push_back(Seen(truth, {0.2, 0.1, 7}, 1, has_right));
      observations.back().uvu_px.y() += factor * bound;
      const PoseEstimate estimate = EstimatePose(kCamera, observations, truth, std::nullopt);
      EXPECT_EQ(estimate.is_inlier.back(), factor < 1) << has_right << " " << factor;
    }
  }
}

}  // namespace
}  // namespace airdos
