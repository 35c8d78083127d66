// What airdos-evaluate detections takes of a log and of a data set, and how it joins them.
#include "processes/tools/evaluate/detection_input.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <vector>

#include "airdos/person_keypoints_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "tests/node/small_log_test.h"
#include "tests/support/input_errors.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNumFrames = SmallSequence::kNumFrames;

class DetectionInputTest : public SmallLogTest {
 protected:
  DetectionInputTest() : SmallLogTest("detection_input", 1) {}

  void SetUp() override { Sequence().Write(Data()); }
  static const SmallSequence& Sequence() {
    static const SmallSequence sequence = SmallSequence::Make();
    return sequence;
  }
  std::string Data() const { return scratch_.PathOf("data"); }
  DetectionInput Read() const {
    Write();
    return ReadDetections(path_, Data());
  }
  /// Why the log and the folder are refused.
  std::string Refusal() const {
    return ErrorOf([&] { Read(); });
  }
  /// Nobody in frame 0, the person of identity `10 + k` in frame k.
  void WriteTruth() const {
    std::string joints = "[";
    std::string poses;
    for (std::size_t k = 0; k < kNumFrames; ++k) {
      const std::string time = std::to_string(0.1 * static_cast<double>(k));
      joints += (k > 0 ? ",{\"t\":" : "{\"t\":") + time + ",\"humans\":[";
      if (k > 0) {
        joints += "{\"id\":" + std::to_string(10 + k) +
                  R"(,"joints_w":{"0":[1,2,3]},"vis0":[1],"vis1":[0]})";
      }
      joints += "]}";
      poses += time + " " + std::to_string(k) + " 0 0 0 0 0 1\n";
    }
    scratch_.Write("data/joints_gt.json", joints + "]");
    scratch_.Write("data/gt_tum_optical.txt", poses);
  }
  void ChangeKeypoints(const std::string& channel,
                       const std::function<void(person_keypoints_t*)>& change) {
    for (Envelope& envelope : messages_) {
      if (envelope.channel != channel) continue;
      person_keypoints_t message;
      ASSERT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
      change(&message);
      envelope.payload = Encode(message);
    }
  }
  static bool Says(const DetectionInput& input, const std::string& text, bool is_warning = true) {
    return std::any_of(input.remarks.begin(), input.remarks.end(), [&](const Remark& remark) {
      return remark.text.find(text) != std::string::npos && remark.is_warning == is_warning;
    });
  }
};

TEST_F(DetectionInputTest, PeopleOfBothImagesAndWhatIsGiven) {
  ChangeKeypoints(channel::kPersonKeypointsLeft, [](auto* message) { message->u_px[0][3] += 2; });
  const DetectionInput input = Read();
  ASSERT_EQ(input.frames.size(), kNumFrames);
  EXPECT_EQ(input.camera, Sequence().camera);
  for (std::size_t k = 0; k < kNumFrames; ++k) {
    const DetectionFrame& frame = input.frames[k];
    ASSERT_EQ(frame.detected[kLeftImage].value().size(), 2u);
    EXPECT_EQ(frame.detected[kRightImage].value().size(), 2u);
    ASSERT_EQ(frame.given[kLeftImage].value().size(), 2u);
    const double neck_px = 80 + static_cast<double>(k);
    EXPECT_EQ((*frame.detected[kLeftImage])[0][kNeck].u_px, neck_px);
    EXPECT_EQ((*frame.detected[kRightImage])[0][kNeck].u_px, neck_px - 10);
    EXPECT_EQ((*frame.given[kLeftImage])[0][kNeck].u_px, neck_px);
    EXPECT_EQ((*frame.given[kRightImage])[0][kNeck].u_px, neck_px - 10);
    EXPECT_EQ((*frame.detected[kLeftImage])[0][kRightElbow].u_px,
              (*frame.given[kLeftImage])[0][kRightElbow].u_px + 2);
    EXPECT_FALSE(frame.truth);
  }
  ASSERT_EQ(input.remarks.size(), 1u);
  EXPECT_TRUE(Says(input, "no joints_gt.json.gz", false));
}

TEST_F(DetectionInputTest, TruthIsJoinedByTime) {
  WriteTruth();
  // Image numbers say nothing: the first images are missing.
  messages_.erase(std::remove_if(messages_.begin(), messages_.end(),
                                 [](const Envelope& m) {
                                   return m.channel != channel::kCalibration &&
                                          PeekHeader(m.payload.data(), m.payload.size())->seq < 3;
                                 }),
                  messages_.end());
  for (const char* channel : {channel::kPersonKeypointsLeft, channel::kPersonKeypointsRight}) {
    ChangeKeypoints(channel, [](auto* message) {
      message->seq += 500;
      message->utime += message->seq % 2 == 0 ? 900 : -900;
      message->v_px[0][0] += 1;
    });
  }
  const DetectionInput input = Read();
  ASSERT_EQ(input.frames.size(), kNumFrames - 3);
  for (std::size_t k = 3; k < kNumFrames; ++k) {
    const DetectionFrame& frame = input.frames[k - 3];
    EXPECT_EQ(frame.truth.value().T_W_C.position_m.x(), static_cast<double>(k));
    EXPECT_EQ(frame.truth->people.begin()->first, static_cast<std::int64_t>(10 + k));
    EXPECT_EQ(frame.truth->people.begin()->second.num_visible_left, 1);
    EXPECT_EQ((*frame.given[kLeftImage])[0][kNeck].u_px, 80 + static_cast<double>(k));
  }
  EXPECT_TRUE(Says(input, "data: 3 images have no keypoints in the log"));
  EXPECT_EQ(input.remarks.size(), 1u);
}

