#include "common/features/landmark_trust.h"

#include <gtest/gtest.h>

#include "common/features/landmark_judge.h"
#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

constexpr double kUnknown = 0.7;
const StereoCamera kCamera = SmallStereoCamera();

TEST(LandmarkTrust, StartsAsToldAndGrowsWithEachAgreement) {
  LandmarkTrust trust(kUnknown);
  EXPECT_DOUBLE_EQ(trust.static_probability(), kUnknown);
  double before = trust.static_probability();
  for (int i = 0; i < 30; ++i) {
    trust.Agree();
    EXPECT_GT(trust.static_probability(), before);
    before = trust.static_probability();
  }
  EXPECT_GT(before, 0.95);
  EXPECT_LT(before, 1.0);
}

TEST(LandmarkTrust, SomebodyWhoStoodForLongIsDoubtedSoonAfterTheFirstSteps) {
  LandmarkTrust trust(kUnknown);
  for (int i = 0; i < 1000; ++i) trust.Agree();
  for (int i = 0; i < 15; ++i) trust.Disagree();
  EXPECT_LT(trust.static_probability(), 0.5);
}

TEST(TrustField, IsTheBaseWhereNothingIsNear) {
  TrustField field(kUnknown);
  field.Add({100, 100}, 5, false);
  EXPECT_DOUBLE_EQ(field.At({200, 100}, 5), kUnknown);
}

TEST(TrustField, DoubtsWhatIsBesideSomethingThatMoved) {
  TrustField field(kUnknown);
  for (int i = 0; i < 4; ++i) field.Add({100.0 + 3 * i, 100}, 5, false);
  EXPECT_LT(field.At({105, 105}, 5), 0.4);
  EXPECT_LT(field.At({105, 105}, 5.5), 0.4);
}

TEST(TrustField, WhatIsBehindOrInFrontIsAnotherThing) {
  TrustField field(kUnknown);
  for (int i = 0; i < 4; ++i) field.Add({100.0 + 3 * i, 100}, 5, false);
  EXPECT_DOUBLE_EQ(field.At({105, 105}, 10), kUnknown);
  EXPECT_DOUBLE_EQ(field.At({105, 105}, 2), kUnknown);
}

TEST(TrustField, NeighboursThatStoodSpeakForIt) {
  TrustField field(0.3);
  for (int i = 0; i < 6; ++i) field.Add({100.0 + 3 * i, 100}, 5, true);
  EXPECT_GT(field.At({108, 103}, 5), 0.7);
}

class LandmarkJudgeTest : public testing::Test {
 protected:
  LandmarkId AddAt(double u_px, double v_px, double depth_m) {
    LocalLandmark landmark;
    landmark.p_W = {(u_px - kCamera.cx_px) / kCamera.fx_px * depth_m,
                    (v_px - kCamera.cy_px) / kCamera.fy_px * depth_m, depth_m};
    landmark.trust = LandmarkTrust(kUnknown);
    landmark.num_seen = landmark.num_expected = 1;
    return map_.Add(landmark);
  }

  LocalMap map_{LocalMapOptions()};
  LandmarkJudge judge_;
};

TEST_F(LandmarkJudgeTest, TrustsWhatWasFoundAndDoubtsWhatWasNot) {
  const LandmarkId found = AddAt(50, 50, 4);
  const LandmarkId lost = AddAt(200, 50, 4);
  const LandmarkId not_tried = AddAt(200, 150, 4);
  judge_.Judge(kCamera, Se3(), {found, lost}, {found}, &map_);
  EXPECT_GT(map_.landmarks().at(found).trust.static_probability(), kUnknown);
  EXPECT_LT(map_.landmarks().at(lost).trust.static_probability(), kUnknown);
  EXPECT_EQ(map_.landmarks().at(not_tried).trust.static_probability(), kUnknown);
  EXPECT_EQ(map_.landmarks().at(lost).num_expected, 2);
  EXPECT_EQ(map_.landmarks().at(not_tried).num_expected, 1);
}

TEST_F(LandmarkJudgeTest, TheFieldKnowsWhereThingsMove) {
  std::vector<LandmarkId> tried;
  std::set<LandmarkId> agreed;
  for (int i = 0; i < 5; ++i) {
    tried.push_back(AddAt(60 + 2 * i, 100, 4));
    agreed.insert(tried.back());
    tried.push_back(AddAt(240 + 2 * i, 100, 4));
  }
  const TrustField field = judge_.Judge(kCamera, Se3(), tried, agreed, &map_);
  EXPECT_GT(field.At({64, 104}, 4), 0.8);
  EXPECT_LT(field.At({244, 104}, 4), 0.3);
}

TEST_F(LandmarkJudgeTest, WhereNewLandmarksUsuallyVanishNewOnesAreDoubtedEverywhere) {
  const double before = judge_.Unknown().At({10, 10}, 3);
  std::vector<LandmarkId> tried;
  for (int i = 0; i < 300; ++i) tried.push_back(AddAt(160, 100, 4));
  judge_.Judge(kCamera, Se3(), tried, {}, &map_);
  EXPECT_LT(judge_.Unknown().At({10, 10}, 3), 0.5 * before);
  // The second time says nothing of new landmarks.
  const double after = judge_.Unknown().At({10, 10}, 3);
  judge_.Judge(kCamera, Se3(), tried, {}, &map_);
  EXPECT_EQ(judge_.Unknown().At({10, 10}, 3), after);
}

TEST_F(LandmarkJudgeTest, WhereAllIsInDoubtTheLeastDoubtfulCountInFull) {
  EXPECT_DOUBLE_EQ(judge_.RelativeTrust(LandmarkTrust(0.35)), 0.5);
  EXPECT_DOUBLE_EQ(judge_.RelativeTrust(LandmarkTrust(1.0)), 1.0);
  std::vector<LandmarkId> tried;
  for (int i = 0; i < 20; ++i) tried.push_back(AddAt(100 + i, 100, 4));
  for (int k = 0; k < 5; ++k) judge_.Judge(kCamera, Se3(), tried, {}, &map_);
  const LandmarkTrust& lost = map_.landmarks().at(tried.front()).trust;
  EXPECT_LT(lost.static_probability(), 0.25);
  EXPECT_DOUBLE_EQ(judge_.RelativeTrust(lost), 1.0);
}

TEST_F(LandmarkJudgeTest, LandmarksBehindTheCameraDoNoHarm) {
  const LandmarkId id = AddAt(160, 100, -2);
  const TrustField field = judge_.Judge(kCamera, Se3(), {id}, {}, &map_);
  EXPECT_GT(field.At({160, 100}, 2), 0.6);
}

}  // namespace
}  // namespace airdos
