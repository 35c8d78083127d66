#include <gtest/gtest.h>

#include <cstddef>
#include <limits>

#include "common/human/layouts.h"

namespace airdos {
namespace {

// Keypoint i at (10 i, 100 + i), confidence 0.5 + i / 100.
std::vector<BodyKeypoint> Numbered(int count) {
  std::vector<BodyKeypoint> detection;
  for (int i = 0; i < count; ++i) detection.push_back({10.0 * i, 100.0 + i, 0.5 + i / 100.0});
  return detection;
}

TEST(Layouts, Coco18KeepsItsOrder) {
  const auto person = MapToBody(KeypointLayout::kCoco18, Numbered(18));
  ASSERT_TRUE(person);
  for (std::size_t joint = 0; joint < person->size(); ++joint) {
    EXPECT_EQ((*person)[joint].u_px, 10.0 * static_cast<double>(joint));
  }
}

TEST(Layouts, Coco17MakesTheNeckFromTheShoulders) {
  const auto person = MapToBody(KeypointLayout::kCoco17, Numbered(17));
  ASSERT_TRUE(person);
  EXPECT_EQ((*person)[kLeftShoulder].u_px, 50);
  EXPECT_EQ((*person)[kRightShoulder].u_px, 60);
  EXPECT_EQ((*person)[kNeck].u_px, 55);
  EXPECT_EQ((*person)[kNeck].v_px, 105.5);
  EXPECT_EQ((*person)[kNeck].confidence, 0.55);
  EXPECT_EQ((*person)[kRightAnkle].u_px, 160);
  std::vector<BodyKeypoint> one_shoulder = Numbered(17);
  one_shoulder[5].confidence = 0;
  EXPECT_EQ((*MapToBody(KeypointLayout::kCoco17, one_shoulder))[kNeck].confidence, 0);
}

TEST(Layouts, Halpe26HasItsOwnNeck) {
  const auto person = MapToBody(KeypointLayout::kHalpe26, Numbered(26));
  ASSERT_TRUE(person);
  EXPECT_EQ((*person)[kNeck].u_px, 180);
  EXPECT_EQ((*person)[kLeftHip].u_px, 110);
  EXPECT_EQ((*person)[kRightWrist].u_px, 100);
}

TEST(Layouts, WhatIsNotANumberIsNotSeen) {
  std::vector<BodyKeypoint> detection = Numbered(18);
  detection[0].u_px = std::numeric_limits<double>::quiet_NaN();
  detection[1].confidence = std::numeric_limits<double>::quiet_NaN();
  detection[2].confidence = -1;
  detection[3].confidence = 7;
  const auto person = MapToBody(KeypointLayout::kCoco18, detection);
  ASSERT_TRUE(person);
  for (const int joint : {0, 1, 2}) {
    EXPECT_EQ((*person)[static_cast<std::size_t>(joint)].confidence, 0);
    EXPECT_EQ((*person)[static_cast<std::size_t>(joint)].u_px, 0);
  }
  EXPECT_EQ((*person)[3].confidence, 1);
}

TEST(Layouts, WrongCountGivesNothing) {
  EXPECT_FALSE(MapToBody(KeypointLayout::kCoco18, Numbered(17)));
  EXPECT_FALSE(MapToBody(KeypointLayout::kCoco17, {}));
}

TEST(SideSwaps, AreTheirOwnInverse) {
  const BodyKeypoints person = *MapToBody(KeypointLayout::kCoco18, Numbered(18));
  for (const SideSwap swap : kSideSwaps) {
    const BodyKeypoints back = SwapSides(SwapSides(person, swap), swap);
    for (std::size_t joint = 0; joint < person.size(); ++joint) {
      EXPECT_EQ(back[joint].u_px, person[joint].u_px);
    }
  }
  EXPECT_EQ(SwapSides(person, SideSwap::kAll)[kLeftHip].u_px, person[kRightHip].u_px);
  EXPECT_EQ(SwapSides(person, SideSwap::kLowerLegs)[kLeftHip].u_px, person[kLeftHip].u_px);
  EXPECT_EQ(SwapSides(person, SideSwap::kLowerLegs)[kLeftKnee].u_px, person[kRightKnee].u_px);
  EXPECT_EQ(SwapSides(person, SideSwap::kLowerArms)[kRightWrist].u_px, person[kLeftWrist].u_px);
}

TEST(KeypointNoise, GrowsWithHeightAndDoubt) {
  const KeypointNoise noise;
  EXPECT_DOUBLE_EQ(noise.Sigma(0.9, 50), 0.9);
  EXPECT_DOUBLE_EQ(noise.Sigma(0.85, 200), 1.8);
  EXPECT_NEAR(noise.Sigma(0.6, 50), 0.9 * 1.9, 1e-12);
  EXPECT_NEAR(noise.Sigma(0.0, 50), 0.9 * 4, 1e-12);
}

}  // namespace
}  // namespace airdos
