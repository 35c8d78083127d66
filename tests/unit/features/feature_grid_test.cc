#include "common/features/feature_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace airdos {
namespace {

constexpr int kWidth_px = 301;
constexpr int kHeight_px = 157;

std::vector<Feature> RandomFeatures(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, kWidth_px - 1);
  std::uniform_real_distribution<double> v(0, kHeight_px - 1);
  std::vector<Feature> features(static_cast<std::size_t>(count));
  for (Feature& feature : features) feature.uv_px = {u(random), v(random)};
  return features;
}

std::vector<int> Near(const FeatureGrid& grid, const Eigen::Vector2d& uv_px, double radius_px,
                      const FeatureGrid::Levels& levels = {0, 7}) {
  std::vector<int> indices;
  grid.ForEachNear(uv_px, radius_px, levels, [&](int index) { indices.push_back(index); });
  return indices;
}

TEST(FeatureGrid, FindsWhatBruteForceFinds) {
  const std::vector<Feature> features = RandomFeatures(500, 1);
  const FeatureGrid grid(features, kWidth_px, kHeight_px);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-60, 360);  // beyond the image as well
  for (int query = 0; query < 300; ++query) {
    const Eigen::Vector2d uv_px{place(random), place(random)};
    for (const double radius_px : {0.0, 3.0, 16.0, 75.5, 1000.0}) {
      std::vector<int> expected;
      for (std::size_t i = 0; i < features.size(); ++i) {
        if ((features[i].uv_px - uv_px).cwiseAbs().maxCoeff() <= radius_px)
          expected.push_back(static_cast<int>(i));
      }
      std::vector<int> found = Near(grid, uv_px, radius_px);
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected);  // each once
    }
  }
}

TEST(FeatureGrid, AFeatureOnTheBorderOfTheSquareIsIn) {
  std::vector<Feature> features(2);
  features[0].uv_px = {20, 30};
  features[1].uv_px = {20, 30.5};
  const FeatureGrid grid(features, kWidth_px, kHeight_px);
  EXPECT_EQ(Near(grid, {16, 26}, 4), std::vector<int>{0});
}

TEST(FeatureGrid, FeaturesBeyondTheImageAreFound) {
  std::vector<Feature> features(2);
  features[0].uv_px = {-5, -7};
  features[1].uv_px = {kWidth_px + 40, kHeight_px + 40};
  const FeatureGrid grid(features, kWidth_px, kHeight_px);
  EXPECT_EQ(Near(grid, {-4, -6}, 2), std::vector<int>{0});
  EXPECT_EQ(Near(grid, {kWidth_px + 39, kHeight_px + 41}, 2), std::vector<int>{1});
}

TEST(FeatureGrid, FindsOnlyWhatIsOfTheLevels) {
  std::vector<Feature> features(4);
  for (int level = 0; level < 4; ++level) features[static_cast<std::size_t>(level)].level = level;
  const FeatureGrid grid(features, kWidth_px, kHeight_px);
  EXPECT_EQ(Near(grid, {0, 0}, 1, {1, 2}), (std::vector<int>{1, 2}));
  EXPECT_EQ(Near(grid, {0, 0}, 1, {-1, 0}), std::vector<int>{0});
}

TEST(FeatureGrid, NothingInAnEmptyGrid) {
  const std::vector<Feature> features;
  EXPECT_TRUE(Near(FeatureGrid(features, kWidth_px, kHeight_px), {10, 10}, 1000).empty());
}

}  // namespace
}  // namespace airdos
