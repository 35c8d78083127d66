#include "processes/node/frame_node.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "airdos/frame_done_t.hpp"
#include "airdos/map_update_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/pose_t.hpp"
#include "processes/node/message/header.h"
#include "tests/support/echo_node.h"

namespace airdos {
namespace {

struct Inputs {
  std::optional<person_mask_t> mask;
  std::optional<pose_t> pose;
  std::vector<map_update_t> updates;
};

/// Writes down what it is given; says it on OUT too.
class ScribeNode : public FrameNode<Inputs> {
 public:
  ScribeNode() : FrameNode("scribe") {
    Join<person_mask_t>("MASK", &Inputs::mask);
    Join<pose_t>("POSE", &Inputs::pose);
    JoinParts<map_update_t>("PARTS", &Inputs::updates);
    JoinCalibration();
  }
  using FrameNode::SetMaxBehind;
  std::string text;
  std::set<std::int64_t> awaited_feedback;
  std::int64_t fails_at = -1;  // this frame, as long as it has inputs

 protected:
  std::vector<std::string> MissingFeedback(const Header& header) const override {
    return awaited_feedback.count(header.seq) > 0 ? std::vector<std::string>{"FEEDBACK"}
                                                  : std::vector<std::string>{};
  }
  void StartSession(const Header& header) override {
    text += "session" + std::to_string(header.session) + " ";
  }
  void ProcessFrame(const Header& header, Inputs inputs) override {
    text += std::to_string(header.seq) + (inputs.mask ? "m" : "") + (inputs.pose ? "p" : "");
    for (const map_update_t& update : inputs.updates) text += std::to_string(update.part);
    text += "@" + std::to_string(static_cast<int>(camera().baseline_m)) + " ";
    frame_done_t done = {};
    done.seq = header.seq;
    done.process = "scribe";
    Publish("OUT", done);
    if (header.seq == fails_at && inputs.mask) throw std::runtime_error("halfway");
  }
};

template <class Message>
Message MessageAt(std::int64_t seq, std::int64_t session) {
  return MessageOf<Message>({1000 * seq, seq, session});
}

Envelope Mask(std::int64_t seq, std::int64_t session = 7) {
  auto message = MessageAt<person_mask_t>(seq, session);
  message.encoding = person_mask_t::ENCODING_NONE;
  return {"MASK", Encode(message)};
}

Envelope Pose(std::int64_t seq, std::int64_t session = 7) {
  auto message = MessageAt<pose_t>(seq, session);
  message.axes = pose_t::AXES_OPTICAL;
  message.orientation[0] = 1;
  return {"POSE", Encode(message)};
}

Envelope Part(std::int64_t seq, int part, int num_parts, std::int64_t session = 7) {
  auto message = MessageAt<map_update_t>(seq, session);
  message.part = part;
  message.num_parts = num_parts;
  return {"PARTS", Encode(message)};
}

Envelope Calibration(double baseline_m, std::int64_t seq = 0, std::int64_t session = 7) {
  auto message = MessageAt<stereo_calibration_t>(seq, session);
  FromStereoCamera({640, 480, 500, 500, 320, 240, baseline_m}, &message);
  return {channel::kCalibration, Encode(message)};
}

void Give(ScribeNode* node, const Envelope& message) {
  node->Receive(message.channel, message.payload.data(), message.payload.size());
}

void Work(ScribeNode* node) {
  while (node->Step()) {
  }
}

/// All messages of a frame.
void GiveFrame(ScribeNode* node, std::int64_t seq, std::int64_t session = 7) {
  Give(node, Mask(seq, session));
  Give(node, Pose(seq, session));
  Give(node, Part(seq, 0, 1, session));
  Work(node);
}

const ChannelCounters& Counters(const ScribeNode& node, const std::string& channel) {
  return node.channels().at(channel);
}

TEST(FrameNodeTest, WorksOnCompleteFramesInOrder) {
  ScribeNode node;
  Give(&node, Calibration(1));
  Give(&node, Mask(0));
  Give(&node, Mask(1));
  Give(&node, Pose(0));
  Work(&node);
  EXPECT_EQ(node.text, "");
  EXPECT_EQ(node.waiting_for(), "PARTS");
  Give(&node, Part(0, 0, 1));
  Work(&node);
  EXPECT_EQ(node.text, "session7 0mp0@1 ");
  EXPECT_EQ(node.TakeOutput().size(), 1u);
  EXPECT_EQ(node.last_finished()->seq, 0);
  EXPECT_EQ(node.waiting_for(), "POSE PARTS");
}

TEST(FrameNodeTest, CountsGapsAndDuplicates) {
  ScribeNode node;
  Give(&node, Calibration(1));
  GiveFrame(&node, 0);
  GiveFrame(&node, 3);  // 1 and 2 never came
  Give(&node, Mask(3));
  Give(&node, Mask(4));
  Give(&node, Part(4, 0, 1));
  GiveFrame(&node, 5);  // the pose of 4 never came
  EXPECT_EQ(node.text, "session7 0mp0@1 3mp0@1 4m0@1 5mp0@1 ");
  EXPECT_EQ(Counters(node, "MASK").num_missing, 2);
  EXPECT_EQ(Counters(node, "POSE").num_missing, 3);
  EXPECT_EQ(Counters(node, "MASK").num_duplicate, 1);
  EXPECT_EQ(node.frames().num_done, 4);
  EXPECT_EQ(node.frames().num_incomplete, 1);
}

TEST(FrameNodeTest, WhatItsChannelOvertookIsLate) {
  ScribeNode node;
  Give(&node, Calibration(1));
  Give(&node, Mask(1));
  Give(&node, Mask(0));
  EXPECT_EQ(Counters(node, "MASK").num_duplicate, 1);
  Give(&node, Pose(0));
  GiveFrame(&node, 1);
  EXPECT_EQ(node.text, "session7 0p@1 1mp0@1 ");
}

TEST(FrameNodeTest, ANewSessionInTheMiddleForgetsTheOldOne) {
  ScribeNode node;
  Give(&node, Calibration(1));
  Give(&node, Calibration(2, 0, 3));
  GiveFrame(&node, 0);
  Give(&node, Mask(1));  // cut off
  GiveFrame(&node, 0, 3);
  EXPECT_EQ(node.text, "session7 0mp0@1 1m@1 session3 0mp0@2 ");
}

TEST(FrameNodeTest, FramesWaitForALateCalibration) {
  ScribeNode node;
  GiveFrame(&node, 0);
  EXPECT_EQ(node.text, "");
  EXPECT_EQ(node.waiting_for(), channel::kCalibration);
  Give(&node, Calibration(3, 10));
  Work(&node);
  EXPECT_EQ(node.text, "session7 0mp0@3 ");
}

TEST(FrameNodeTest, TheCalibrationDoesNotChangeWithinASession) {
  ScribeNode node;
  Give(&node, Calibration(1));
  Give(&node, Calibration(1, 10));
  EXPECT_EQ(Counters(node, channel::kCalibration).num_rejected, 0);
  Give(&node, Calibration(2, 20));
  EXPECT_EQ(Counters(node, channel::kCalibration).num_rejected, 1);
  GiveFrame(&node, 30);
  EXPECT_EQ(node.text, "session7 30mp0@1 ");
}

TEST(FrameNodeTest, ACalibrationHoldsWhateverItsNumberAndTime) {
  constexpr std::int64_t kLargest = std::int64_t{1} << 40;
  ScribeNode node;
  Give(&node, Calibration(1, kLargest));
  GiveFrame(&node, 30);
  GiveFrame(&node, 31);
  EXPECT_EQ(node.text, "session7 30mp0@1 31mp0@1 ");
  Give(&node, Calibration(1, kLargest + 1));
  EXPECT_EQ(Counters(node, channel::kCalibration).num_rejected, 1);
}

TEST(FrameNodeTest, OfTwoMessagesOfOneNumberTheFirstCounts) {
  for (const bool is_large_first : {true, false}) {
    EchoNode node;  // says how many bytes the images have
    const auto give = [&](const std::string& name, int width) {
      auto image = MessageAt<image_t>(0, 7);
      image.width = image.num_bytes = width;
      image.height = 1;
      image.encoding = image_t::ENCODING_RAW_GRAY8;
      image.data.resize(static_cast<std::size_t>(width));
      const std::vector<std::uint8_t> bytes = Encode(image);
      node.Receive(name, bytes.data(), bytes.size());
    };
    const Envelope calibration = Calibration(1);
    node.Receive(calibration.channel, calibration.payload.data(), calibration.payload.size());
    give(channel::kCameraLeft, is_large_first ? 20 : 10);
    give(channel::kCameraLeft, is_large_first ? 10 : 20);
    give(channel::kCameraRight, 30);
    EXPECT_TRUE(node.Step());
    EXPECT_EQ(node.channels().at(channel::kCameraLeft).num_duplicate, 1);
    pose_t echo = {};
    const std::vector<Envelope> output = node.TakeOutput();
    ASSERT_EQ(output.size(), 1U);
    ASSERT_TRUE(Decode(output[0].payload.data(), output[0].payload.size(), &echo));
    EXPECT_EQ(echo.position[0], is_large_first ? 20 : 10);
  }
}

TEST(FrameNodeTest, WithoutCalibrationACompletedFrameHasNoOutput) {
  ScribeNode node;
  GiveFrame(&node, 0);
  EXPECT_TRUE(node.CompleteOldest());
  EXPECT_EQ(node.text, "");
  EXPECT_EQ(node.frames().num_incomplete, 1);
  EXPECT_EQ(node.last_finished()->seq, 0) << "its source must get its credit back";
}

TEST(FrameNodeTest, CorruptBytesAreCountedAndNamed) {
  ScribeNode node;
  Give(&node, Calibration(1));
  Envelope cut = Mask(0);
  cut.payload.pop_back();
  Give(&node, cut);
  EXPECT_EQ(Counters(node, "MASK").last_reject, "does not decode");
  Envelope longer = Mask(0);
  longer.payload.push_back(0);
  Give(&node, longer);
  Envelope wrong_type = Pose(0);
  wrong_type.channel = "MASK";
  Give(&node, wrong_type);
  Give(&node, {"MASK", {}});
  EXPECT_EQ(Counters(node, "MASK").num_rejected, 4);
  Give(&node, Part(0, 2, 2));
  EXPECT_NE(Counters(node, "PARTS").last_reject.find("part 2"), std::string::npos);
  Give(&node, {"UNKNOWN", {1, 2, 3}});
  EXPECT_EQ(node.num_pending(), 0u);
}

TEST(FrameNodeTest, PartsAreJoinedInOrderOfTheirNumber) {
  ScribeNode node;
  Give(&node, Calibration(1));
  Give(&node, Mask(0));
  Give(&node, Pose(0));
  for (const int part : {2, 0}) Give(&node, Part(0, part, 3));
  Give(&node, Part(0, 0, 3));
  Work(&node);
  EXPECT_EQ(node.text, "");
  EXPECT_EQ(Counters(node, "PARTS").last_reject, "part 0 came twice");
  Give(&node, Part(0, 1, 2));
  EXPECT_EQ(Counters(node, "PARTS").last_reject, "num_parts 2 differs from that of another part");
  Give(&node, Part(0, 1, 3));
  Work(&node);
  EXPECT_EQ(node.text, "session7 0mp012@1 ");
}

TEST(FrameNodeTest, AnIncompleteSetOfPartsIsGivenUpWhenTheNextBegins) {
  ScribeNode node;
  Give(&node, Calibration(1));
  Give(&node, Mask(0));
  Give(&node, Pose(0));
  Give(&node, Part(0, 0, 2));
  Give(&node, Part(1, 0, 2));
  Work(&node);
  EXPECT_EQ(node.text, "session7 0mp@1 ") << "settled by the first part of frame 1";
  Give(&node, Part(0, 1, 2));
  EXPECT_EQ(Counters(node, "PARTS").num_duplicate, 1) << "late";
  Give(&node, Mask(1));
  Give(&node, Pose(1));
  Give(&node, Part(1, 1, 2));
  Work(&node);
  EXPECT_EQ(node.text, "session7 0mp@1 1mp01@1 ");
}

TEST(FrameNodeTest, FeedbackHoldsAFrameBack) {
  ScribeNode node;
  node.awaited_feedback = {1};
  Give(&node, Calibration(1));
  GiveFrame(&node, 0);
  GiveFrame(&node, 1);
  EXPECT_EQ(node.waiting_for(), "FEEDBACK");
  EXPECT_EQ(node.text, "session7 0mp0@1 ");
  node.awaited_feedback.clear();
  Work(&node);
  EXPECT_EQ(node.text, "session7 0mp0@1 1mp0@1 ");
}

// Who waits for the output must not wait for ever, nor get two.
TEST(FrameNodeTest, AFrameThatThrowsIsWorkedOnWithoutInputs) {
  ScribeNode node;
  node.fails_at = 1;
  Give(&node, Calibration(1));
  GiveFrame(&node, 0);
  EXPECT_EQ(node.TakeOutput().size(), 1u);
  EXPECT_THROW(GiveFrame(&node, 1), std::runtime_error);
  EXPECT_EQ(node.text, "session7 0mp0@1 1mp0@1 1@1 ");
  EXPECT_EQ(node.TakeOutput().size(), 1u);
  EXPECT_EQ(node.last_finished()->seq, 1);
  GiveFrame(&node, 2);
  EXPECT_EQ(node.text, "session7 0mp0@1 1mp0@1 1@1 2mp0@1 ");
  EXPECT_EQ(node.TakeOutput().size(), 1u);
}

TEST(FrameNodeTest, OnlyWhatCanStillComeIsWaitedFor) {
  ScribeNode node;
  node.awaited_feedback = {1};
  Give(&node, Calibration(1));
  GiveFrame(&node, 0);
  Give(&node, Mask(1));
  Give(&node, Part(1, 0, 1));
  EXPECT_EQ(node.waiting_for(), "POSE FEEDBACK");
  Give(&node, Pose(2));  // so that of frame 1 is lost
  Work(&node);
  EXPECT_EQ(node.waiting_for(), "FEEDBACK");
  node.awaited_feedback.clear();
  Work(&node);
  EXPECT_EQ(node.text, "session7 0mp0@1 1m0@1 ");
  EXPECT_EQ(node.waiting_for(), "MASK PARTS") << "of frame 2";
}

TEST(FrameNodeTest, MemoryStaysBoundedWhenAChannelIsSilent) {
  ScribeNode node;
  Give(&node, Calibration(1));
  for (int seq = 0; seq < 1500; ++seq) {
    Give(&node, Mask(seq));
    Work(&node);
  }
  EXPECT_EQ(node.num_pending(), ScribeNode::kMaxPending);
}

TEST(FrameNodeTest, RealtimeMemoryStaysBoundedWhenAChannelIsSilent) {
  ScribeNode node;
  for (int seq = 0; seq < 1500; ++seq) {
    Give(&node, Mask(seq));
    node.SkipToNewest();
  }
  EXPECT_EQ(node.num_pending(), ScribeNode::kMaxPending);
  EXPECT_EQ(node.frames().num_skipped, 500);
}

// Raw masks of 12 megapixels, as large as a message may be.
TEST(FrameNodeTest, WaitingFramesAreBoundedInBytesToo) {
  ScribeNode node;
  auto mask = MessageAt<person_mask_t>(0, 7);
  mask.encoding = person_mask_t::ENCODING_RAW_GRAY8;
  mask.width = 4000;
  mask.height = 3000;
  mask.num_bytes = mask.width * mask.height;
  mask.data.assign(static_cast<std::size_t>(mask.num_bytes), 1);
  for (mask.seq = 0; mask.seq < 60; ++mask.seq) {
    Give(&node, {"MASK", Encode(mask)});
    node.SkipToNewest();
  }
  const std::size_t most = ScribeNode::kMaxPendingBytes / static_cast<std::size_t>(mask.num_bytes);
  EXPECT_EQ(node.num_pending(), most);
  EXPECT_GT(node.frames().num_skipped, 0);
}

TEST(FrameNodeTest, AMessageThatIsTooLargeIsNotDecoded) {
  ScribeNode node;
  Give(&node, {"POSE", std::vector<std::uint8_t>(kMaxOtherMessageBytes + 1)});
  EXPECT_EQ(node.channels().at("POSE").num_rejected, 1);
  EXPECT_EQ(node.channels().at("POSE").last_reject, "1048577 bytes are too many");
}

// Whoever announces ever new sessions pushes out one that no frame came of, never more.
TEST(FrameNodeTest, CalibrationsOfSessionsWithoutFramesAreBounded) {
  ScribeNode node;
  for (std::int64_t session = 1; session <= 101; ++session) Give(&node, Calibration(1, 0, session));
  GiveFrame(&node, 0, 1);
  Work(&node);
  EXPECT_EQ(node.text, "") << "forgotten";
  Give(&node, Calibration(1, 0, 1));  // it is repeated once a second
  Work(&node);
  EXPECT_NE(node.text.find("session1 "), std::string::npos) << node.text;
}

TEST(FrameNodeTest, RealtimeSkipsToTheNewestCompleteFrame) {
  ScribeNode node;
  Give(&node, Calibration(1));
  for (std::int64_t seq = 0; seq < 4; ++seq) {
    Give(&node, Mask(seq));
    Give(&node, Pose(seq));
    if (seq < 3) Give(&node, Part(seq, 0, 1));
  }
  node.SkipToNewest();
  Work(&node);
  EXPECT_EQ(node.text, "session7 2mp0@1 ");
  EXPECT_EQ(node.frames().num_skipped, 2);
}

TEST(FrameNodeTest, RealtimeLetsSomeWaitWhereTheNodeSaysSo) {
  ScribeNode node;
  node.SetMaxBehind(2);
  Give(&node, Calibration(1));
  for (std::int64_t seq = 0; seq < 4; ++seq) {
    Give(&node, Mask(seq));
    Give(&node, Pose(seq));
    Give(&node, Part(seq, 0, 1));
  }
  node.SkipToNewest();
  EXPECT_EQ(node.frames().num_skipped, 1);
  EXPECT_EQ(node.num_pending(), 3u);
  node.SkipToNewest();
  EXPECT_EQ(node.frames().num_skipped, 1);
}

/// One channel's messages of two sessions, with losses, duplicates, late and corrupt ones.
std::vector<Envelope> Damaged(const std::function<std::vector<Envelope>(int, std::int64_t)>& make,
                              std::mt19937* random) {
  std::vector<Envelope> messages;
  for (const std::int64_t session : {7, 3}) {
    for (int seq = 0; seq < 25; ++seq) {
      for (Envelope& message : make(seq, session)) {
        const auto dice = seq == 0 ? 9 : (*random)() % 12;
        if (dice == 0) continue;
        // Behind the header: nobody can tell another session from a damaged session number.
        if (dice == 1) message.payload[32 + (*random)() % (message.payload.size() - 32)] ^= 0x40;
        messages.push_back(message);
        if (dice == 2) messages.push_back(message);
        if (dice == 3 && seq > 2) messages.push_back(make(seq - 2, session).front());
      }
    }
  }
  return messages;
}

std::string RunInterleaved(const std::vector<std::vector<Envelope>>& channels,
                           std::mt19937* random) {
  ScribeNode node;
  std::vector<std::size_t> next(channels.size(), 0);
  std::size_t num_left = 0;
  for (const auto& channel : channels) num_left += channel.size();
  while (num_left > 0) {
    const std::size_t which = (*random)() % channels.size();
    if (next[which] == channels[which].size()) continue;
    Give(&node, channels[which][next[which]++]);
    --num_left;
    if ((*random)() % 4 != 0) Work(&node);
  }
  Work(&node);
  while (node.CompleteOldest()) Work(&node);
  return node.text;
}

TEST(FrameNodeTest, TheInterleavingOfChannelsChangesNothing) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    using Messages = std::vector<Envelope>;
    const std::vector<Messages> channels = {
        Damaged([](int seq, std::int64_t s) { return Messages{Mask(seq, s)}; }, &random),
        Damaged([](int seq, std::int64_t s) { return Messages{Pose(seq, s)}; }, &random),
        Damaged(
            [](int seq, std::int64_t s) {
              return Messages{Part(seq, 0, 2, s), Part(seq, 1, 2, s)};
            },
            &random),
        {Calibration(1), Calibration(2, 5), Calibration(3, 0, 3)}};
    const std::string reference = RunInterleaved(channels, &random);
    EXPECT_GT(reference.size(), 200u);
    for (int run = 0; run < 10; ++run) {
      ASSERT_EQ(RunInterleaved(channels, &random), reference) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace airdos
