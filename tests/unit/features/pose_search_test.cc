#include "common/features/pose_search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/walked_frame.h"

namespace airdos {
namespace {

// Depth at 3 m is known to 4 mm (0.1 px), and some hundred landmarks say where the camera is.
constexpr double kMaxPositionError_m = 0.01;
constexpr double kMaxRotationError_rad = 0.002;

double PositionError_m(const Se3& T_W_C, int k) {
  return Boxminus(T_W_C, WalkedFrame::Truth(k)).head<3>().norm();
}

void ExpectAt(const Se3& T_W_C, int k) {
  EXPECT_LT(PositionError_m(T_W_C, k), kMaxPositionError_m);
  EXPECT_LT(Boxminus(T_W_C, WalkedFrame::Truth(k)).tail<3>().norm(), kMaxRotationError_rad);
}

class PoseSearchTest : public testing::Test {
 protected:
  MeasuredPose FindBest(const StereoFrame& frame, const PosePrior& prior) const {
    return PoseSearch(options_, frame, map_, judge_).FindBest(prior);
  }

  VisualOdometryOptions options_;
  LocalMap map_ = MapOfFirstFrame();
  LandmarkJudge judge_;
};

/// Half a metre and half a radian off: landmarks project some hundred pixels beside where they are.
Se3 FarOff(int k) {
  Vector6d delta;
  delta << 0.4, 0.1, -0.3, 0.05, 0.5, 0;
  return Boxplus(WalkedFrame::Truth(k), delta);
}

TEST_F(PoseSearchTest, FromAPredictionThatIsNearlyRight) {
  const WalkedFrame frame(2);
  // As the last frame had it: 5 cm and 1.5 degrees away.
  const MeasuredPose best = FindBest(*frame, IsotropicPrior(WalkedFrame::Truth(1), 0.1, 0.05));
  ExpectAt(best.estimate.T_W_C, 2);
  EXPECT_GT(best.hypothesis.matches.size(), 50u);
  EXPECT_EQ(best.estimate.is_inlier.size(), best.seen.sightings.size());
  EXPECT_GT(best.seen.looked_for.size(), 50u);
  EXPECT_GT(best.score, 30);
  // The corners alone say it less well, but well enough to look for the patches from there.
  EXPECT_LT(PositionError_m(best.hypothesis.T_W_C, 2), 0.05);
}

TEST_F(PoseSearchTest, ByDescriptorsWhereThePredictionIsWrong) {
  const WalkedFrame frame(2);
  const PosePrior wrong = IsotropicPrior(FarOff(2), 0.3, 0.3);
  ExpectAt(FindBest(*frame, wrong).estimate.T_W_C, 2);
  // Whose second hypothesis is spared has to live with the first.
  options_.rich_observations = -1000000;
  EXPECT_GT(PositionError_m(FindBest(*frame, wrong).estimate.T_W_C, 2), 0.1);
}

TEST_F(PoseSearchTest, OnlyLandmarksOfTheLastFramesAreSearchedInTheWholeImage) {
  const WalkedFrame frame(2);
  const PosePrior wrong = IsotropicPrior(FarOff(2), 0.3, 0.3);
  for (auto& [id, landmark] : map_.landmarks()) landmark.last_seen = FrameId{-10};
  ExpectAt(FindBest(*frame, wrong).estimate.T_W_C, 2);  // however long ago
  // Three frames since then saw one landmark each, and these three say nothing.
  auto landmark = map_.landmarks().begin();
  for (std::int64_t seen = -3; seen < 0; ++seen) (landmark++)->second.last_seen = FrameId{seen};
  EXPECT_GT(PositionError_m(FindBest(*frame, wrong).estimate.T_W_C, 2), 0.1);
}

TEST_F(PoseSearchTest, WithoutLandmarksThePriorStays) {
  map_.landmarks().clear();
  const WalkedFrame frame(2);
  const MeasuredPose best = FindBest(*frame, IsotropicPrior(FarOff(2), 0.3, 0.3));
  EXPECT_LT(Boxminus(best.estimate.T_W_C, FarOff(2)).norm(), 1e-9);
  EXPECT_EQ(best.estimate.num_inliers, 0);
  EXPECT_TRUE(best.seen.sightings.empty());
  EXPECT_TRUE(best.hypothesis.matches.empty());
}

TEST_F(PoseSearchTest, OfAPoseThatTooFewSupportItIsNotSaidWhatShouldBeInView) {
  const WalkedFrame frame(2);
  const PosePrior prior = IsotropicPrior(WalkedFrame::Truth(2), 0.1, 0.05);
  EXPECT_FALSE(FindBest(*frame, prior).seen.looked_for.empty());
  options_.min_inliers_weak = 100000;
  const MeasuredPose best = FindBest(*frame, prior);
  EXPECT_TRUE(best.seen.looked_for.empty());
  EXPECT_FALSE(best.seen.sightings.empty());
}

TEST_F(PoseSearchTest, NoMoreAreMeasuredThanMayBeObserved) {
  options_.max_observations = 20;
  const WalkedFrame frame(2);
  const MeasuredPose best = FindBest(*frame, IsotropicPrior(WalkedFrame::Truth(2), 0.1, 0.05));
  EXPECT_EQ(best.seen.sightings.size(), 20u);
  EXPECT_EQ(best.estimate.is_inlier.size(), 20u);
}

// Half of the landmarks went 3 cm to the right, all by the same: whom the pose follows is a matter
// of trust.
TEST_F(PoseSearchTest, TrustedLandmarksOutweighDoubtfulOnes) {
  const WalkedFrame frame(1);
  const PosePrior prior = IsotropicPrior(WalkedFrame::Truth(1), 0.1, 0.05);
  const std::vector<LandmarkSighting> sightings = FindBest(*frame, prior).seen.sightings;
  const auto error_m = [&](bool moved_is_trusted) {
    LocalMap map = map_;
    for (auto& [id, landmark] : map.landmarks()) {
      const bool is_moved = id.value % 2 == 0;
      if (is_moved) landmark.p_W.x() += 0.03;
      landmark.trust = LandmarkTrust(is_moved == moved_is_trusted ? 0.7 : 0.05);
    }
    const PoseSearch search(options_, *frame, map, judge_);
    return PositionError_m(search.Estimate(sightings, prior.T_W_C, prior).T_W_C, 1);
  };
  EXPECT_LT(error_m(false), kMaxPositionError_m);
  EXPECT_GT(error_m(true), 0.02);
}

}  // namespace
}  // namespace airdos
