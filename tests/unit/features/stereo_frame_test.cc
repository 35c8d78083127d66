#include "common/features/stereo_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/walked_frame.h"

namespace airdos {
namespace {

const StereoCamera kCamera = SmallStereoCamera();

cv::Mat Blank() { return cv::Mat(kCamera.height, kCamera.width, CV_8UC1, cv::Scalar(0)); }

TEST(StereoFrame, NoFeatureOfTheLeftImageLiesOnPeople) {
  const WalkedFrame plain(0);
  EXPECT_EQ(plain->num_masked(), 0);
  ASSERT_GT(plain->left_features().size(), 200u);
  cv::Mat mask = Blank();
  mask.colRange(90, 200) = cv::Scalar(1);
  const WalkedFrame masked(0, mask);
  EXPECT_GT(masked->num_masked(), 20);
  for (const Feature& feature : masked->left_features()) {
    const long u = std::lround(feature.uv_px.x());
    EXPECT_TRUE(u < 90 || u >= 200) << u;
  }
}

// The mask is that of the left image: what stands beside people there, and where people are in the
// left image in the right one, keeps its partner.
TEST(StereoFrame, TheRightImageHasNoMask) {
  cv::Mat mask = Blank();
  mask.colRange(90, 200) = cv::Scalar(255);
  const WalkedFrame frame(0, mask);
  int num_under_mask = 0;
  for (const Feature& feature : frame->left_features()) {
    const auto u_right_px = frame->stereo().Match(feature);
    if (u_right_px && *u_right_px > 92 && *u_right_px < 198) ++num_under_mask;
  }
  EXPECT_GT(num_under_mask, 3);
}

TEST(StereoFrame, TheGridFindsItsFeatures) {
  const WalkedFrame frame(0);
  const Feature& feature = frame->left_features()[7];
  bool is_found = false;
  frame->grid().ForEachNear(feature.uv_px, 0.5, {feature.level, feature.level},
                            [&](int index) { is_found = is_found || index == 7; });
  EXPECT_TRUE(is_found);
}

TEST(StereoFrame, APixelIsMaskedToItsBorder) {
  cv::Mat mask = Blank();
  mask.at<uchar>(20, 10) = 1;
  mask.at<uchar>(191, 319) = 255;
  const WalkedFrame frame(0, mask);
  EXPECT_TRUE(frame->IsMasked({9.51, 20.49}));
  EXPECT_FALSE(frame->IsMasked({9.49, 20}));
  EXPECT_FALSE(frame->IsMasked({10, 20.51}));
  EXPECT_FALSE(frame->IsMasked({20, 10}));
  // Off the image the nearest pixel counts.
  EXPECT_TRUE(frame->IsMasked({400, 250}));
  EXPECT_FALSE(frame->IsMasked({-5, -5}));
  EXPECT_FALSE(WalkedFrame(0)->IsMasked({10, 20})) << "without a mask";
}

TEST(StereoFrame, TheLeftImageOutlivesTheFrame) {
  std::shared_ptr<const ImagePyramid> left;
  FrameId id;
  {
    const WalkedFrame frame(3);
    left = frame->left();
    id = frame->id();
  }
  EXPECT_EQ(id.value, 3);
  EXPECT_GT(left->num_levels(), 4);
  EXPECT_EQ(left->level(0).cols, kCamera.width);
}

}  // namespace
}  // namespace airdos
