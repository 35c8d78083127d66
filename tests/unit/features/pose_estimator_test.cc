#include "common/features/pose_estimator.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

const StereoCamera kCamera = SmallStereoCamera();

Se3 TruePose() {
  Se3 T_W_C;
  T_W_C.translation = {1.5, -0.4, 3.0};
  T_W_C.rotation = ExpSo3({0.2, -0.7, 0.1});
  return T_W_C;
}

Se3 StartOff() {
  Vector6d delta;
  delta << 0.3, -0.2, 0.25, 0.06, -0.08, 0.05;
  return Boxplus(TruePose(), delta);
}

/// Points all over the image, 2 to 12 m away, as seen from TruePose() with Gaussian noise.
std::vector<PoseObservation> Observe(int count, double noise_px, std::uint32_t seed,
                                     bool has_right = true) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  std::vector<PoseObservation> observations;
  for (int i = 0; i < count; ++i) {
    const double z = 2 + 10 * uniform(random);
    const double u = kCamera.width * uniform(random);
    const double v = kCamera.height * uniform(random);
    const Eigen::Vector3d p_C((u - kCamera.cx_px) / kCamera.fx_px * z,
                              (v - kCamera.cy_px) / kCamera.fy_px * z, z);
    PoseObservation observation;
    observation.p_W = TruePose() * p_C;
    observation.uvu_px = kCamera.ProjectStereo(p_C) +
                         noise_px * Eigen::Vector3d{normal(random), normal(random), normal(random)};
    observation.has_right = has_right;
    if (!has_right) observation.uvu_px.z() = -1e6;  // must not be looked at
    observations.push_back(observation);
  }
  return observations;
}

/// Moves every observation i with i % 5 < 2 far off: 40 %.
void AddOutliers(std::vector<PoseObservation>* observations, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> far(-60, 60);
  for (std::size_t i = 0; i < observations->size(); ++i) {
    if (i % 5 < 2) (*observations)[i].uvu_px += Eigen::Vector3d{far(random), far(random), 25};
  }
}

double Error(const Se3& a, const Se3& b) { return Boxminus(a, b).norm(); }

TEST(PoseEstimator, WithoutNoiseThePoseIsExact) {
  const PoseEstimate estimate = EstimatePose(kCamera, Observe(40, 0, 1), StartOff(), std::nullopt);
  EXPECT_LT(Error(estimate.T_W_C, TruePose()), 1e-9);
  EXPECT_EQ(estimate.num_inliers, 40);
}

TEST(PoseEstimator, TheLeftImageAloneIsEnough) {
  const PoseEstimate estimate =
      EstimatePose(kCamera, Observe(40, 0, 1, false), StartOff(), std::nullopt);
  EXPECT_LT(Error(estimate.T_W_C, TruePose()), 1e-8);
  EXPECT_EQ(estimate.num_inliers, 40);
}

TEST(PoseEstimator, ConvergesFastBecauseTheJacobianIsRight) {
  // 3 stereo points, the fewest that will do: a wrong entry of the Jacobian shows at once. The
  // estimator has at most 24 steps; from 5 mm and 5 mrad, Gauss-Newton needs about 4.
  Vector6d delta;
  delta << 0.005, -0.004, 0.003, 0.004, -0.005, 0.003;
  const PoseEstimate estimate =
      EstimatePose(kCamera, Observe(3, 0, 8), Boxplus(TruePose(), delta), std::nullopt);
  EXPECT_LT(Error(estimate.T_W_C, TruePose()), 1e-10);
}

/// Inverse of J^T J by central differences of the projection; of the tangent in C.
Matrix6d Covariance(const std::vector<PoseObservation>& observations, double sigma_px) {
  Matrix6d information = Matrix6d::Zero();
  for (const PoseObservation& observation : observations) {
    Eigen::Matrix<double, 3, 6> J;
    for (int i = 0; i < 6; ++i) {
      constexpr double kStep = 1e-6;
      const Vector6d delta = kStep * Vector6d::Unit(i);
      J.col(i) = (kCamera.ProjectStereo(Boxplus(TruePose(), delta).inverse() * observation.p_W) -
                  kCamera.ProjectStereo(Boxplus(TruePose(), -delta).inverse() * observation.p_W)) /
                 (2 * kStep);
    }
    information += J.transpose() * J / (sigma_px * sigma_px);
  }
  return information.inverse();
}

