#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <utility>
#include <vector>

#include "processes/frontend/frontend_node.h"
#include "tests/node/frontend_walk.h"

// What the frontend makes of images and masks: good, missing, wrong.

namespace airdos {
namespace {

TEST(FrontendNode, AFrameWithoutItsRightImageIsTrackedInTheLeftOne) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 5; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 5u);
  SendNobody(5, &node);
  Send(channel::kCameraLeft, Left(5), &node);
  Send(channel::kPersonMask, NoMask(5), &node);
  EXPECT_FALSE(node.Step());
  EXPECT_EQ(node.waiting_for(), channel::kCameraRight);
  SendFrame(6, &node);  // which tells that the right image of frame 5 is lost
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 2u);
  EXPECT_EQ(output[0].seq, 5);
  EXPECT_EQ(output[0].tracking_state, kTracking);
  EXPECT_GT(output[0].num_features, 30);
  EXPECT_EQ(std::count(output[0].has_right.begin(), output[0].has_right.end(), 1), 0);
  EXPECT_LT(PositionError_m(output[0], Truth(5)), 0.015);
  EXPECT_EQ(output[1].tracking_state, kTracking);
  EXPECT_LT(PositionError_m(output[1], Truth(6)), 0.015);
  EXPECT_EQ(node.channels().at(channel::kCameraRight).num_missing, 1);
  EXPECT_EQ(node.frames().num_incomplete, 1);
}

TEST(FrontendNode, FeaturesOnPeopleAndAroundThemAreLeftOut) {
  constexpr int kBegin_px = 100;
  constexpr int kEnd_px = 200;
  FrontendOptions options = WithoutFeedback();
  options.mask_dilation_px = 12;
  FrontendNode node(options);
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 3; ++k) {
    SendNobody(k, &node);
    Send(channel::kCameraLeft, Left(k), &node);
    Send(channel::kCameraRight, Right(k), &node);
    Send(channel::kPersonMask, Mask(k, kBegin_px, kEnd_px), &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 1u);
    EXPECT_GT(output[0].num_masked, 20);
    EXPECT_GT(output[0].num_features, 30);
    for (const float u_px : output[0].u_left_px) {
      // Half a pixel: coordinates are those of the pixel's centre.
      EXPECT_TRUE(u_px < kBegin_px - 12 - 0.5 || u_px > kEnd_px - 1 + 12 + 0.5) << u_px;
    }
  }
}

TEST(FrontendNode, AFrameWhoseMaskIsMissingIsTrackedWithoutIt) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 4; ++k) {
    SendNobody(k, &node);
    Send(channel::kCameraLeft, Left(k), &node);
    Send(channel::kCameraRight, Right(k), &node);
    if (k != 2) Send(channel::kPersonMask, Mask(k, 0, 150), &node);
  }
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 4u);
  EXPECT_GT(output[1].num_masked, 0);
  EXPECT_EQ(output[2].num_masked, 0);
  EXPECT_EQ(output[2].tracking_state, kTracking);
  EXPECT_GT(output[3].num_masked, 0);
  EXPECT_EQ(node.channels().at(channel::kPersonMask).num_missing, 1);
}

TEST(FrontendNode, AMaskOfAnotherSizeIsRejectedAndTheFrameTracked) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  SendFrame(0, &node);
  SendNobody(1, &node);
  Send(channel::kCameraLeft, Left(1), &node);
  Send(channel::kCameraRight, Right(1), &node);
  Send(channel::kPersonMask, Mask(1, 0, 20, {40, 30}), &node);
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 2u);
  EXPECT_EQ(output[1].tracking_state, kTracking);
  EXPECT_EQ(output[1].num_masked, 0);
  EXPECT_EQ(node.channels().at(channel::kPersonMask).num_rejected, 1);
}

