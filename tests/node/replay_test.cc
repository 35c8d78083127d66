#include "processes/tools/replay/replay.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "common/util/error.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "tests/node/fake_nodes.h"

namespace airdos {
namespace {

class ReplayTest : public testing::Test {
 protected:
  ReplayTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = testing::TempDir() + "airdos_replay_" + info->name() + "/";
    std::filesystem::create_directories(folder_);
  }
  ~ReplayTest() override { std::filesystem::remove_all(folder_); }

  // Images of a session with calibrations now and then, and outputs of some run before.
  void WriteInputLog(const std::string& name, int num_frames, bool right_first = false) const {
    EventLogWriter log(folder_ + name);
    const auto add = [&log](const char* channel, int seq, const std::string& text) {
      const Envelope message = TextEnvelope(channel, seq, text);
      log.Append(5, channel, message.payload.data(), message.payload.size());
    };
    for (int seq = 0; seq < num_frames; ++seq) {
      if (seq % 4 == 0) add(channel::kCalibration, seq, "calibration");
      if (right_first) add(channel::kCameraRight, seq, "right");
      add(channel::kCameraLeft, seq, "left" + std::to_string(seq));
      if (!right_first) add(channel::kCameraRight, seq, "right");
      add(channel::kStateEstimate, seq, "of a run before");
      add("SOMETHING_ELSE", seq, "x");
    }
  }

  // A chain with the channels of the real one.
  static std::vector<ReplayNode> MakeNodes() {
    std::vector<ReplayNode> nodes;
    nodes.push_back(
        {std::make_unique<TextNode>(
             "frontend", std::vector<std::string>{channel::kCameraLeft, channel::kCameraRight},
             channel::kStaticFeatures, channel::kStateEstimate),
         {channel::kStaticFeatures}});
    nodes.push_back(
        {std::make_unique<TextNode>("optimizer", std::vector<std::string>{channel::kStaticFeatures},
                                    channel::kStateEstimate),
         {channel::kStateEstimate}});
    return nodes;
  }

  ReplayResult RunReplay(const std::string& in, const std::string& out, bool writes_inputs = false,
                         bool is_parallel = false) const {
    LogSource source(folder_ + in);
    ReplayOptions options;
    options.is_parallel = is_parallel;
    if (!out.empty()) options.out_path = folder_ + out;
    options.writes_inputs = writes_inputs;
    return Replay(&source, MakeNodes(), options);
  }
  std::string Bytes(const std::string& name) const {
    std::ifstream file(folder_ + name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }

  std::string folder_;
};

// What the chain says is known: two frames back the frontend hears the optimizer, by its length.
TEST_F(ReplayTest, TheOutputIsThisText) {
  WriteInputLog("in.lcm", 4);
  RunReplay("in.lcm", "out.lcm");
  EventLogReader reader(folder_ + "out.lcm");
  std::string text;
  while (const auto event = reader.Next()) {
    frame_done_t message;
    ASSERT_TRUE(Decode(event->payload.data(), event->payload.size(), &message));
    text += std::to_string(event->number) + " " + std::to_string(event->utime) + " " +
            event->channel + " " + std::to_string(message.session) + "." +
            std::to_string(message.seq) + " " + message.process + "\n";
  }
  EXPECT_EQ(text,
            "0 0 STATIC_FEATURES 7.0 frontend(left0,right,back -)\n"
            "1 0 STATE_ESTIMATE 7.0 optimizer(frontend(left0,right,back -),-,)\n"
            "2 1000 STATIC_FEATURES 7.1 frontend(left1,right,back -)\n"
            "3 1000 STATE_ESTIMATE 7.1 optimizer(frontend(left1,right,back -),-,)\n"
            "4 2000 STATIC_FEATURES 7.2 frontend(left2,right,back 42)\n"
            "5 2000 STATE_ESTIMATE 7.2 optimizer(frontend(left2,right,back 42),-,)\n"
            "6 3000 STATIC_FEATURES 7.3 frontend(left3,right,back 42)\n"
            "7 3000 STATE_ESTIMATE 7.3 optimizer(frontend(left3,right,back 42),-,)\n");
}

TEST_F(ReplayTest, TwiceGivesTheSameBytes) {
  WriteInputLog("in.lcm", 10);
  const ReplayResult first = RunReplay("in.lcm", "1.lcm");
  const ReplayResult second = RunReplay("in.lcm", "2.lcm");
  EXPECT_EQ(first.num_frames, 10);
  EXPECT_EQ(first.num_events, 20);
  EXPECT_EQ(Bytes("1.lcm"), Bytes("2.lcm"));
  EXPECT_EQ(first.log_sha256, second.log_sha256);
  EXPECT_EQ(first.remarks, std::vector<std::string>());
}

// They are inputs where a source has them.
TEST_F(ReplayTest, PeopleThatADetectorPublishesAreOutput) {
  WriteInputLog("in.lcm", 4);
  LogSource source(folder_ + "in.lcm");
  std::vector<ReplayNode> nodes;
  nodes.push_back(
      {std::make_unique<TextNode>("detector", std::vector<std::string>{channel::kCameraLeft},
                                  channel::kPersonKeypointsLeft),
       {channel::kPersonKeypointsLeft}});
  ReplayOptions options;
  options.out_path = folder_ + "out.lcm";
  const ReplayResult result = Replay(&source, nodes, options);
  EXPECT_EQ(result.num_events, 4);
  ASSERT_EQ(result.digests.count(channel::kPersonKeypointsLeft), 1u);
  EXPECT_EQ(result.digests.at(channel::kPersonKeypointsLeft).num_messages, 4);
}

TEST_F(ReplayTest, InParallelGivesTheSame) {
  WriteInputLog("in.lcm", 50);
  for (const bool writes_inputs : {false, true}) {
    const ReplayResult serial = RunReplay("in.lcm", "1.lcm", writes_inputs);
    const ReplayResult parallel = RunReplay("in.lcm", "2.lcm", writes_inputs, true);
    EXPECT_EQ(Bytes("1.lcm"), Bytes("2.lcm"));
    EXPECT_EQ(parallel.log_sha256, serial.log_sha256);
    EXPECT_EQ(parallel.num_events, serial.num_events);
    EXPECT_EQ(FormatDigests(parallel.digests), FormatDigests(serial.digests));
    EXPECT_EQ(parallel.remarks, serial.remarks);
    EXPECT_EQ(parallel.timing.at("frontend").cpu_ms.size(), 50u);
  }
}

/// Cannot be read to its end.
class BrokenSource : public LogSource {
 public:
  using LogSource::LogSource;
  std::vector<Envelope> NextFrame() override {
    if (++num_frames_ > 8) throw InputError("in.lcm: cannot be read");
    return LogSource::NextFrame();
  }