TEST(PoseEstimator, NoiseGivesTheErrorThatTheCovarianceSays) {
  constexpr int kTrials = 200;
  double sum = 0;
  for (std::uint32_t seed = 1; seed <= kTrials; ++seed) {
    std::vector<PoseObservation> observations = Observe(30, 0.5, seed);
    for (PoseObservation& observation : observations) observation.sigma_px = 0.5;
    const PoseEstimate estimate = EstimatePose(kCamera, observations, StartOff(), std::nullopt);
    const Vector6d error = Boxminus(estimate.T_W_C, TruePose());
    sum += error.dot(Covariance(observations, 0.5).inverse() * error);
  }
  // Chi-square of 6 degrees of freedom has mean 6; over 200 trials its mean spreads by sqrt(12 /
  // 200) = 0.25. Setting aside the 5 % beyond the bound loses up to a tenth of the information.
  EXPECT_GT(sum / kTrials, 6 - 4 * 0.25);
  EXPECT_LT(sum / kTrials, (6 + 4 * 0.25) / 0.9);
}

TEST(PoseEstimator, PreciseObservationsWeighMore) {
  // Half of the observations are shifted by 2 px and say so in their sigma.
  std::vector<PoseObservation> observations = Observe(60, 0, 3);
  for (std::size_t i = 0; i < observations.size(); i += 2) {
    observations[i].uvu_px += Eigen::Vector3d(2, 2, 2);
    observations[i].sigma_px = 20;
    observations[i + 1].sigma_px = 0.2;
  }
  const PoseEstimate estimate = EstimatePose(kCamera, observations, StartOff(), std::nullopt);
  EXPECT_LT(Error(estimate.T_W_C, TruePose()), 1e-4);
}

TEST(PoseEstimator, FortyPercentOutliersAreSetAside) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    std::vector<PoseObservation> observations = Observe(100, 0.3, seed);
    AddOutliers(&observations, seed);
    const PoseEstimate estimate = EstimatePose(kCamera, observations, StartOff(), std::nullopt);
    // 60 inliers of 0.3 px: some 5 mm and 1 mrad; with one outlier of 25 px in, ten times more.
    EXPECT_LT(Error(estimate.T_W_C, TruePose()), 0.03) << "seed " << seed;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      if (i % 5 < 2) {
        EXPECT_FALSE(estimate.is_inlier[i]) << "seed " << seed << ", " << i;
      }
    }
    EXPECT_GE(estimate.num_inliers, 55);
    EXPECT_LE(estimate.num_inliers, 60);
  }
}

TEST(PoseEstimator, WithoutAnythingTheStartComesBack) {
  const PoseEstimate none = EstimatePose(kCamera, {}, StartOff(), std::nullopt);
  EXPECT_EQ(Error(none.T_W_C, StartOff()), 0);
  EXPECT_EQ(none.num_inliers, 0);
  const PoseEstimate two = EstimatePose(kCamera, Observe(2, 0, 1), StartOff(), std::nullopt);
  EXPECT_EQ(Error(two.T_W_C, StartOff()), 0);
}

TEST(PoseEstimator, ThePriorAloneIsReturned) {
  const PoseEstimate estimate =
      EstimatePose(kCamera, {}, StartOff(), IsotropicPrior(TruePose(), 0.04, 0.05));
  EXPECT_LT(Error(estimate.T_W_C, TruePose()), 1e-9);
}

TEST(PoseEstimator, ThePriorHoldsWhatTwoPointsLeaveFree) {
  // Two points leave the turn about the line between them free: it comes from the prior, which is
  // right about it; the rest from the points.
  const std::vector<PoseObservation> observations = Observe(2, 0, 5);
  const PosePrior prior = IsotropicPrior(TruePose(), 0.04, 0.05);
  EXPECT_LT(Error(EstimatePose(kCamera, observations, StartOff(), prior).T_W_C, TruePose()), 1e-6);
}