TEST_F(DetectionInputTest, TimesApartAreSaid) {
  for (const char* channel : {channel::kPersonKeypointsLeft, channel::kPersonKeypointsRight}) {
    ChangeKeypoints(channel, [](auto* message) {
      if (message->seq >= 12) message->utime += message->seq == 12 ? 1100 : -1100;
      message->v_px[0][0] += 1;
    });
  }
  const DetectionInput input = Read();
  EXPECT_EQ(input.frames.size(), 12u);
  EXPECT_TRUE(Says(input, "2 frames are at times that the data set does not have"));
  EXPECT_TRUE(Says(input, "data: 2 images have no keypoints in the log"));

  for (const char* channel : {channel::kPersonKeypointsLeft, channel::kPersonKeypointsRight}) {
    ChangeKeypoints(channel, [](auto* message) { message->utime += 1000000000; });
  }
  EXPECT_EQ(Refusal(), path_ + " and " + Data() +
                           " have no time in common: 1000.000 to 1001.299 s; 0.000 to 1.300 s");
}

TEST_F(DetectionInputTest, ALayoutOfSeventeenIsConvertedAsTheTrackerDoes) {
  ChangeKeypoints(channel::kPersonKeypointsLeft, [](auto* message) {
    message->layout = person_keypoints_t::LAYOUT_COCO17;
    message->num_joints = 17;
    for (auto* table : {&message->u_px, &message->v_px, &message->confidence}) {
      for (auto& row : *table) row.resize(17);
    }
    message->u_px[0][5] = 50;  // the left shoulder, and the right one: the neck is between them
    message->u_px[0][6] = 40;
  });
  const DetectionInput input = Read();
  const BodyKeypoints& person = (*input.frames[0].detected[kLeftImage])[0];
  EXPECT_EQ(person[kLeftShoulder].u_px, 50);
  EXPECT_EQ(person[kRightShoulder].u_px, 40);
  EXPECT_EQ(person[kNeck].u_px, 45);
}

TEST_F(DetectionInputTest, WhatTheLogLacksIsSaid) {
  // Of the right images frame 2 is missing, frame 3 is invalid, and frame 4 comes twice.
  std::vector<Envelope> changed;
  for (const Envelope& message : messages_) {
    const std::int64_t seq = PeekHeader(message.payload.data(), message.payload.size())->seq;
    const bool is_right = message.channel == channel::kPersonKeypointsRight;
    if (is_right && seq == 2) continue;
    changed.push_back(message);
    if (is_right && seq == 3) changed.back().payload.resize(40);
    if (is_right && seq == 4) changed.push_back(message);
  }
  messages_ = changed;
  Remove(channel::kCalibration);
  const DetectionInput input = Read();
  EXPECT_EQ(input.frames.size(), kNumFrames);
  EXPECT_FALSE(input.frames[2].detected[kRightImage]);
  EXPECT_TRUE(input.frames[2].detected[kLeftImage]);
  EXPECT_TRUE(Says(input, "1 messages with keypoints are invalid"));
  EXPECT_TRUE(Says(input, "1 messages are of an image that has keypoints already"));
  EXPECT_TRUE(Says(input, "2 of 14 frames have no keypoints of the right image"));
  EXPECT_FALSE(Says(input, "of the left image"));
  EXPECT_TRUE(Says(input, "no CALIBRATION", false));
  EXPECT_TRUE(Says(input, "no detector ran"));
}

TEST_F(DetectionInputTest, FramesWithoutATruthAreSaid) {
  WriteTruth();
  scratch_.Write("data/gt_tum_optical.txt", "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n");
  const DetectionInput input = Read();
  EXPECT_TRUE(input.frames[1].truth);
  EXPECT_FALSE(input.frames[2].truth);
  EXPECT_TRUE(Says(input, "12 frames have no true joints, or no true pose"));
}

TEST_F(DetectionInputTest, WithoutGivenPeopleTheTruthIsEnough) {
  WriteTruth();
  fs::remove_all(fs::path(Data()) / "alphapose_0");
  fs::remove_all(fs::path(Data()) / "alphapose_1");
  const DetectionInput input = Read();
  EXPECT_FALSE(input.frames[1].given[kLeftImage]);
  EXPECT_TRUE(input.frames[1].truth);
  EXPECT_TRUE(Says(input, "no keypoints are given", false));
  fs::remove(fs::path(Data()) / "joints_gt.json");
  EXPECT_NE(Refusal().find("has neither true joints (joints_gt.json.gz) nor keypoints"),
            std::string::npos);
}

TEST_F(DetectionInputTest, WhatCannotBeComparedIsRefused) {
  WriteTruth();
  fs::remove(fs::path(Data()) / "gt_tum_optical.txt");
  EXPECT_NE(Refusal().find("gt_tum_optical.txt"), std::string::npos);
  WriteTruth();
  scratch_.Write("data/gt_tum_optical.txt", "t;x;y;z\n0;0;0;0\n0.1;1;0;0\n");
  EXPECT_NE(Refusal().find("wanted are poses of the left camera"), std::string::npos);
  WriteTruth();
  for (Envelope& envelope : messages_) {
    if (envelope.channel != channel::kCalibration) continue;
    stereo_calibration_t message;
    ASSERT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
    message.cx_px += 1;
    envelope.payload = Encode(message);
  }
  EXPECT_NE(Refusal().find("different cameras"), std::string::npos);
  Remove(channel::kPersonKeypointsLeft);
  EXPECT_NE(Refusal().find("no message on PERSON_KEYPOINTS_LEFT"), std::string::npos);
}

}  // namespace
}  // namespace airdos
