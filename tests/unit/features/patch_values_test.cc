// Patches between pictures of the same noise, to a hundredth of a pixel.
#include <gtest/gtest.h>

#include "common/features/patch.h"
#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr std::uint32_t kSeed = 17;

// With steps of one pixel whole rows are sampled at once, with others one by one: at a step that is
// one but for rounding both must give the same.
TEST(PatchValues, BothWaysOfSamplingAreTheSame) {
  const cv::Mat from = NoisePicture(kWidth, kHeight, kSeed);
  const cv::Mat to = NoisePicture(kWidth, kHeight, kSeed, 0.25, -0.375);
  for (const Eigen::Vector2d& centre :
       {Eigen::Vector2d(60.2, 50.7), {80.85, 70.1}, {40.5, 33.25}, {100, 60}}) {
    const auto whole = Patch::Sample(from, centre, 1);
    const auto single = Patch::Sample(from, centre, 1 + 1e-12);
    ASSERT_TRUE(whole && single);
    const auto a = whole->Align(to, centre, 4, false);
    const auto b = single->Align(to, centre, 4, false);
    ASSERT_TRUE(a && b);
    EXPECT_LT((a->centre_px - b->centre_px).norm(), 1e-3);
    EXPECT_NEAR(a->correlation, b->correlation, 1e-5);
  }
}

// A picture with a grain of 10 px against one of 8 px: 1.25 px of the first to one of the second.
TEST(PatchValues, AStepIsThatOfBothAxes) {
  const cv::Mat from = NoisePicture(kWidth, kHeight, kSeed, 0, 0, 10);
  const cv::Mat to = NoisePicture(kWidth, kHeight, kSeed, 3, -2, 8);
  const Eigen::Vector2d centre(70.3, 60.6);
  const Eigen::Vector2d expected(0.8 * centre.x() - 3, 0.8 * centre.y() + 2);
  const auto patch = Patch::Sample(from, centre, 1.25);
  ASSERT_TRUE(patch);
  const auto alignment = patch->Align(to, expected + Eigen::Vector2d(0.6, -0.5), 4, false);
  ASSERT_TRUE(alignment);
  EXPECT_LT((alignment->centre_px - expected).norm(), 0.03);
  EXPECT_GT(alignment->correlation, 0.999);
}

TEST(PatchValues, AlongARowOnlyTheColumnMoves) {
  const cv::Mat from = NoisePicture(kWidth, kHeight, kSeed);
  const cv::Mat to = NoisePicture(kWidth, kHeight, kSeed, 1.375, 0);
  const Eigen::Vector2d centre(80.25, 60.5);
  const auto patch = Patch::Sample(from, centre, 1);
  const auto alignment = patch->Align(to, centre, 4, true);
  ASSERT_TRUE(alignment);
  EXPECT_NEAR(alignment->centre_px.x(), centre.x() - 1.375, 0.02);
  EXPECT_EQ(alignment->centre_px.y(), centre.y());
  EXPECT_GT(alignment->correlation, 0.999);
  EXPECT_FALSE(patch->Align(to, centre, 1, true)) << "further than it may";
}

// One more sample all around must be inside: 6 steps, and the last column cannot be interpolated.
TEST(PatchValues, TheBorderIsAsWideAsItsSamples) {
  const cv::Mat image = NoisePicture(kWidth, kHeight, kSeed);
  for (const double step : {1.0, 1.25}) {
    const double reach = 6 * step;
    EXPECT_TRUE(Patch::Sample(image, {reach, 60}, step));
    EXPECT_FALSE(Patch::Sample(image, {reach - 0.01, 60}, step));
    EXPECT_TRUE(Patch::Sample(image, {80, reach}, step));
    EXPECT_FALSE(Patch::Sample(image, {80, reach - 0.01}, step));
    EXPECT_TRUE(Patch::Sample(image, {kWidth - 1.01 - reach, 60}, step));
    EXPECT_FALSE(Patch::Sample(image, {kWidth - 1 - reach, 60}, step));
    EXPECT_TRUE(Patch::Sample(image, {80, kHeight - 1.01 - reach}, step));
    EXPECT_FALSE(Patch::Sample(image, {80, kHeight - 1 - reach}, step));
  }
}

// 20 grey levels over the whole square: a flat picture has no place, a faint one has.
TEST(PatchValues, AFlatPatchIsNone) {
  EXPECT_FALSE(Patch::Sample(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(90)), {80, 60}, 1));
  cv::Mat faint(kHeight, kWidth, CV_8UC1, cv::Scalar(90));
  faint.at<std::uint8_t>(60, 80) = 108;  // 18 levels above, less their mean: 17.9
  EXPECT_FALSE(Patch::Sample(faint, {80, 60}, 1));
  faint.at<std::uint8_t>(60, 80) = 112;
  EXPECT_TRUE(Patch::Sample(faint, {80, 60}, 1));
}

TEST(PatchValues, BrightnessDoesNotMatterAndContrastNotToTheCorrelation) {
  const cv::Mat from = NoisePicture(kWidth, kHeight, kSeed);
  const Eigen::Vector2d centre(80.5, 60.25);
  const auto patch = Patch::Sample(from, centre, 1);
  cv::Mat brighter, flatter;
  from.convertTo(brighter, CV_8U, 1, 20);
  from.convertTo(flatter, CV_8U, 0.75, 30);
  const auto same = patch->Align(brighter, centre, 4, false);
  ASSERT_TRUE(same);
  EXPECT_LT((same->centre_px - centre).norm(), 1e-3);
  EXPECT_NEAR(same->correlation, 1, 1e-5);
  const auto other = patch->Align(flatter, centre, 4, false);
  ASSERT_TRUE(other);
  EXPECT_GT(other->correlation, 0.995);
  EXPECT_LE(other->correlation, 1 + 1e-6);
}

}  // namespace
}  // namespace airdos
