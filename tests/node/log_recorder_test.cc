#include "processes/node/live/log_recorder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "common/util/error.h"
#include "processes/node/message/channels.h"
#include "tests/node/fake_nodes.h"

namespace airdos {
namespace {

class LogRecorderTest : public testing::Test {
 protected:
  LogRecorderTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    options_.path = testing::TempDir() + "airdos_log_recorder_" + info->name() + ".lcm";
    options_.replaces_file = true;
  }
  ~LogRecorderTest() override { std::filesystem::remove(options_.path); }

  static void Take(const Envelope& message, LogRecorder* recorder) {
    recorder->Take(message.channel, message.payload.data(), message.payload.size(), 42);
  }
  static void TakeSeqs(const char* channel, const std::vector<std::int64_t>& seqs,
                       std::int64_t session, LogRecorder* recorder) {
    for (const std::int64_t seq : seqs) Take(TextEnvelope(channel, seq, "x", session), recorder);
  }

  LogRecorderOptions options_;
};

TEST_F(LogRecorderTest, WritesWhatArrivesAsItArrives) {
  {
    LogRecorder recorder(options_);
    Take(TextEnvelope(channel::kCameraLeft, 3, "left"), &recorder);
    Take({"ANYTHING", {1, 2, 3}}, &recorder);  // of other people: not even a header
    recorder.Sync();
    EXPECT_EQ(recorder.num_events(), 2);
  }
  EventLogReader reader(options_.path);
  const auto first = reader.Next();
  const auto second = reader.Next();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->number, 0);
  EXPECT_EQ(first->utime, 42);
  EXPECT_EQ(first->channel, channel::kCameraLeft);
  EXPECT_EQ(first->payload, TextEnvelope(channel::kCameraLeft, 3, "left").payload);
  EXPECT_EQ(second->number, 1);
  EXPECT_EQ(second->payload, (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_FALSE(reader.Next());
}

TEST_F(LogRecorderTest, InputsOnlyLeavesOutWhatProcessesMade) {
  options_.inputs_only = true;
  {
    LogRecorder recorder(options_);
    for (const char* name : {channel::kCameraLeft, channel::kStateEstimate, channel::kCalibration,
                             channel::kStatus, channel::kFrameDone, channel::kGroundTruth}) {
      Take(TextEnvelope(name, 0, "x"), &recorder);
    }
    Take({"ANYTHING", {1, 2, 3}}, &recorder);
  }
  EventLogReader reader(options_.path);
  std::vector<std::string> names;
  while (const auto event = reader.Next()) names.push_back(event->channel);
  EXPECT_EQ(names, (std::vector<std::string>{channel::kCameraLeft, channel::kCalibration,
                                             channel::kGroundTruth}));
}

TEST_F(LogRecorderTest, GapsAreThoseOfTheImageNumberWithinASession) {
  LogRecorder recorder(options_);
  TakeSeqs(channel::kCameraLeft, {5, 6, 9, 10}, 7, &recorder);  // the first may have any number
  TakeSeqs(channel::kStateEstimate, {0, 2}, 7, &recorder);
  EXPECT_EQ(recorder.channels().at(channel::kCameraLeft).num_missing, 2);
  EXPECT_EQ(recorder.channels().at(channel::kStateEstimate).num_missing, 1);
  TakeSeqs(channel::kCameraLeft, {0, 1, 3}, 8, &recorder);
  EXPECT_EQ(recorder.channels().at(channel::kCameraLeft).num_missing, 3);
  EXPECT_EQ(recorder.channels().at(channel::kCameraLeft).num_received, 7);
}

TEST_F(LogRecorderTest, RepeatedAndLateMessagesAreNoGaps) {
  LogRecorder recorder(options_);
  TakeSeqs(channel::kMapUpdate, {0, 0, 1, 1, 0, 2}, 7, &recorder);  // parts, and a late one
  EXPECT_EQ(recorder.channels().at(channel::kMapUpdate).num_missing, 0);
  EXPECT_EQ(recorder.channels().at(channel::kMapUpdate).num_received, 6);
}

TEST_F(LogRecorderTest, ChannelsThatDoNotCarryEveryImageHaveNoGaps) {
  LogRecorder recorder(options_);
  TakeSeqs(channel::kCalibration, {0, 10, 20}, 7, &recorder);
  TakeSeqs(channel::kStatus, {0, 5}, 7, &recorder);
  TakeSeqs("ANYTHING", {0, 5}, 7, &recorder);
  for (const auto& [name, counters] : recorder.channels())
    EXPECT_EQ(counters.num_missing, 0) << name;
}

TEST_F(LogRecorderTest, HostileNumbersAreRecordedAndNoGaps) {
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  LogRecorder recorder(options_);
  TakeSeqs(channel::kCameraLeft, {kMin, kMax, 1}, 7, &recorder);
  TakeSeqs(channel::kCameraRight, {0, kMax / 2, kMax, 1, 3}, 7, &recorder);
  EXPECT_EQ(recorder.num_events(), 8);
  EXPECT_EQ(recorder.channels().at(channel::kCameraLeft).num_missing, 0);
  EXPECT_EQ(recorder.channels().at(channel::kCameraRight).num_missing, 1) << "2";
}

TEST_F(LogRecorderTest, OnlyWhatIsWantedIsTaken) {
  options_.channels = "CAMERA_.*|STATUS";
  LogRecorder recorder(options_);
  TakeSeqs(channel::kCameraLeft, {0}, 7, &recorder);
  TakeSeqs("MY_CAMERA_LEFT", {0}, 7, &recorder);  // the expression is of the whole name
  TakeSeqs("LCM_SELF_TEST", {0}, 7, &recorder);
  EXPECT_EQ(recorder.num_events(), 1);
  EXPECT_EQ(recorder.channels().size(), 1u);
}

TEST_F(LogRecorderTest, TheSummaryHasEveryChannelAndWhatIsMissing) {
  LogRecorder recorder(options_);
  TakeSeqs(channel::kCameraLeft, {0, 1, 4}, 7, &recorder);
  TakeSeqs(channel::kStatus, {0}, 7, &recorder);
  Take({"a name\x7fthat no log can hold", {1}}, &recorder);
  const std::string text = recorder.Summary();
  const auto line_of = [&text](const std::string& start) {
    const std::size_t begin = text.find(start);
    return begin == std::string::npos ? "" : text.substr(begin, text.find('\n', begin) - begin);
  };
  EXPECT_EQ(line_of("CAMERA_LEFT"), "CAMERA_LEFT                    3 messages, 2 missing");
  EXPECT_EQ(line_of("STATUS"), "STATUS                         1 messages");
  EXPECT_NE(text.find("\n1 messages that no log can hold were left out\n"), std::string::npos)
      << text;
  EXPECT_EQ(line_of(options_.path).find(options_.path + ": 4 events, "), 0u) << text;
}

TEST_F(LogRecorderTest, BadArgumentsAreNamed) {
  options_.channels = "(";
  EXPECT_THROW(LogRecorder{options_}, InputError);
  options_.channels = ".*";
  options_.replaces_file = false;
  std::ofstream(options_.path) << "of somebody";
  EXPECT_THROW(LogRecorder{options_}, InputError);
  EXPECT_EQ(std::filesystem::file_size(options_.path), 11u) << "it must be left alone";
}

// STATUS has room for a hundred, and whoever invents names must not take all memory.
TEST_F(LogRecorderTest, ChannelsBeyondTheBoundAreCountedTogether) {
  LogRecorder recorder(options_);
  for (int i = 0; i < 500; ++i) Take({"CHANNEL_" + std::to_string(i), {1}}, &recorder);
  TakeSeqs(channel::kCameraLeft, {1, 3}, 7, &recorder);
  EXPECT_EQ(recorder.channels().size(), 92u);
  EXPECT_EQ(recorder.channels().at(LogRecorder::kOtherChannels).num_received, 410);
  EXPECT_EQ(recorder.channels().at(channel::kCameraLeft).num_missing, 1);
  EXPECT_EQ(recorder.num_events(), 502) << "recorded they are all the same";
}

}  // namespace
}  // namespace airdos