TEST(PoseEstimator, ThePriorIsWeighedAgainstTheObservations) {
  // The prior is off by one sigma on each axis. Many precise points overrule it, and the wider it
  // is, the more so.
  Vector6d off;
  off << 0.04, 0.04, 0.04, 0.05, 0.05, 0.05;
  std::vector<PoseObservation> observations = Observe(4, 0, 2);
  for (PoseObservation& observation : observations) observation.sigma_px = 5;
  const Se3 mean = Boxplus(TruePose(), off);
  const double tight =
      Error(EstimatePose(kCamera, observations, mean, IsotropicPrior(mean, 0.04, 0.05)).T_W_C,
            TruePose());
  const double wide = Error(
      EstimatePose(kCamera, observations, mean, IsotropicPrior(mean, 0.4, 0.5)).T_W_C, TruePose());
  EXPECT_LT(wide, 0.2 * tight);
  EXPECT_LT(tight, off.norm());
  EXPECT_GT(tight, 0.05 * off.norm());
}

TEST(PoseEstimator, EachSigmaOfThePriorHoldsItsOwnAxes) {
  // One point far ahead: the prior decides whether a shift of its pixel is a step or a turn.
  PoseObservation observation;
  observation.p_W = TruePose() * Eigen::Vector3d(0, 0, 8);
  observation.uvu_px = kCamera.ProjectStereo({0.4, 0, 8});
  observation.sigma_px = 0.1;
  const auto moved = [&](double sigma_position_m, double sigma_orientation_rad) {
    const PosePrior prior = IsotropicPrior(TruePose(), sigma_position_m, sigma_orientation_rad);
    const std::vector<PoseObservation> observations = {observation};
    return Boxminus(EstimatePose(kCamera, observations, TruePose(), prior).T_W_C, TruePose());
  };
  const Vector6d step = moved(0.5, 1e-3);
  EXPECT_NEAR(step.x(), -0.4, 0.01);
  EXPECT_NEAR(step.tail<3>().norm(), 0, 0.002);
  const Vector6d turn = moved(1e-3, 0.5);
  EXPECT_NEAR(turn.head<3>().norm(), 0, 0.02);
  EXPECT_NEAR(std::abs(turn[4]), 0.4 / 8, 0.003);
}

/// By how much the camera moves along x, m, to meet one point straight ahead that it sees 1 px to
/// the left, while the prior holds its turn: the point is known to `covariance_W`.
double MetBy_m(const Eigen::Matrix3d& covariance_W, bool has_right) {
  PoseObservation observation;
  observation.p_W = {0, 0, 4};
  observation.uvu_px = kCamera.ProjectStereo(observation.p_W) - Eigen::Vector3d(1, 0, 1);
  observation.has_right = has_right;
  observation.sigma_px = 0.8;
  observation.covariance_W = covariance_W;
  const PosePrior prior = IsotropicPrior(Se3(), 0.02, 1e-6);
  return EstimatePose(kCamera, {observation}, Se3(), prior).T_W_C.translation.x();
}

TEST(PoseEstimator, APointThatIsBadlyKnownWeighsLess) {
  // By hand, for the left image alone: one pixel is s = 4 m / fx; the prior's variance is p, the
  // point's along x is c, the pixel's is 0.8^2: the camera moves by s p / (p + c + (0.8 s)^2).
  const double s_m = 4 / kCamera.fx_px;
  const double p_m2 = 0.02 * 0.02;
  for (const double sigma_m : {0.0, 0.01, 0.05}) {
    const Eigen::Matrix3d covariance_W = Eigen::Vector3d(sigma_m * sigma_m, 0, 0).asDiagonal();
    const double pixel_m2 = 0.64 * s_m * s_m;
    const double expected_m = s_m * p_m2 / (p_m2 + sigma_m * sigma_m + pixel_m2);
    EXPECT_NEAR(MetBy_m(covariance_W, false), expected_m, 1e-6) << sigma_m;
  }
  // Both images see x, and both err with the point: a well known one weighs twice as much then, a
  // badly known one no more than before. (The right image also moves the depth a little.)
  const Eigen::Matrix3d bad = Eigen::Vector3d(0.0025, 0, 0).asDiagonal();
  EXPECT_NEAR(MetBy_m(Eigen::Matrix3d::Zero(), true), s_m * p_m2 / (p_m2 + 0.32 * s_m * s_m), 2e-5);
  EXPECT_NEAR(MetBy_m(bad, true), s_m * p_m2 / (p_m2 + 0.0025 + 0.32 * s_m * s_m), 2e-5);
  // How far away it is says nothing of x where it is straight ahead.
  const Eigen::Matrix3d deep = Eigen::Vector3d(0, 0, 0.0025).asDiagonal();
  EXPECT_NEAR(MetBy_m(deep, false), MetBy_m(Eigen::Matrix3d::Zero(), false), 1e-6);
}

