#include "common/features/feature_stereo_matcher.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/features/feature_extractor.h"
#include "common/util/quantile.h"
#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

constexpr int kNumLevels = 8;

/// A rectified pair with its features and its matcher.
struct Rig {
  ImagePyramid left;
  ImagePyramid right;
  std::vector<Feature> left_features;
  std::vector<Feature> right_features;
  FeatureStereoMatcher matcher;

  Rig(const cv::Mat& left_image, const cv::Mat& right_image,
      const FeatureStereoMatcherOptions& options)
      : left(left_image, kNumLevels),
        right(right_image, kNumLevels),
        left_features(Features(left)),
        right_features(Features(right)),
        matcher(options, SmallStereoCamera(), left, right, right_features) {}

  static std::vector<Feature> Features(const ImagePyramid& pyramid) {
    int num_masked = 0;
    return FeatureExtractor({}).Extract(pyramid, cv::Mat(), &num_masked);
  }

  /// u_left - u_right of all features that match.
  std::vector<double> Disparities_px() const {
    std::vector<double> disparities_px;
    for (const Feature& feature : left_features) {
      const std::optional<double> u_right_px = matcher.Match(feature);
      if (u_right_px) disparities_px.push_back(feature.uv_px.x() - *u_right_px);
    }
    return disparities_px;
  }
};

cv::Mat Left() { return NoisePicture(320, 192, 9); }
/// What is at u in the left image is at u - disparity in the right one.
cv::Mat Right(double disparity_px, double row_offset_px = 0) {
  return NoisePicture(320, 192, 9, disparity_px, row_offset_px);
}

TEST(FeatureStereoMatcher, FindsTheDisparityToAFractionOfAPixel) {
  for (const double disparity_px : {1.4, 7.3, 26.55}) {
    const Rig rig(Left(), Right(disparity_px), {});
    const std::vector<double> disparities_px = rig.Disparities_px();
    std::vector<double> errors_px;
    int num_wrong = 0;
    for (const double found_px : disparities_px) {
      errors_px.push_back(std::abs(found_px - disparity_px));
      num_wrong += errors_px.back() > 1 ? 1 : 0;
    }
    EXPECT_GT(disparities_px.size(), rig.left_features.size() / 2);
    EXPECT_LT(Quantile(errors_px, 0.5), 0.1);
    EXPECT_LT(num_wrong, static_cast<int>(disparities_px.size()) / 50);
  }
}

TEST(FeatureStereoMatcher, FindsTheDepthsOfARenderedScene) {
  const RenderedScene scene(4);
  const StereoCamera camera = SmallStereoCamera();
  const StereoPair pair = scene.Render(camera, Se3());
  const Rig rig(pair.left, pair.right, {});
  std::vector<double> errors_px;
  for (const Feature& feature : rig.left_features) {
    const std::optional<double> u_right_px = rig.matcher.Match(feature);
    if (!u_right_px) continue;
    const double depth_m = scene.Depth_m(camera, Se3(), feature.uv_px);
    errors_px.push_back(
        std::abs(feature.uv_px.x() - *u_right_px - camera.fx_px * camera.baseline_m / depth_m));
  }
  EXPECT_GT(errors_px.size(), 150u);
  EXPECT_LT(Quantile(errors_px, 0.5), 0.1);
}

TEST(FeatureStereoMatcher, NothingNearerThanTheMinimalDepth) {
  // fx * baseline = 52.5 px m: a disparity of 7.3 px is 7.2 m away.
  FeatureStereoMatcherOptions options;
  options.min_depth_m = 7.0;
  EXPECT_GT(Rig(Left(), Right(7.3), options).Disparities_px().size(), 100u);
  options.min_depth_m = 7.4;
  for (const double disparity_px : Rig(Left(), Right(7.3), options).Disparities_px())
    EXPECT_LE(disparity_px, 52.5 / 7.4);
  options.min_depth_m = 9;
  EXPECT_LT(Rig(Left(), Right(7.3), options).Disparities_px().size(), 10u);  // mistakes
}

TEST(FeatureStereoMatcher, NothingBelowTheMinimalDisparity) {
  FeatureStereoMatcherOptions options;
  options.min_disparity_px = 0.7;
  for (const double disparity_px : Rig(Left(), Right(0.4), options).Disparities_px())
    EXPECT_GE(disparity_px, 0.7);
  EXPECT_LT(Rig(Left(), Right(0.4), options).Disparities_px().size(), 15u);
  EXPECT_TRUE(Rig(Left(), Right(-5), options).Disparities_px().size() < 15u);
}

TEST(FeatureStereoMatcher, NothingInAnotherRow) {
  EXPECT_LT(Rig(Left(), Right(7.3, 12), {}).Disparities_px().size(), 15u);
}

TEST(FeatureStereoMatcher, NothingInAnotherPicture) {
  const cv::Mat other = NoisePicture(320, 192, 10);
  EXPECT_LT(Rig(Left(), other, {}).Disparities_px().size(), 15u);
  const cv::Mat black = cv::Mat::zeros(192, 320, CV_8UC1);
  EXPECT_TRUE(Rig(Left(), black, {}).Disparities_px().empty());
}

TEST(FeatureStereoMatcher, RefinesAGuessAtEachLevel) {
  constexpr double kDisparity_px = 11.8;
  const Rig rig(Left(), Right(kDisparity_px), {});
  for (int level = 0; level < 4; ++level) {
    std::vector<double> errors_px;
    for (const Feature& feature : rig.left_features) {
      const auto u_right_px =
          rig.matcher.Refine(feature.uv_px, level, feature.uv_px.x() - kDisparity_px + 0.8, 2.5);
      if (u_right_px)
        errors_px.push_back(std::abs(feature.uv_px.x() - *u_right_px - kDisparity_px));
    }
    ASSERT_GT(errors_px.size(), 100u);
    EXPECT_LT(Quantile(errors_px, 0.5), 0.1) << "level " << level;
  }
}

}  // namespace
}  // namespace airdos
