#include "common/human/human_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/human/shift_vote.h"

// The costs and rules of one person's track, worked by hand.

namespace airdos {
namespace {

constexpr double kHeight_px = 200;
constexpr double kDisparity_px = 20;

/// A person of 14 joints around (u, v); all are seen.
BodyKeypoints Body(double u_px, double v_px, double confidence = 0.85) {
  BodyKeypoints body;
  for (std::size_t joint = 0; joint < body.size(); ++joint) {
    const double place = static_cast<double>(joint);
    body[joint] = {u_px + 7 * place, v_px + 11 * place - place * place, confidence};
  }
  return body;
}

PersonDetection Detection(double u_px, double v_px, double disparity_px = kDisparity_px) {
  PersonDetection detection;
  detection.left = Body(u_px, v_px);
  detection.disparity_px = disparity_px;
  detection.height_px = kHeight_px;
  return detection;
}

/// Clothes whose distance from each other is sqrt(1 - sqrt(share)).
Appearance Clothes(float share) {
  Appearance clothes;
  for (auto& histogram : clothes.histograms) {
    histogram.fill(0);
    histogram[2] = share;
    histogram[5] = 1 - share;
  }
  return clothes;
}

HumanTrackOptions Options() {
  HumanTrackOptions options;
  options.motion_sigma_per_height = 0.125;
  options.motion_sigma_growth_per_height = 0.0625;
  options.max_motion_per_height = 0.5;
  options.max_motion_growth_per_height = 0.25;
  options.disparity_sigma_px = 1;
  options.depth_sigma = 0.1;
  options.depth_sigma_growth = 0.05;
  options.appearance_sigma = 0.25;
  options.unknown_appearance_cost = 1.5;
  options.appearance_rate = 0.25;
  options.velocity_rate = 0.25;
  return options;
}

HumanTrack Track(const PersonDetection& first = Detection(100, 100)) {
  return HumanTrack(Options(), HumanId{5}, first);
}

using Flow = std::array<std::optional<Eigen::Vector2d>, kNumJoints>;

TEST(HumanTrack, TheCostOfAStep) {
  HumanTrack track = Track();
  // 30 and 40 px: a quarter of the height, two sigmas.
  EXPECT_NEAR(*track.Cost(Detection(130, 140)), 4 + 1.5, 1e-9);
  EXPECT_TRUE(track.Cost(Detection(160, 180))) << "exactly the farthest";
  EXPECT_FALSE(track.Cost(Detection(160.1, 180)));
  track.Miss();
  track.Miss();
  EXPECT_NEAR(*track.Cost(Detection(130, 140)), 1 + 1.5, 1e-9);
  EXPECT_TRUE(track.Cost(Detection(300, 100))) << "exactly the farthest after two frames";
  EXPECT_FALSE(track.Cost(Detection(300.1, 100)));
}

TEST(HumanTrack, JointsThatAreNotSeenDoNotCount) {
  const HumanTrack track = Track();
  PersonDetection detection = Detection(130, 140);
  for (std::size_t joint = 3; joint < detection.left.size(); ++joint) {
    detection.left[joint] = {9000, 9000, 0.09};
  }
  EXPECT_NEAR(*track.Cost(detection), 4 + 1.5, 1e-9);
  EXPECT_LT((*track.Displacement(detection) - Eigen::Vector2d(30, 40)).norm(), 1e-9);
  detection.left[2].confidence = 0;
  EXPECT_FALSE(track.Cost(detection)) << "two joints are too few";
  EXPECT_FALSE(track.Displacement(detection));
}

TEST(HumanTrack, TheCostOfAChangeOfDepth) {
  HumanTrack track = Track();
  const double change = std::log(25.0 / 20.0);
  // sqrt(2) * 1 px of the smaller disparity, whichever that is.
  const double variance = 0.01 + 2 / 400.0;
  EXPECT_NEAR(track.LooksCost(Detection(0, 0, 25)), change * change / variance + 1.5, 1e-9);
  EXPECT_NEAR(track.LooksCost(Detection(0, 0, 16)), change * change / (0.01 + 2 / 256.0) + 1.5,
              1e-9);
  track.Miss();
  track.Miss();
  EXPECT_NEAR(track.LooksCost(Detection(0, 0, 25)), change * change / (0.04 + 2 / 400.0) + 1.5,
              1e-9);
  PersonDetection left_only = Detection(0, 0);
  left_only.disparity_px.reset();
  EXPECT_NEAR(track.LooksCost(left_only), 1.5, 1e-9);
}

TEST(HumanTrack, TheCostOfOtherClothes) {
  PersonDetection first = Detection(100, 100);
  first.appearance = Clothes(1);
  HumanTrack track = Track(first);
  PersonDetection other = Detection(100, 100);
  other.appearance = Clothes(0.25F);
  // Distance sqrt(1 - 0.5), in sigmas squared.
  EXPECT_NEAR(track.LooksCost(other), 0.5 / 0.0625, 1e-5);
  // A quarter of the new clothes come in: share 1 - 0.25 * 0.75.
  track.Observe(other, {0, 0});
  PersonDetection pure = Detection(100, 100);
  pure.appearance = Clothes(1);
  EXPECT_NEAR(track.LooksCost(pure), (1 - std::sqrt(0.8125)) / 0.0625, 1e-5);
  EXPECT_NEAR(track.LooksCost(Detection(100, 100)), 1.5, 1e-9) << "nothing seen of them";
  HumanTrack unknown = Track();
  unknown.Observe(other, {0, 0});  // the first look counts whole
  EXPECT_NEAR(unknown.LooksCost(other), 0, 1e-5);
}

TEST(HumanTrack, ADetectionIsTakenWithWhatItHas) {
  HumanTrack track = Track();
  EXPECT_EQ(track.num_seen(), 1);
  track.Miss();
  EXPECT_EQ(track.num_missed(), 1);
  PersonDetection detection = Detection(110, 100, 25);
  detection.height_px = 250;
  track.Observe(detection, {0, 0});
  EXPECT_EQ(track.num_seen(), 2);
  EXPECT_EQ(track.num_missed(), 0);
  EXPECT_EQ(track.disparity_px(), 25);
  EXPECT_EQ(track.height_px(), 250);
  detection.disparity_px.reset();
  detection.height_px = 0;
  track.Observe(detection, {0, 0});
  EXPECT_EQ(track.disparity_px(), 25) << "the left image says nothing of it";
  EXPECT_EQ(track.height_px(), 250);
  EXPECT_EQ(track.left()[3].u_px, detection.left[3].u_px);
}

TEST(HumanTrack, ItsOwnVelocityIsWhatTheCamerasShiftLeaves) {
  HumanTrack track = Track();
  const Eigen::Vector2d shift_px(10, -4);
  track.Predict(Flow(), shift_px);
  EXPECT_EQ(track.left()[0].u_px, 110);
  EXPECT_EQ(track.left()[0].v_px, 96);
  track.Observe(Detection(118, 104), shift_px);  // (18, 4) since the image before
  EXPECT_LT((track.velocity_px() - 0.25 * Eigen::Vector2d(8, 8)).norm(), 1e-9);
  EXPECT_LT((track.Guess(0, shift_px) - Eigen::Vector2d(130, 102)).norm(), 1e-9);
  track.Predict(Flow(), shift_px);
  EXPECT_EQ(track.left()[0].u_px, 130);
  EXPECT_EQ(track.left()[0].v_px, 102);
  EXPECT_FALSE(track.is_carried(0));
  track.Observe(Detection(128, 100), shift_px);  // none of its own: a quarter is forgotten
  EXPECT_LT((track.velocity_px() - 0.75 * Eigen::Vector2d(2, 2)).norm(), 1e-9);
}

/// Flow that moves joints 0 to 7 by `move`, and does not know the others.
Flow Moved(const HumanTrack& track, const Eigen::Vector2d& move) {
  Flow flow;
  for (std::size_t joint = 0; joint < 8; ++joint) flow[joint] = track.left()[joint].uv_px() + move;
  return flow;
}

TEST(HumanTrack, FlowCarriesJointsThatAgree) {
  HumanTrack track = Track();
  Flow flow = Moved(track, {60, 5});
  *flow[1] += Eigen::Vector2d(41.9, 0);  // a fifth of the height, and 2 px
  *flow[2] += Eigen::Vector2d(42.1, 0);
  track.Predict(flow, {3, 3});
  EXPECT_TRUE(track.is_carried(0));
  EXPECT_TRUE(track.is_carried(1));
  EXPECT_FALSE(track.is_carried(2)) << "that follows somebody else";
  EXPECT_FALSE(track.is_carried(9));
  EXPECT_NEAR(track.left()[0].u_px, 160, 1e-9);
  EXPECT_NEAR(track.left()[1].u_px, 107 + 101.9, 1e-9);
  EXPECT_NEAR(track.left()[2].u_px, 114 + 60, 1e-9) << "goes with the rest";
  EXPECT_NEAR(track.left()[9].u_px, 163 + 60, 1e-9);
  EXPECT_NEAR(track.left()[9].v_px, 100 + 99 - 81 + 5, 1e-9);
}

TEST(HumanTrack, WhoIsHiddenIsNotDraggedAlong) {
  HumanTrack track = Track();
  track.Miss();
  track.Predict(Moved(track, {43, 3}), {3, 3});
  EXPECT_TRUE(track.is_carried(0)) << "a fifth of the height from where it should be";
  EXPECT_EQ(track.left()[0].u_px, 143);
  HumanTrack hidden = Track();
  hidden.Miss();
  hidden.Predict(Moved(hidden, {43.1, 3}), {3, 3});
  EXPECT_FALSE(hidden.is_carried(0));
  EXPECT_EQ(hidden.left()[0].u_px, 103) << "with the camera";
}

TEST(HumanTrack, AnUnseenJointIsNotCarried) {
  PersonDetection first = Detection(100, 100);
  first.left[4].confidence = 0;
  HumanTrack track = Track(first);
  track.Predict(Moved(track, {10, 0}), {0, 0});
  EXPECT_FALSE(track.is_carried(4));
  EXPECT_TRUE(track.is_carried(5));
}

/// A person whose right and left joints are `apart_px` apart.
BodyKeypoints Sides(double apart_px) {
  BodyKeypoints body = Body(100, 100);
  for (int right = kRightShoulder; right <= kRightAnkle; ++right) {
    const int left = SwappedJoint(right, SideSwap::kAll);
    if (left <= right) continue;
    body[static_cast<std::size_t>(left)] = body[static_cast<std::size_t>(right)];
    body[static_cast<std::size_t>(left)].u_px += apart_px;
  }
  return body;
}

TEST(HumanTrack, ASwapIsWhatSavesEnough) {
  HumanTrackOptions options = Options();
  options.noise.min_px = 2;
  options.noise.per_height = 0;
  // sigma: sqrt(2) * 2 px and a fiftieth of the height.
  const double sigma_px = 2 * std::sqrt(2.0) + 4;
  PersonDetection first = Detection(100, 100);
  first.left = Sides(2 * sigma_px);
  const HumanTrack track(options, HumanId{1}, first);
  const BodyKeypoints swapped = SwapSides(first.left, SideSwap::kAll);
  // Twelve joints, each off by two sigmas; of the legs four.
  EXPECT_TRUE(track.HasSwap(swapped, SideSwap::kAll, 47.9));
  EXPECT_FALSE(track.HasSwap(swapped, SideSwap::kAll, 48.1));
  EXPECT_FALSE(track.HasSwap(first.left, SideSwap::kAll, 0));
  EXPECT_FALSE(track.HasSwap(first.left, SideSwap::kAll, -47.9)) << "it would cost as much";
  EXPECT_TRUE(track.HasSwap(first.left, SideSwap::kAll, -48.1));
  const BodyKeypoints legs = SwapSides(first.left, SideSwap::kLowerLegs);
  EXPECT_TRUE(track.HasSwap(legs, SideSwap::kLowerLegs, 15.9));
  EXPECT_FALSE(track.HasSwap(legs, SideSwap::kLowerLegs, 16.1));
  // A joint counts as nine at most.
  first.left = Sides(10 * sigma_px);
  const HumanTrack wide(options, HumanId{1}, first);
  EXPECT_FALSE(wide.HasSwap(SwapSides(first.left, SideSwap::kAll), SideSwap::kAll, 108.1));
  EXPECT_TRUE(wide.HasSwap(SwapSides(first.left, SideSwap::kAll), SideSwap::kAll, 107.9));
}

TEST(HumanTrack, AfterThreeMissesSidesCannotBeTold) {
  HumanTrackOptions options = Options();
  options.noise.min_px = 2;
  options.noise.per_height = 0;
  PersonDetection first = Detection(100, 100);
  const double sigma_px = 2 * std::sqrt(2.0) + 4 * 3;  // limbs move on, a fiftieth a frame
  first.left = Sides(2 * sigma_px);
  HumanTrack track(options, HumanId{1}, first);
  track.Miss();
  track.Miss();
  const BodyKeypoints swapped = SwapSides(first.left, SideSwap::kAll);
  EXPECT_TRUE(track.HasSwap(swapped, SideSwap::kAll, 47.9));
  EXPECT_FALSE(track.HasSwap(swapped, SideSwap::kAll, 48.1));
  track.Miss();
  EXPECT_FALSE(track.HasSwap(swapped, SideSwap::kAll, 1));
}

PersonDetection Dressed(double u_px, float share) {
  PersonDetection detection = Detection(u_px, 100);
  detection.appearance = Clothes(share);
  return detection;
}

TEST(ShiftVote, WhoLooksAlikeVotes) {
  const std::vector<HumanTrack> tracks = {Track(Dressed(100, 1)), Track(Dressed(300, 0))};
  // Both moved by 80 px; taken for each other they would have moved by 280 and -120.
  const Eigen::Vector2d shift =
      VoteShift(tracks, {Dressed(180, 1), Dressed(380, 0)}, Eigen::Vector2d(2, 1));
  EXPECT_LT((shift - Eigen::Vector2d(80, 0)).norm(), 1e-9);
  EXPECT_EQ(VoteShift(tracks, {}, Eigen::Vector2d(2, 1)), Eigen::Vector2d(2, 1));
}

TEST(ShiftVote, ItsOwnVelocityIsNotTheCameras) {
  std::vector<HumanTrack> tracks = {Track(Dressed(100, 1))};
  tracks[0].Predict(Flow(), {0, 0});
  tracks[0].Observe(Dressed(140, 1), {0, 0});  // 10 px a frame of its own
  const Eigen::Vector2d shift = VoteShift(tracks, {Dressed(240, 1)}, Eigen::Vector2d(0, 0));
  EXPECT_LT((shift - Eigen::Vector2d(90, 0)).norm(), 1e-9);
  tracks[0].Miss();
  EXPECT_EQ(VoteShift(tracks, {Dressed(240, 1)}, Eigen::Vector2d(0, 0)), Eigen::Vector2d(0, 0))
      << "who was missed has no vote";
}

TEST(ShiftVote, AnotherShiftMustBeBetterByMuch) {
  const std::vector<HumanTrack> tracks = {Track(Dressed(100, 1))};
  const Eigen::Vector2d still(0, 0);
  // The spread is 24 px; a first guess off by x still has exp(-x^2 / 1152) of the vote.
  const double at_0_7 = 24 * std::sqrt(-2 * std::log(0.7));
  EXPECT_EQ(VoteShift(tracks, {Dressed(100 + at_0_7 - 0.5, 1)}, still), still);
  EXPECT_GT(VoteShift(tracks, {Dressed(100 + at_0_7 + 0.5, 1)}, still).x(), 1);
  // Who looks less alike votes with less: a cost of 1.5 for clothes that are not seen.
  const double weight = std::exp(-0.75);
  const double there = 24 * std::sqrt(-2 * std::log(1 - 0.3 / weight));
  EXPECT_EQ(VoteShift(tracks, {Detection(100 + there - 0.5, 100)}, still), still);
  EXPECT_GT(VoteShift(tracks, {Detection(100 + there + 0.5, 100)}, still).x(), 1);
  // A person has one vote: two detections at one place are not two.
  EXPECT_EQ(
      VoteShift(tracks, {Dressed(100 + at_0_7 - 0.5, 1), Dressed(100 + at_0_7 - 0.5, 1)}, still),
      still);
}

}  // namespace
}  // namespace airdos