TEST(PoseEstimator, ThePointsCovarianceIsInTheWorldsAxes) {
  // Half of the points are shifted by 10 cm along W's x, and known to be bad along it.
  std::vector<PoseObservation> observations = Observe(60, 0, 3);
  for (PoseObservation& observation : observations) observation.sigma_px = 0.1;
  for (std::size_t i = 0; i < observations.size(); i += 2) {
    observations[i].p_W.x() += 0.1;
    observations[i].covariance_W = Eigen::Vector3d(1, 0, 0).asDiagonal();
  }
  const PoseEstimate good = EstimatePose(kCamera, observations, StartOff(), std::nullopt);
  EXPECT_LT(Error(good.T_W_C, TruePose()), 1e-3);
  EXPECT_EQ(good.num_inliers, 60);
  for (std::size_t i = 0; i < observations.size(); i += 2)
    observations[i].covariance_W = Eigen::Vector3d(0, 0, 1).asDiagonal();
  const PoseEstimate bad = EstimatePose(kCamera, observations, StartOff(), std::nullopt);
  EXPECT_LT(bad.num_inliers, 40);
}

TEST(PoseEstimator, ExactPointsAreTheLimitOfWellKnownOnes) {
  const std::vector<PoseObservation> exact = Observe(30, 0.5, 9);
  std::vector<PoseObservation> known = exact;
  for (PoseObservation& observation : known)
    observation.covariance_W = 1e-14 * Eigen::Matrix3d::Identity();
  const PoseEstimate a = EstimatePose(kCamera, exact, StartOff(), std::nullopt);
  const PoseEstimate b = EstimatePose(kCamera, known, StartOff(), std::nullopt);
  EXPECT_LT(Error(a.T_W_C, b.T_W_C), 1e-8);
  EXPECT_EQ(a.is_inlier, b.is_inlier);
  EXPECT_LT((a.information - b.information).norm(), 1e-6 * a.information.norm());
}

TEST(PoseEstimator, TheInformationIsThatOfTheInliersAlone) {
  std::vector<PoseObservation> observations = Observe(30, 0, 9);
  for (PoseObservation& observation : observations) observation.sigma_px = 0.5;
  const Matrix6d expected = Covariance(observations, 0.5).inverse();
  observations.push_back(observations.front());
  observations.back().uvu_px.x() += 50;
  const PosePrior prior = IsotropicPrior(TruePose(), 0.01, 0.01);
  const PoseEstimate estimate = EstimatePose(kCamera, observations, TruePose(), prior);
  EXPECT_EQ(estimate.num_inliers, 30);
  EXPECT_LT((estimate.information - expected).norm(), 1e-6 * expected.norm());
}

/// Seen from a pose 30 cm off the prior of 2 cm.
PoseEstimate EstimateFarFromThePrior(int count) {
  Vector6d off = Vector6d::Zero();
  off[0] = 0.3;
  const PosePrior prior = IsotropicPrior(Boxplus(TruePose(), off), 0.02, 0.001);
  return EstimatePose(kCamera, Observe(count, 0, 4), prior.T_W_C, prior);
}

TEST(PoseEstimator, FewObservationsMustBeOnesThatThePriorAllows) {
  Vector6d off = Vector6d::Zero();
  off[0] = 0.3;
  // However well they agree with each other.
  const PoseEstimate few = EstimateFarFromThePrior(19);
  EXPECT_EQ(few.num_inliers, 0);
  EXPECT_LT(Error(few.T_W_C, Boxplus(TruePose(), off)), 1e-9);
  EXPECT_EQ(few.information, Matrix6d(Matrix6d::Zero()));
  // Many overrule the prior, but for what it is worth against them.
  const PoseEstimate many = EstimateFarFromThePrior(60);
  EXPECT_EQ(many.num_inliers, 60);
  EXPECT_LT(Error(many.T_W_C, TruePose()), 0.1 * 0.3);
}

