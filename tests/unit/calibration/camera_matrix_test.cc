// Matrices and sizes as they stand in files.
#include "common/calibration/camera_matrix.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/input_errors.h"

namespace airdos {
namespace {

Eigen::Matrix3d K() {
  Eigen::Matrix3d matrix;
  matrix << 500, 0, 320.5, 0, 510, 240.25, 0, 0, 1;
  return matrix;
}

std::string Complaint(const Eigen::Matrix3d& matrix) {
  return ErrorOf([&] { ToIntrinsics(matrix, "x: key 'K'"); });
}

TEST(CameraMatrix, IsTakenApart) {
  const CameraIntrinsics camera = ToIntrinsics(K(), "x");
  EXPECT_EQ(camera.fx_px, 500);
  EXPECT_EQ(camera.fy_px, 510);
  EXPECT_EQ(camera.cx_px, 320.5);
  EXPECT_EQ(camera.cy_px, 240.25);
}

TEST(CameraMatrix, OfAnotherKindIsRefused) {
  EXPECT_TRUE(Holds(Complaint(K().transpose()), "x: key 'K' is written column by column"));
  EXPECT_TRUE(Holds(Complaint(Eigen::Matrix3d::Zero()), "was not calibrated"));
  EXPECT_TRUE(Holds(Complaint(2 * K()), "no camera matrix"));
  Eigen::Matrix3d skewed = K();
  skewed(0, 1) = 0.49;
  EXPECT_EQ(Complaint(skewed), "");
  skewed(0, 1) = -0.51;
  EXPECT_TRUE(Holds(Complaint(skewed), "a skew of -0.51 px"));
  for (const auto& [row, col] : {std::make_pair(1, 0), {2, 0}, {2, 1}}) {
    Eigen::Matrix3d wrong = K();
    wrong(row, col) = 0.5;
    EXPECT_TRUE(Holds(Complaint(wrong), "no camera matrix")) << row << " " << col;
  }
}

TEST(ImageSize, IsWholeAndAboveZero) {
  EXPECT_EQ(ToImageSize(1392, 512, "x"), std::make_pair(1392, 512));
  for (const auto& [width, height] : {std::make_pair(0.0, 480.0),
                                      {640, 0},
                                      {640.5, 480},
                                      {640, -480},
                                      {1e300, 480},
                                      {640, 1e6}}) {
    EXPECT_TRUE(Holds(ErrorOf([w = width, h = height] { ToImageSize(w, h, "x"); }), "no size"))
        << width << " " << height;
  }
}

std::vector<double> P(double fx, double cx, double tx) {
  return {fx, 0, cx, tx, 0, 510, 240.25, 0, 0, 0, 1, 0};
}

TEST(Projection, TwoAreAPairIfOnlyTheirPlaceDiffers) {
  const ProjectionMatrix left = ToProjection(P(500, 320.5, 25), "x");
  const ProjectionMatrix right = ToProjection(P(500, 320.5, -75), "x");
  EXPECT_EQ(BaselineOf(left, right), 0.2);
  const std::optional<StereoCamera> pair = RectifiedPair(left, right, {640, 480});
  ASSERT_TRUE(pair);
  EXPECT_TRUE((*pair == StereoCamera{640, 480, 500, 510, 320.5, 240.25, 0.2}));
  EXPECT_FALSE(RectifiedPair(left, ToProjection(P(500, 321, -75), "x"), {640, 480}));
  EXPECT_FALSE(RectifiedPair(left, ToProjection(P(501, 320.5, -75), "x"), {640, 480}));
}

TEST(Projection, WithoutAFocalLengthIsRefused) {
  EXPECT_TRUE(Holds(ErrorOf([] { ToProjection(P(0, 1, 2), "x"); }), "above 0"));
  std::vector<double> numbers = P(500, 320, 0);
  numbers[5] = -1;
  EXPECT_TRUE(Holds(ErrorOf([&] { ToProjection(numbers, "x"); }), "above 0"));
  numbers.pop_back();
  EXPECT_TRUE(Holds(ErrorOf([&] { ToProjection(numbers, "x"); }), "12 numbers, holds 11"));
}

}  // namespace
}  // namespace airdos
