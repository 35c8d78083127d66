#include "common/human/appearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace airdos {
namespace {

/// Shoulders at row 10, hips at row 50, knees at row 82; all between columns 20 and 40.
BodyKeypoints Standing() {
  BodyKeypoints person;
  person[kRightShoulder] = {20, 10, 0.9};
  person[kLeftShoulder] = {40, 10, 0.9};
  person[kRightHip] = {20, 50, 0.9};
  person[kLeftHip] = {40, 50, 0.9};
  person[kRightKnee] = {20, 82, 0.9};
  person[kLeftKnee] = {40, 82, 0.9};
  return person;
}

/// A jacket of (b, g, r) = (40, 80, 120) and trousers of (100, 60, 50).
cv::Mat Clothes(int rows = 100) {
  cv::Mat image(rows, 60, CV_8UC3, cv::Scalar(100, 60, 50));
  image.rowRange(0, 50).setTo(cv::Scalar(40, 80, 120));
  return image;
}

/// A sample at `place`, in bins from 0 to 9, is shared by the two next to it.
void ExpectPlace(const std::array<float, Appearance::kNumBins>& histogram, double place) {
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    const double expected = std::max(0.0, 1 - std::abs(place - static_cast<double>(bin)));
    EXPECT_NEAR(histogram[bin], expected, 1e-4) << bin;
  }
}

void ExpectTrousers(const Appearance& appearance) {
  // Brightness 70; (50 - 60) / 240 in -0.35..0.35; (50 + 60 - 200) / 240 in -0.7..0.7.
  ExpectPlace(appearance.histograms[3], 9 * 70 / 255.0);
  ExpectPlace(appearance.histograms[4], 9 * (-10 / 240.0 + 0.35) / 0.7);
  ExpectPlace(appearance.histograms[5], 9 * (-90 / 240.0 + 0.7) / 1.4);
}

TEST(Appearance, JacketAndTrousers) {
  const auto appearance = MeasureAppearance(Clothes(), Standing(), 0.1);
  ASSERT_TRUE(appearance);
  ExpectPlace(appearance->histograms[0], 9 * 80 / 255.0);
  ExpectPlace(appearance->histograms[1], 9 * (40 / 270.0 + 0.35) / 0.7);
  ExpectPlace(appearance->histograms[2], 9 * (120 / 270.0 + 0.7) / 1.4);
  ExpectTrousers(*appearance);
}

TEST(Appearance, ARegionIsSeenByEightSamples) {
  BodyKeypoints person = Standing();
  for (const int joint : {kLeftShoulder, kLeftKnee}) {
    person[static_cast<std::size_t>(joint)].confidence = 0;
  }
  // The sixteen samples of the right thigh are in rows 51, 53, ..., 81: eight above row 66.
  const auto half = MeasureAppearance(Clothes(66), person, 0.1);
  ASSERT_TRUE(half);
  ExpectTrousers(*half);
  EXPECT_EQ(half->histograms[0], (std::array<float, Appearance::kNumBins>{}));
  EXPECT_FALSE(MeasureAppearance(Clothes(65), person, 0.1));
}

Appearance Share(float share, std::size_t num_histograms) {
  Appearance appearance;
  for (std::size_t h = 0; h < num_histograms; ++h) {
    appearance.histograms[h][2] = share;
    appearance.histograms[h][5] = 1 - share;
  }
  return appearance;
}

TEST(Appearance, TheDistanceIsTheMeanOfWhatBothHave) {
  EXPECT_NEAR(*AppearanceDistance(Share(1, 6), Share(0.25F, 6)), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(*AppearanceDistance(Share(1, 6), Share(0.25F, 3)), std::sqrt(0.5), 1e-6);
  EXPECT_FALSE(AppearanceDistance(Share(1, 6), Appearance()));
}

}  // namespace
}  // namespace airdos