TEST(PoseEstimator, OfFewObservationsTheImpossibleOnesStayOut) {
  // Six good ones, and six that agree on a pose 1 m away: without the prior's word either could
  // win.
  std::vector<PoseObservation> observations = Observe(12, 0, 4);
  for (std::size_t i = 6; i < 12; ++i) {
    observations[i].uvu_px = kCamera.ProjectStereo(TruePose().inverse() * observations[i].p_W +
                                                   Eigen::Vector3d(0, 1, 0));
  }
  const PosePrior prior = IsotropicPrior(TruePose(), 0.02, 0.01);
  const PoseEstimate estimate = EstimatePose(kCamera, observations, TruePose(), prior);
  EXPECT_LT(Error(estimate.T_W_C, TruePose()), 1e-9);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(estimate.is_inlier[i], i < 6);
}

TEST(PoseEstimator, PointsBehindTheCameraAreNoInliers) {
  std::vector<PoseObservation> observations = Observe(30, 0, 4, false);
  for (std::size_t i = 0; i < 10; ++i) {
    // Mirrored through the camera's centre, it projects to the same left pixel.
    observations[i].p_W = 2 * TruePose().translation - observations[i].p_W;
  }
  const PoseEstimate estimate = EstimatePose(kCamera, observations, StartOff(), std::nullopt);
  EXPECT_LT(Error(estimate.T_W_C, TruePose()), 1e-8);
  EXPECT_EQ(estimate.num_inliers, 20);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_FALSE(estimate.is_inlier[i]);
}

TEST(PoseEstimator, OnlyPointsBehindTheCameraGiveThePrior) {
  std::vector<PoseObservation> observations = Observe(10, 0, 4);
  for (PoseObservation& observation : observations)
    observation.p_W = 2 * TruePose().translation - observation.p_W;
  const PoseEstimate estimate =
      EstimatePose(kCamera, observations, TruePose(), IsotropicPrior(TruePose(), 0.04, 0.05));
  EXPECT_LT(Error(estimate.T_W_C, TruePose()), 1e-9);
  EXPECT_EQ(estimate.num_inliers, 0);
}

TEST(PoseEstimatorRansac, FindsThePoseFromNothing) {
  std::vector<PoseObservation> observations = Observe(100, 0.3, 6);
  AddOutliers(&observations, 6);
  const std::optional<Se3> T_W_C = EstimatePoseRansac(kCamera, observations, 4);
  ASSERT_TRUE(T_W_C);
  // A start only: the pose of the best few points, refined on what agrees within 4 px.
  EXPECT_LT(Error(*T_W_C, TruePose()), 0.1);
}

TEST(PoseEstimatorRansac, TwiceTheSameBits) {
  std::vector<PoseObservation> observations = Observe(100, 0.3, 6);
  AddOutliers(&observations, 6);
  const std::optional<Se3> a = EstimatePoseRansac(kCamera, observations, 4);
  const std::optional<Se3> b = EstimatePoseRansac(kCamera, observations, 4);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->translation, b->translation);
  EXPECT_EQ(a->rotation.coeffs(), b->rotation.coeffs());
}

TEST(PoseEstimatorRansac, NothingFromFewPoints) {
  EXPECT_FALSE(EstimatePoseRansac(kCamera, {}, 4));
  EXPECT_FALSE(EstimatePoseRansac(kCamera, Observe(5, 0, 1), 4));
  EXPECT_TRUE(EstimatePoseRansac(kCamera, Observe(6, 0, 1), 4));
}

TEST(PoseEstimator, ObservationsOfLittleWeightDoNotPullThePose) {
  // A group that moves together, more points than the world shows, but doubted.
  const auto moving = [](double weight) {
    std::vector<PoseObservation> observations = Observe(120, 0.1, 5);
    for (std::size_t i = 0; i < 80; ++i) {
      observations[i].p_W += Eigen::Vector3d(0.05, 0, 0);
      observations[i].weight = weight;
    }
    return observations;
  };
  const auto error_m = [&](double weight) {
    const PoseEstimate estimate = EstimatePose(kCamera, moving(weight), TruePose(), std::nullopt);
    return Boxminus(estimate.T_W_C, TruePose()).head<3>().norm();
  };
  EXPECT_GT(error_m(1.0), 0.03);
  EXPECT_LT(error_m(0.04), 0.005);
}

}  // namespace
}  // namespace airdos