TEST(FrontendNode, WithoutMasksTheChannelIsNotRead) {
  FrontendOptions options = WithoutFeedback();
  options.use_masks = false;
  FrontendNode node(options);
  Send(channel::kCalibration, Calibration(), &node);
  SendNobody(0, &node);
  Send(channel::kCameraLeft, Left(0), &node);
  Send(channel::kCameraRight, Right(0), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
  EXPECT_EQ(node.channels().count(channel::kPersonMask), 0u);
}

TEST(FrontendNode, ACorruptJpegIsCountedAndTheFrameCoasts) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 4; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 4u);
  image_t corrupt = Left(4);
  corrupt.encoding = image_t::ENCODING_JPEG;
  corrupt.data.assign(500, 0x5a);
  corrupt.num_bytes = 500;
  SendNobody(4, &node);
  Send(channel::kCameraLeft, corrupt, &node);
  Send(channel::kCameraRight, Right(4), &node);
  Send(channel::kPersonMask, NoMask(4), &node);
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 1u);
  EXPECT_EQ(output[0].tracking_state, kCoasting);
  EXPECT_EQ(node.channels().at(channel::kCameraLeft).num_rejected, 1);
  EXPECT_EQ(node.channels().at(channel::kCameraLeft).last_reject,
            "the image is neither a JPEG nor a PNG file");
  EXPECT_EQ(node.channels().at(channel::kCameraRight).num_rejected, 0);
}

TEST(FrontendNode, AFrameWithoutItsLeftImageCoasts) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 5; ++k) SendFrame(k, &node);
  SendNobody(5, &node);
  Send(channel::kCameraRight, Right(5), &node);
  Send(channel::kPersonMask, NoMask(5), &node);
  SendFrame(6, &node);
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 7u);
  EXPECT_EQ(output[5].tracking_state, kCoasting);
  EXPECT_EQ(output[5].num_features, 0);
  EXPECT_LT(PositionError_m(output[5], Truth(5)), 0.03);
  EXPECT_EQ(output[6].tracking_state, kTracking);
  EXPECT_LT(PositionError_m(output[6], Truth(6)), 0.015);
}

TEST(FrontendNode, AnImageOfAnotherSizeIsCountedAndDoneWithout) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  SendFrame(0, &node);
  SendNobody(1, &node);
  Send(channel::kCameraLeft, Left(1), &node);
  Send(channel::kCameraRight, ImageOf(cv::Mat(40, 60, CV_8UC1, cv::Scalar(9)), 1), &node);
  Send(channel::kPersonMask, NoMask(1), &node);
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 2u);
  EXPECT_EQ(output[1].tracking_state, kTracking);
  EXPECT_EQ(std::count(output[1].has_right.begin(), output[1].has_right.end(), 1), 0);
  EXPECT_EQ(node.channels().at(channel::kCameraRight).num_rejected, 1);
}

TEST(FrontendNode, PngAndRawGiveTheSameBytes) {
  FrontendNode raw(WithoutFeedback());
  FrontendNode png(WithoutFeedback());
  for (FrontendNode* node : {&raw, &png}) Send(channel::kCalibration, Calibration(), node);
  for (int k = 0; k < 2; ++k) {
    SendFrame(k, &raw);
    for (const auto& [channel, image] :
         {std::pair{channel::kCameraLeft, Walk(k).left}, {channel::kCameraRight, Walk(k).right}}) {
      image_t message = ImageOf(image, k);
      message.encoding = image_t::ENCODING_PNG;
      cv::imencode(".png", image, message.data);
      message.num_bytes = static_cast<std::int32_t>(message.data.size());
      Send(channel, message, &png);
    }
    Send(channel::kPersonMask, NoMask(k), &png);
    SendNobody(k, &png);
  }
  const std::vector<static_features_t> a = StepAll(&raw);
  const std::vector<static_features_t> b = StepAll(&png);
  ASSERT_EQ(a.size(), 2u);
  ASSERT_EQ(b.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(Encode(a[i]), Encode(b[i]));
}

// Blind, and each step in time nine times as long as the one before: the motion of before leads to
// other stars.
TEST(FrontendNode, WhatIsBeyondAllBoundsIsNotSaid) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 4; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 4u);
  std::int64_t utime = Left(3).utime;
  std::int64_t step_us = utime - Left(2).utime;
  for (int k = 4; k < 16; ++k) {
    auto humans = NoHumans(k);
    utime += step_us *= 9;
    humans.utime = utime;
    Send(channel::kHumanObservations, humans, &node);
    ASSERT_TRUE(node.CompleteOldest());
  }
  const std::vector<static_features_t> output = Take(&node);  // valid, all of them
  ASSERT_EQ(output.size(), 12u);
  EXPECT_EQ(output[0].tracking_state, kCoasting);
  EXPECT_EQ(output[0].odometry_start_seq, 0);
  EXPECT_GT(output.back().odometry_start_seq, 4);
}

}  // namespace
}  // namespace airdos
