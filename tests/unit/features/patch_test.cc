#include "common/features/patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

constexpr int kWidth_px = 120;
constexpr int kHeight_px = 90;
constexpr double kGrain_px = 8;

/// The same world moved: what was at p is at p + shift.
cv::Mat Shifted(const Eigen::Vector2d& shift_px) {
  return NoisePicture(kWidth_px, kHeight_px, 3, -shift_px.x(), -shift_px.y(), kGrain_px);
}

std::vector<Eigen::Vector2d> Places() {
  std::vector<Eigen::Vector2d> places;
  for (double v = 20; v < 70; v += 10) {
    for (double u = 20; u < 100; u += 10) places.emplace_back(u + 0.3, v + 0.6);
  }
  return places;
}

double MedianError_px(const cv::Mat& from, const cv::Mat& to, const Eigen::Vector2d& shift_px) {
  std::vector<double> errors;
  for (const Eigen::Vector2d& place : Places()) {
    const auto patch = Patch::Sample(from, place, 1.0);
    EXPECT_TRUE(patch);
    const auto alignment = patch->Align(to, place, 3.0, false);
    EXPECT_TRUE(alignment) << place.transpose();
    if (!alignment) continue;
    EXPECT_GT(alignment->correlation, 0.99);
    errors.push_back((alignment->centre_px - place - shift_px).norm());
  }
  std::sort(errors.begin(), errors.end());
  return errors[errors.size() / 2];
}

TEST(Patch, RecoversSubPixelShifts) {
  // 0.02 px: the iteration ends below 0.01 px, the rest is bilinear interpolation of the curved
  // texture and rounding to grey levels.
  for (const Eigen::Vector2d& shift_px :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.37, -0.21), Eigen::Vector2d(-0.5, 0.5),
        Eigen::Vector2d(1.42, 0.83), Eigen::Vector2d(-0.9, -1.25)}) {
    EXPECT_LT(MedianError_px(Shifted({0, 0}), Shifted(shift_px), shift_px), 0.02)
        << shift_px.transpose();
  }
}

TEST(Patch, BrightnessOffsetChangesNothing) {
  const Eigen::Vector2d shift_px(0.6, -0.4);
  const cv::Mat brighter = Shifted(shift_px) + cv::Scalar(25);  // 20..220 become 45..245
  for (const Eigen::Vector2d& place : Places()) {
    const auto patch = Patch::Sample(Shifted({0, 0}), place, 1.0);
    ASSERT_TRUE(patch);
    const auto plain = patch->Align(Shifted(shift_px), place, 3.0, false);
    const auto offset = patch->Align(brighter, place, 3.0, false);
    ASSERT_TRUE(plain && offset);
    EXPECT_LT((plain->centre_px - offset->centre_px).norm(), 1e-3);
    EXPECT_NEAR(plain->correlation, offset->correlation, 1e-5);
  }
}

TEST(Patch, AlongTheRowTheRowStays) {
  const Eigen::Vector2d shift_px(1.3, 0);
  std::vector<double> errors;
  for (const Eigen::Vector2d& place : Places()) {
    const auto patch = Patch::Sample(Shifted({0, 0}), place, 1.0);
    ASSERT_TRUE(patch);
    const auto alignment = patch->Align(Shifted(shift_px), place, 3.0, true);
    ASSERT_TRUE(alignment);
    EXPECT_EQ(alignment->centre_px.y(), place.y());
    errors.push_back(std::abs(alignment->centre_px.x() - place.x() - shift_px.x()));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.02);
}

TEST(Patch, StepScalesThePatch) {
  // The same texture, twice as fine: two samples' distance there is one pixel here.
  const cv::Mat coarse = NoisePicture(200, 200, 3, 0, 0, 16);
  const cv::Mat fine = NoisePicture(100, 100, 3, 0, 0, 8);
  const auto patch = Patch::Sample(coarse, {80, 90}, 2.0);
  ASSERT_TRUE(patch);
  const auto alignment = patch->Align(fine, {40.8, 44.5}, 3.0, false);
  ASSERT_TRUE(alignment);
  EXPECT_LT((alignment->centre_px - Eigen::Vector2d(40, 45)).norm(), 0.05);
  EXPECT_GT(alignment->correlation, 0.99);
}

TEST(Patch, AFlatPatchHasNoPosition) {
  const cv::Mat flat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(100));
  EXPECT_FALSE(Patch::Sample(flat, {50, 50}, 1.0));
}

TEST(Patch, AFlatImageHoldsNoPatch) {
  const cv::Mat flat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(100));
  const auto patch = Patch::Sample(Shifted({0, 0}), {50, 50}, 1.0);
  ASSERT_TRUE(patch);
  EXPECT_FALSE(patch->Align(flat, {50, 50}, 3.0, false));
}

TEST(Patch, AnEdgeHoldsThePatchOnlyAcrossIt) {
  // Grey depends on the column alone: the row cannot be known, the column can.
  cv::Mat stripes(kHeight_px, kWidth_px, CV_8UC1);
  for (int u = 0; u < kWidth_px; ++u)
    stripes.col(u) = cv::Scalar(std::round(120 + 90 * std::sin(u / 4.0)));
  const auto patch = Patch::Sample(stripes, {50, 50}, 1.0);
  ASSERT_TRUE(patch);
  EXPECT_FALSE(patch->Align(stripes, {50.5, 50}, 3.0, false));
  const auto along_row = patch->Align(stripes, {50.5, 50}, 3.0, true);
  ASSERT_TRUE(along_row);
  EXPECT_NEAR(along_row->centre_px.x(), 50, 0.02);
}

TEST(Patch, NothingAtTheBorderOfTheImage) {
  const cv::Mat image = Shifted({0, 0});
  constexpr double kReach = Patch::kRadius + 1;
  EXPECT_TRUE(Patch::Sample(image, {kReach, kReach}, 1.0));
  EXPECT_FALSE(Patch::Sample(image, {kReach - 0.01, 50}, 1.0));
  EXPECT_FALSE(Patch::Sample(image, {50, kReach - 0.01}, 1.0));
  EXPECT_FALSE(Patch::Sample(image, {kWidth_px - kReach, 50}, 1.0));
  EXPECT_FALSE(Patch::Sample(image, {50, kHeight_px - kReach}, 1.0));
  EXPECT_FALSE(Patch::Sample(image, {2 * kReach - 0.1, 50}, 2.0));
  EXPECT_FALSE(Patch::Sample(image, {std::nan(""), 50}, 1.0));
  const auto patch = Patch::Sample(image, {50, 50}, 1.0);
  ASSERT_TRUE(patch);
  EXPECT_FALSE(patch->Align(image, {3, 50}, 3.0, false));
  EXPECT_FALSE(patch->Align(image, {50, kHeight_px + 5.0}, 3.0, false));
  EXPECT_FALSE(patch->Align(image, {std::nan(""), 50}, 3.0, false));
}

TEST(Patch, MovesNoFartherThanAllowed) {
  const Eigen::Vector2d place(50.3, 40.6);
  const auto patch = Patch::Sample(Shifted({0, 0}), place, 1.0);
  ASSERT_TRUE(patch);
  const cv::Mat moved = Shifted({1.5, 0});
  EXPECT_TRUE(patch->Align(moved, place, 2.5, false));  // the way there may overshoot a little
  EXPECT_FALSE(patch->Align(moved, place, 1.4, false));
}

}  // namespace
}  // namespace airdos