 private:
  int num_frames_ = 0;
};

TEST_F(ReplayTest, WhatCameBeforeABrokenSourceIsInTheLog) {
  WriteInputLog("in.lcm", 10);
  for (const bool is_parallel : {false, true}) {
    BrokenSource source(folder_ + "in.lcm");
    ReplayOptions options;
    options.out_path = folder_ + "out.lcm";
    options.is_parallel = is_parallel;
    EXPECT_THROW(Replay(&source, MakeNodes(), options), InputError);
    EXPECT_EQ(DigestLog(options.out_path).at(channel::kStateEstimate).num_messages, 8);
  }
}

TEST_F(ReplayTest, OutputLogHoldsOutputsOnlyWithTheFramesTime) {
  WriteInputLog("in.lcm", 10);
  RunReplay("in.lcm", "out.lcm");
  EventLogReader reader(folder_ + "out.lcm");
  std::int64_t number = 0;
  while (const auto event = reader.Next()) {
    EXPECT_TRUE(IsOutputChannel(event->channel)) << event->channel;
    EXPECT_EQ(event->number, number++);
    frame_done_t message;
    ASSERT_TRUE(Decode(event->payload.data(), event->payload.size(), &message));
    EXPECT_EQ(event->utime, message.utime);
    EXPECT_NE(message.process, "of a run before");
  }
  EXPECT_EQ(number, 20);
}

TEST_F(ReplayTest, ALogWithItsOwnOutputsReplaysToTheSame) {
  WriteInputLog("in.lcm", 10);
  const ReplayResult first = RunReplay("in.lcm", "all.lcm", true);
  EXPECT_GT(first.num_events, 40);
  const ReplayResult second = RunReplay("all.lcm", "out.lcm");
  RunReplay("in.lcm", "reference.lcm");
  EXPECT_EQ(Bytes("out.lcm"), Bytes("reference.lcm"));
}

TEST_F(ReplayTest, DigestsIgnoreHowChannelsInterleave) {
  WriteInputLog("in.lcm", 10);
  WriteInputLog("in2.lcm", 10, true);
  const ReplayResult first = RunReplay("in.lcm", "out.lcm");
  EXPECT_EQ(first.digests.size(), 2u);
  EXPECT_EQ(FormatDigests(first.digests), FormatDigests(RunReplay("in2.lcm", "").digests));
  EXPECT_EQ(FormatDigests(first.digests), FormatDigests(DigestLog(folder_ + "out.lcm")));
}

TEST_F(ReplayTest, DigestsSeeAChangedByteAndAMissingMessage) {
  WriteInputLog("in.lcm", 10);
  const auto reference = RunReplay("in.lcm", "out.lcm").digests;
  EventLogReader reader(folder_ + "out.lcm");
  ChannelDigests changed;
  ChannelDigests shorter;
  bool is_first = true;
  while (auto event = reader.Next()) {
    if (!is_first) shorter.Add(event->channel, event->payload.data(), event->payload.size());
    if (is_first) event->payload.back() ^= 1;
    is_first = false;
    changed.Add(event->channel, event->payload.data(), event->payload.size());
  }
  const std::string first_channel = channel::kStaticFeatures;
  EXPECT_NE(changed.Result()[first_channel].sha256, reference.at(first_channel).sha256);
  EXPECT_NE(shorter.Result()[first_channel].sha256, reference.at(first_channel).sha256);
  EXPECT_EQ(changed.Result()[channel::kStateEstimate].sha256,
            reference.at(channel::kStateEstimate).sha256);
}

TEST_F(ReplayTest, LogDigestIsThatOfSha256sum) {
  WriteInputLog("in.lcm", 3);
  const ReplayResult result = RunReplay("in.lcm", "out.lcm");
  std::FILE* pipe = popen(("sha256sum " + folder_ + "out.lcm").c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  char text[65] = {};
  EXPECT_EQ(std::fread(text, 1, 64, pipe), 64u);
  pclose(pipe);
  EXPECT_EQ(result.log_sha256, text);
}

TEST_F(ReplayTest, FrameRangeKeepsTheCalibrationFromBefore) {
  WriteInputLog("in.lcm", 10);
  LogSource source(folder_ + "in.lcm", 2, 3);
  std::vector<std::string> channels;
  for (auto frame = source.NextFrame(); !frame.empty(); frame = source.NextFrame()) {
    for (const Envelope& message : frame) {
      channels.push_back(
          message.channel +
          std::to_string(PeekHeader(message.payload.data(), message.payload.size()).value().seq));
    }
  }
  EXPECT_EQ(channels, (std::vector<std::string>{"CALIBRATION0", "CAMERA_LEFT2", "CAMERA_RIGHT2",
                                                "CAMERA_LEFT3", "CAMERA_RIGHT3"}));
}

TEST_F(ReplayTest, IncompleteEndAndDamageAreSaid) {
  WriteInputLog("in.lcm", 10);
  std::string bytes = Bytes("in.lcm");
  const std::size_t right = bytes.rfind(channel::kCameraRight);
  bytes[right - 28] = 0;  // its sync word
  std::ofstream(folder_ + "in.lcm", std::ios::binary) << bytes;
  const ReplayResult result = RunReplay("in.lcm", "");
  EXPECT_EQ(result.num_frames, 10);
  EXPECT_EQ(result.digests.at(channel::kStateEstimate).num_messages, 10);
  const std::string text = FormatSummary(result);
  EXPECT_NE(text.find("in.lcm: 1 events lost to damage"), std::string::npos) << text;
  EXPECT_NE(text.find("frontend: 1 frames incomplete"), std::string::npos) << text;
  EXPECT_NE(text.find("frontend: CAMERA_RIGHT: 1 missing"), std::string::npos) << text;
}

/// Says for each frame what its input does not take.
class BabblingNode : public TextNode {
 public:
  using TextNode::TextNode;

 protected:
  void ProcessFrame(const Header& header, TextInputs) override {
    Publish(channel::kStaticFeatures, TextMessage(header.seq, "", header.session));
  }
};

TEST_F(ReplayTest, RejectedMessagesAreSaid) {
  WriteInputLog("in.lcm", 10);
  LogSource source(folder_ + "in.lcm");
  std::vector<ReplayNode> nodes = MakeNodes();
  nodes.front().node = std::make_unique<BabblingNode>(
      "frontend", std::vector<std::string>{channel::kCameraLeft, channel::kCameraRight},
      channel::kStaticFeatures);
  const ReplayResult result = Replay(&source, nodes, {});
  EXPECT_EQ(result.remarks,
            (std::vector<std::string>{"optimizer: STATIC_FEATURES: 10 rejected, the last because: "
                                      "process 0 letters: it must have a name"}));
}

TEST_F(ReplayTest, TimingHasEveryFrameOfEveryNode) {
  WriteInputLog("in.lcm", 10);
  const ReplayResult result = RunReplay("in.lcm", "");
  ASSERT_EQ(result.timing.size(), 2u);
  EXPECT_EQ(result.timing.at("frontend").wall_ms.size(), 10u);
  EXPECT_EQ(result.timing.at("optimizer").cpu_ms.size(), 10u);
  WriteTiming(result, folder_ + "timing.json");
  EXPECT_NE(Bytes("timing.json").find("\"frontend\""), std::string::npos);
  EXPECT_THROW(WriteTiming(result, "/nonexistent/timing.json"), InputError);
}

}  // namespace
}  // namespace airdos
