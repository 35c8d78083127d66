#include "common/features/feature_extractor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <tuple>

#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 192;

cv::Mat Texture() { return NoisePicture(kWidth_px, kHeight_px, 5); }

struct Extracted {
  std::vector<Feature> features;
  int num_masked = -1;
};

Extracted Extract(const FeatureExtractorOptions& options, const cv::Mat& image,
                  const cv::Mat& mask = cv::Mat()) {
  Extracted extracted;
  extracted.features = FeatureExtractor(options).Extract(ImagePyramid(image, options.num_levels),
                                                         mask, &extracted.num_masked);
  return extracted;
}

TEST(FeatureExtractor, FeaturesSpreadOverTheCellsOfEachLevel) {
  FeatureExtractorOptions options;
  options.max_features_per_cell = 2;
  const ImagePyramid pyramid(Texture(), options.num_levels);
  const Extracted extracted = Extract(options, Texture());
  std::map<std::tuple<int, int, int>, int> count_of_cell;
  for (const Feature& feature : extracted.features) {
    const int u = static_cast<int>(std::lround(pyramid.ToLevel(feature.uv_px.x(), feature.level)));
    const int v = static_cast<int>(std::lround(pyramid.ToLevel(feature.uv_px.y(), feature.level)));
    ++count_of_cell[{feature.level, v / options.cell_size_px, u / options.cell_size_px}];
  }
  int num_full = 0;
  for (const auto& [cell, count] : count_of_cell) {
    EXPECT_LE(count, 2);
    num_full += count == 2 ? 1 : 0;
  }
  EXPECT_GT(num_full, 50);  // the texture is everywhere: most of the 60 + 48 + ... cells are full
  EXPECT_EQ(extracted.num_masked, 0);
}

TEST(FeatureExtractor, TheStrongestOfACellAreKept) {
  FeatureExtractorOptions few;
  few.max_features_per_cell = 1;
  FeatureExtractorOptions many;
  many.max_features_per_cell = 1000;
  float strongest = 0;
  for (const Feature& feature : Extract(many, Texture()).features)
    strongest = std::max(strongest, feature.response);
  float strongest_of_few = 0;
  for (const Feature& feature : Extract(few, Texture()).features)
    strongest_of_few = std::max(strongest_of_few, feature.response);
  EXPECT_EQ(strongest_of_few, strongest);
  EXPECT_LT(Extract(few, Texture()).features.size(), Extract(many, Texture()).features.size());
}

TEST(FeatureExtractor, TwiceTheSameBytes) {
  const Extracted a = Extract({}, Texture());
  const Extracted b = Extract({}, Texture());
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    EXPECT_EQ(a.features[i].uv_px, b.features[i].uv_px);
    EXPECT_EQ(a.features[i].level, b.features[i].level);
    EXPECT_EQ(a.features[i].response, b.features[i].response);
    EXPECT_EQ(a.features[i].descriptor, b.features[i].descriptor);
  }
}

TEST(FeatureExtractor, OrderedByLevelAndFoundAtEachLevel) {
  std::set<int> levels;
  int last = 0;
  for (const Feature& feature : Extract({}, Texture()).features) {
    EXPECT_GE(feature.level, last);
    last = feature.level;
    levels.insert(feature.level);
  }
  // 192 / 1.2^6 = 64: seven levels are there.
  EXPECT_EQ(levels, (std::set<int>{0, 1, 2, 3, 4, 5, 6}));
}

TEST(FeatureExtractor, NoFeatureOnTheMaskAndEachOneCounted) {
  FeatureExtractorOptions options;
  options.max_features_per_cell = 100000;  // then what is masked is what is missing
  cv::Mat mask = cv::Mat::zeros(kHeight_px, kWidth_px, CV_8UC1);
  mask(cv::Rect(90, 0, 140, kHeight_px)) = 1;  // any value but 0 counts
  const Extracted all = Extract(options, Texture());
  const Extracted masked = Extract(options, Texture(), mask);
  for (const Feature& feature : masked.features) {
    const bool is_outside = feature.uv_px.x() < 90 || feature.uv_px.x() > 229;
    EXPECT_TRUE(is_outside) << feature.uv_px.transpose();
  }
  EXPECT_GT(masked.num_masked, 50);
  EXPECT_EQ(masked.features.size() + static_cast<std::size_t>(masked.num_masked),
            all.features.size());
}

TEST(FeatureExtractor, NothingWhereEverythingIsMasked) {
  const cv::Mat mask(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(255));
  const Extracted extracted = Extract({}, Texture(), mask);
  EXPECT_TRUE(extracted.features.empty());
  EXPECT_GT(extracted.num_masked, 100);
}

TEST(FeatureExtractor, NothingInAFlatImage) {
  const Extracted extracted = Extract({}, cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(90)));
  EXPECT_TRUE(extracted.features.empty());
  EXPECT_EQ(extracted.num_masked, 0);
}

TEST(FeatureExtractor, AnImageSmallerThanTheBordersHasNoFeatures) {
  EXPECT_TRUE(Extract({}, NoisePicture(38, 38, 5)).features.empty());
}

TEST(FeatureExtractor, DescriptorsOfAShiftedImageAreClose) {
  constexpr int kShift_px = 8;
  FeatureExtractorOptions options;
  options.num_levels = 1;  // at other levels the grid of pixels shifts by a fraction
  options.max_features_per_cell = 100000;
  const Extracted a = Extract(options, Texture());
  const Extracted b = Extract(options, NoisePicture(kWidth_px, kHeight_px, 5, kShift_px));
  int num_same_place = 0;
  for (const Feature& feature : a.features) {
    for (const Feature& other : b.features) {
      if (other.uv_px != feature.uv_px - Eigen::Vector2d(kShift_px, 0)) continue;
      ++num_same_place;
      EXPECT_EQ(HammingDistance(feature.descriptor, other.descriptor), 0);
    }
  }
  EXPECT_GT(num_same_place, 30);
}

TEST(FeatureExtractor, DescriptorsAreThoseOfTheLevelItself) {
  constexpr int kLevel = 4;
  FeatureExtractorOptions options;
  options.max_features_per_cell = 100000;
  const ImagePyramid pyramid(Texture(), options.num_levels);
  const Extracted all = Extract(options, Texture());
  options.num_levels = 1;
  const Extracted alone = Extract(options, pyramid.level(kLevel));
  std::size_t next = 0;
  for (const Feature& feature : all.features) {
    if (feature.level != kLevel) continue;
    ASSERT_LT(next, alone.features.size());
    const Feature& same = alone.features[next++];
    EXPECT_NEAR(pyramid.FromLevel(same.uv_px.x(), kLevel), feature.uv_px.x(), 1e-3);
    EXPECT_EQ(HammingDistance(same.descriptor, feature.descriptor), 0);
  }
  EXPECT_EQ(next, alone.features.size());
  EXPECT_GT(next, 10u);
}

TEST(HammingDistance, CountsBits) {
  EXPECT_EQ(HammingDistance({0, 0, 0, 0}, {0, 0, 0, 0}), 0);
  EXPECT_EQ(HammingDistance({1, 0, 0xff, 0}, {0, 2, 0x0f, 0}), 6);
  EXPECT_EQ(HammingDistance({0, 0, 0, 0}, {~0ull, ~0ull, ~0ull, ~0ull}), 256);
}

}  // namespace
}  // namespace airdos
