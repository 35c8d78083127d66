#include "common/features/image_pyramid.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

namespace airdos {
namespace {

/// A wide Gaussian blob at a fraction of a pixel: resampling keeps its centroid.
cv::Mat Blob(int width, int height, const Eigen::Vector2d& centre_px) {
  constexpr double kSigma_px = 6;
  cv::Mat image(height, width, CV_8UC1);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double squared = (Eigen::Vector2d(u, v) - centre_px).squaredNorm();
      image.at<uchar>(v, u) =
          static_cast<uchar>(std::lround(250 * std::exp(-0.5 * squared / kSigma_px / kSigma_px)));
    }
  }
  return image;
}

Eigen::Vector2d Centroid(const cv::Mat& image) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      sum += image.at<uchar>(v, u) * Eigen::Vector2d(u, v);
      weight += image.at<uchar>(v, u);
    }
  }
  return sum / weight;
}

TEST(ImagePyramid, LevelZeroIsTheImageItself) {
  const cv::Mat image = Blob(100, 80, {40, 40});
  const ImagePyramid pyramid(image, 3);
  EXPECT_EQ(pyramid.level(0).data, image.data);
  EXPECT_EQ(pyramid.scale(0), 1.0);
  EXPECT_EQ(pyramid.ToLevel(12.25, 0), 12.25);
}

TEST(ImagePyramid, EachLevelIsSmallerByTheFactor) {
  const ImagePyramid pyramid(Blob(640, 360, {300, 200}), 8);
  ASSERT_EQ(pyramid.num_levels(), 8);
  for (int level = 0; level < 8; ++level) {
    EXPECT_DOUBLE_EQ(pyramid.scale(level), std::pow(1.2, level));
    EXPECT_NEAR(pyramid.level(level).cols, 640 / std::pow(1.2, level), 1.0);
    EXPECT_NEAR(pyramid.level(level).rows, 360 / std::pow(1.2, level), 1.0);
  }
}

TEST(ImagePyramid, LevelsBelow64PixelsAreLeftOut) {
  // 100 / 1.2^2 = 69, / 1.2^3 = 58.
  EXPECT_EQ(ImagePyramid(Blob(200, 100, {90, 50}), 8).num_levels(), 3);
  // Level 0 is there however small the image.
  EXPECT_EQ(ImagePyramid(Blob(40, 40, {20, 20}), 8).num_levels(), 1);
}

TEST(ImagePyramid, MappingToALevelAndBackIsTheIdentity) {
  const ImagePyramid pyramid(Blob(640, 360, {300, 200}), 8);
  for (int level = 0; level < 8; ++level) {
    for (const double coordinate_px : {0.0, 17.3, 639.0}) {
      EXPECT_NEAR(pyramid.FromLevel(pyramid.ToLevel(coordinate_px, level), level), coordinate_px,
                  1e-9);
    }
  }
}

TEST(ImagePyramid, PixelsLieWhereTheMappingSays) {
  // Near each corner of the image, where an error of the scale is largest. 0.1 px: rounding to
  // grey levels moves the centroid of the blob by less.
  for (const Eigen::Vector2d& centre_px :
       {Eigen::Vector2d(50.3, 40.8), Eigen::Vector2d(590.6, 41.2), Eigen::Vector2d(48.9, 310.1),
        Eigen::Vector2d(588.4, 312.7)}) {
    const ImagePyramid pyramid(Blob(640, 360, centre_px), 8);
    for (int level = 0; level < pyramid.num_levels(); ++level) {
      const Eigen::Vector2d centroid = Centroid(pyramid.level(level));
      EXPECT_NEAR(centroid.x(), pyramid.ToLevel(centre_px.x(), level), 0.1) << "level " << level;
      EXPECT_NEAR(centroid.y(), pyramid.ToLevel(centre_px.y(), level), 0.1) << "level " << level;
    }
  }
}

}  // namespace
}  // namespace airdos
