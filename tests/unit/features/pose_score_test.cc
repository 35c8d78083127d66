#include "common/features/pose_score.h"

#include <gtest/gtest.h>

#include <cmath>

namespace airdos {
namespace {

const PosePrior kPrior = IsotropicPrior(Se3(), 0.04, 0.05);

Se3 MovedBy(double shift_m) {
  Se3 T_W_C;
  T_W_C.translation.x() = shift_m;
  return T_W_C;
}

PoseEstimate EstimateAt(const Se3& T_W_C, std::vector<bool> is_inlier) {
  PoseEstimate estimate;
  estimate.T_W_C = T_W_C;
  estimate.is_inlier = std::move(is_inlier);
  return estimate;
}

TEST(LogPrior, IsHighestAtTheMeanAndFallsWithTheDistance) {
  EXPECT_EQ(LogPrior(kPrior, Se3()), 0);
  EXPECT_LT(LogPrior(kPrior, MovedBy(0.04)), 0);
  EXPECT_LT(LogPrior(kPrior, MovedBy(0.2)), LogPrior(kPrior, MovedBy(0.04)));
  // By hand: (3 + 6) / 2 * ln(1 + 3^2 / 3).
  EXPECT_NEAR(LogPrior(kPrior, MovedBy(0.12)), -4.5 * std::log(4.0), 1e-12);
}

TEST(LogPrior, CountsTheOrientationByItsOwnSigma) {
  Se3 turned;
  turned.rotation = ExpSo3({0, 0.15, 0});
  EXPECT_NEAR(LogPrior(kPrior, turned), -4.5 * std::log(4.0), 1e-12);
}

TEST(LogPrior, AJerkIsUnlikelyButNotImpossible) { EXPECT_GT(LogPrior(kPrior, MovedBy(1.0)), -30); }

TEST(ScorePose, AFewTrustedLandmarksOutweighMoreDoubtfulOnes) {
  const std::vector<double> trust = {0.9, 0.9, 0.2, 0.2, 0.2, 0.2};
  const PoseEstimate with_trusted = EstimateAt(Se3(), {true, true, false, false, false, false});
  const PoseEstimate with_doubtful = EstimateAt(Se3(), {false, false, true, true, true, true});
  EXPECT_NEAR(ScorePose(with_trusted, trust, kPrior), 1.8, 1e-12);
  EXPECT_NEAR(ScorePose(with_doubtful, trust, kPrior), 0.8, 1e-12);
}

TEST(ScorePose, OfTwoThatSeeTheSameTheLikelierMotionWins) {
  const std::vector<double> trust = {0.9, 0.9, 0.9};
  EXPECT_GT(ScorePose(EstimateAt(MovedBy(0.01), {true, true, true}), trust, kPrior),
            ScorePose(EstimateAt(MovedBy(0.3), {true, true, true}), trust, kPrior));
}

TEST(ScorePose, WithoutObservationsThePriorAloneCounts) {
  EXPECT_EQ(ScorePose(EstimateAt(Se3(), {}), {}, kPrior), 0);
}

}  // namespace
}  // namespace airdos
