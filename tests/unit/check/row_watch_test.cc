// When images count as unrectified, from which pair on that is known, and how often it is said.
#include "common/check/row_watch.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

constexpr char kMend[] = "do: this";
const cv::Size kSize(320, 192);

const cv::Mat& Texture() {
  static const cv::Mat texture = NoisePicture(kSize.width, kSize.height, 3);
  return texture;
}

/// What the right camera sees of the texture, `rows_px` further down.
cv::Mat Right(double rows_px) {
  constexpr double kDisparity_px = 8;
  return NoisePicture(kSize.width, kSize.height, 3, kDisparity_px, -rows_px);
}

/// All but a patch of it grey, so that there are few matches.
cv::Mat PatchOf(const cv::Mat& image, int width_px) {
  cv::Mat patch(image.size(), CV_8UC1, cv::Scalar(90));
  const cv::Rect where(100, 60, width_px, 50);
  image(where).copyTo(patch(where));
  return patch;
}

/// Shows so many pairs; returns all warnings, a line each with the number of pairs shown by then.
std::string Show(int count, const cv::Mat& left, const cv::Mat& right, RowWatch* watch) {
  std::string said;
  for (int pair = 1; pair <= count; ++pair) {
    if (watch->IsDue()) watch->Add(left, right);
    for (const std::string& warning : watch->TakeWarnings())
      said += std::to_string(pair) + ": " + warning + "\n";
  }
  return said;
}

TEST(RowWatchTest, RectifiedImagesHaveAFigureAndNoWarning) {
  RowWatch watch(kMend);
  EXPECT_EQ(Show(4, Texture(), Right(0), &watch), "");
  EXPECT_FALSE(watch.error_px()) << "two measurements are not enough";
  EXPECT_EQ(Show(296, Texture(), Right(0), &watch), "");
  EXPECT_NEAR(watch.error_px().value(), 0, 0.1);
}

TEST(RowWatchTest, UnrectifiedOnesAreSaidOnceAtTheFifthPairWithTheCommand) {
  RowWatch watch(kMend);
  const std::string said = Show(300, Texture(), Right(4), &watch);
  EXPECT_EQ(said.rfind("5: the images are not rectified: rows of matches differ by ", 0), 0u)
      << said;
  EXPECT_NE(said.find("; do: this\n"), std::string::npos) << said;
  EXPECT_EQ(said.find('\n'), said.size() - 1) << said;
  EXPECT_NEAR(watch.error_px().value(), 4, 0.1);
}

TEST(RowWatchTest, BadlyRectifiedIsAnotherWarningThanUnrectified) {
  RowWatch watch(kMend);
  EXPECT_EQ(Show(10, Texture(), Right(1.3), &watch).rfind("5: the images are badly rectified", 0),
            0u);
  const std::string said = Show(290, Texture(), Right(1.8), &watch);
  EXPECT_EQ(said.rfind("190: the images are not rectified", 0), 0u) << "two of the last three";
  EXPECT_EQ(said.find('\n'), said.size() - 1) << said;
  EXPECT_EQ(Show(300, Texture(), Right(1.3), &watch), "") << "better, but said already";
}

TEST(RowWatchTest, WithFewMatchesItGoesOnUntilTheyAreEnough) {
  const cv::Mat left = PatchOf(Texture(), 30);
  const cv::Mat right = PatchOf(Right(4), 30);
  const std::size_t num_matches = MatchStereo(left, right, 300).left.size();
  ASSERT_TRUE(num_matches >= 5 && num_matches < 20) << num_matches;
  RowWatch watch(kMend);
  const std::string said = Show(200, left, right, &watch);
  EXPECT_NE(said.find(": the images are not rectified"), std::string::npos) << said;
  EXPECT_NEAR(watch.error_px().value(), 4, 0.3);
}

TEST(RowWatchTest, MatchesThatComeLateCountAtOnce) {
  const cv::Mat grey(kSize, CV_8UC1, cv::Scalar(90));
  RowWatch watch(kMend);
  EXPECT_EQ(Show(29, grey, grey, &watch), "");
  const std::string unknown = Show(13, grey, grey, &watch);
  EXPECT_EQ(unknown.rfind("1: hardly anything in the left images is found", 0), 0u) << unknown;
  EXPECT_EQ(unknown.find('\n'), unknown.size() - 1) << "once";
  EXPECT_EQ(Show(28, Texture(), Right(4), &watch).rfind("28: the images are not rectified", 0), 0u)
      << "at the 50th, 60th and 70th pair";
}

TEST(RowWatchTest, ShortInputsTooSayThatItIsNotKnown) {
  const cv::Mat grey(kSize, CV_8UC1, cv::Scalar(90));
  RowWatch known(kMend), unknown(kMend), hardly_any(kMend);
  Show(10, Texture(), Right(0), &known);
  Show(10, grey, grey, &unknown);
  Show(9, grey, grey, &hardly_any);
  for (RowWatch* watch : {&known, &unknown, &hardly_any}) watch->Finish();
  EXPECT_TRUE(known.TakeWarnings().empty());
  EXPECT_EQ(unknown.TakeWarnings().size(), 1u);
  EXPECT_TRUE(hardly_any.TakeWarnings().empty());
}

TEST(RowWatchTest, AMismatchNowAndThenDoesNotAddUp) {
  const cv::Mat left = PatchOf(Texture(), 24);
  const cv::Mat right = PatchOf(Right(4), 24);
  const std::size_t num_matches = MatchStereo(left, right, 300).left.size();
  ASSERT_TRUE(num_matches >= 1 && num_matches < 5) << num_matches;
  RowWatch watch(kMend);
  EXPECT_EQ(Show(400, left, right, &watch).rfind("30: hardly anything", 0), 0u);
  EXPECT_FALSE(watch.error_px());
}

}  // namespace
}  // namespace airdos
