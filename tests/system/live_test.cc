#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "airdos/frame_done_t.hpp"
#include "processes/node/log/event_log.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/tools/replay/replay.h"
#include "tests/support/child_process.h"
#include "tests/support/private_network.h"

// The real programs as real processes, in a network namespace of their own: what they say over LCM
// must be what airdos-replay computes, and none of them may take the others down.

namespace airdos {
namespace {

constexpr double kStartDeadline_s = 30;
constexpr double kRunDeadline_s = 240;

std::string Program(const std::string& name) {
  return std::string(AIRDOS_BINARY_DIR) + "/bin/" + name;
}

std::string Bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

class LiveTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(std::filesystem::exists(log_)) << log_ << " is missing";
    const std::string obstacle = EnterPrivateNetwork(true);
    if (!obstacle.empty()) GTEST_SKIP() << obstacle;
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    for (char& c : name) c = c == '/' ? '_' : c;
    folder_ = testing::TempDir() + "airdos_live_" + name + "/";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    LogSource source(log_);
    while (true) {
      const std::vector<Envelope> frame = source.NextFrame();
      if (frame.empty()) break;
      last_ = PeekHeader(frame.back().payload.data(), frame.back().payload.size()).value();
      ++num_frames_;
    }
  }
  void TearDown() override {
    processes_.clear();
    // What the processes said is kept where a test failed.
    if (!folder_.empty() && !HasFailure()) std::filesystem::remove_all(folder_);
  }

  ChildProcess* Start(const std::string& program, const std::vector<std::string>& arguments) {
    std::vector<std::string> command{program.find("lcm-") == 0 ? program : Program(program)};
    command.insert(command.end(), arguments.begin(), arguments.end());
    processes_[program] = std::make_unique<ChildProcess>(command, folder_ + program);
    return processes_[program].get();
  }
  ChildProcess* StartNode(const std::string& program, const std::string& deadline_s) {
    std::vector<std::string> arguments{"--pace", "lockstep", "--deadline-s", deadline_s};
    if (program == "airdos-map-recorder") {
      arguments.push_back("--set");
      arguments.push_back("output.directory=" + folder_ + "map");
    }
    return Start(program, arguments);
  }
  static const std::vector<std::string>& NodePrograms() {
    static const std::vector<std::string> programs{"airdos-frontend", "airdos-human-tracker",
                                                   "airdos-optimizer", "airdos-map-recorder"};
    return programs;
  }

  // All nodes and the recorder, READY.
  void StartAll(const std::string& deadline_s) {
    for (const std::string& program : NodePrograms()) StartNode(program, deadline_s);
    Start("airdos-record", {"--out", recorded_log()});
    for (const auto& [program, process] : processes_) {
      const ChildProcess* started = process.get();
      ASSERT_TRUE(WaitUntil([&] { return started->HasSaid(" READY "); }, kStartDeadline_s))
          << program << ": " << started->Errors();
    }
  }
  void StopAll() {
    for (const auto& [program, process] : processes_) {
      process->Signal(SIGINT);
      EXPECT_EQ(process->Wait(kStartDeadline_s), 0) << program << ": " << process->Errors();
    }
  }
  std::string recorded_log() const { return folder_ + "recorded.lcm"; }

  // Messages of each channel that were recorded up to now, without a copy of the payloads.
  template <class Visit>
  void VisitRecorded(Visit visit) const {
    if (!std::filesystem::exists(recorded_log()) || std::filesystem::file_size(recorded_log()) == 0)
      return;
    EventLogReader reader(recorded_log());
    while (const auto event = reader.Next()) visit(*event);
  }
  std::int64_t NumRecorded(const std::string& channel) const {
    std::int64_t count = 0;
    VisitRecorded([&](const LogEvent& event) { count += event.channel == channel ? 1 : 0; });
    return count;
  }
  std::int64_t NumFramesDoneBy(const std::string& process) const {
    std::int64_t count = 0;
    VisitRecorded([&](const LogEvent& event) {
      frame_done_t done;
      if (event.channel != channel::kFrameDone) return;
      if (!Decode(event.payload.data(), event.payload.size(), &done)) return;
      count += done.process == process ? 1 : 0;
    });
    return count;
  }
  bool IsLastFrameDoneBy(const std::string& process) const {
    bool is_done = false;
    VisitRecorded([&](const LogEvent& event) {
      frame_done_t done;
      if (event.channel != channel::kFrameDone) return;
      if (!Decode(event.payload.data(), event.payload.size(), &done)) return;
      is_done |= done.process == process && done.session == last_.session && done.seq == last_.seq;
    });
    return is_done;
  }
  void WaitForLastFrame() {
    EXPECT_TRUE(
        WaitUntil([this] { return IsLastFrameDoneBy("airdos-map-recorder"); }, kRunDeadline_s))
        << "STATE_ESTIMATE: " << NumRecorded(channel::kStateEstimate) << " of " << num_frames_
        << "\n"
        << processes_["airdos-optimizer"]->Errors();
  }

  // What airdos-replay makes of the log.
  void RunReplay(const std::string& out, const std::string& threads = "auto") {
    ChildProcess* replay =
        Start("airdos-replay", {log_, "--out", folder_ + out, "--run-dir", folder_ + "map_" + out,
                                "--no-progress", "--threads", threads});
    ASSERT_EQ(replay->Wait(kRunDeadline_s), 0) << replay->Errors();
    processes_.erase("airdos-replay");
  }
  void ExpectRecordedEqualsReplayed() {
    RunReplay("replayed.lcm");
    const auto replayed = DigestLog(folder_ + "replayed.lcm");
    EXPECT_EQ(replayed.size(), 4u);
    EXPECT_EQ(replayed.at(channel::kStateEstimate).num_messages, num_frames_);
    EXPECT_EQ(FormatDigests(DigestLog(recorded_log())), FormatDigests(replayed));
  }

  const std::string log_ = std::string(AIRDOS_SOURCE_DIR) + "/logs/road_crossing06.lcm";
  std::string folder_;
  Header last_;
  std::int64_t num_frames_ = 0;
  std::map<std::string, std::unique_ptr<ChildProcess>> processes_;
};

TEST_F(LiveTest, ReplayTwiceGivesTheSameBytesInOneThreadAndInSeveral) {
  RunReplay("1.lcm", "1");
  RunReplay("2.lcm", "auto");
  for (const std::string name : {"1.lcm", "map_1.lcm/map.airdos"}) {
    std::string other = name;
    other.replace(other.find('1'), 1, "2");
    const std::string first = Bytes(folder_ + name);
    EXPECT_FALSE(first.empty());
    EXPECT_TRUE(first == Bytes(folder_ + other)) << name;
  }
  // And both have what the log asks for: one message for each of its frames, in their order.
  for (const char* channel :
       {channel::kStaticFeatures, channel::kHumanObservations, channel::kStateEstimate}) {
    EXPECT_EQ(DigestLog(folder_ + "2.lcm").at(channel).num_messages, num_frames_) << channel;
  }
  EventLogReader reader(folder_ + "2.lcm");
  std::int64_t num_estimates = 0;
  while (const auto event = reader.Next()) {
    if (event->channel != channel::kStateEstimate) continue;
    const Header header = *PeekHeader(event->payload.data(), event->payload.size());
    EXPECT_EQ(header.seq, last_.seq - num_frames_ + ++num_estimates);
    EXPECT_EQ(header.session, last_.session);
  }
}

TEST_F(LiveTest, ProcessesFedByLogplayerSayWhatReplayComputes) {
  ASSERT_NO_FATAL_FAILURE(StartAll("120"));
  ChildProcess* player = Start("lcm-logplayer", {"-s", "1", log_});
  EXPECT_EQ(player->Wait(kRunDeadline_s), 0) << player->Errors();
  WaitForLastFrame();
  StopAll();
  ExpectRecordedEqualsReplayed();
}

TEST_F(LiveTest, ProcessesFedInLockstepSayWhatReplayComputes) {
  ASSERT_NO_FATAL_FAILURE(StartAll("120"));
  ChildProcess* player = Start("airdos-stereo-player", {"--data", log_, "--pace", "lockstep"});
  EXPECT_EQ(player->Wait(kRunDeadline_s), 0) << player->Errors();
  WaitForLastFrame();
  StopAll();
  ExpectRecordedEqualsReplayed();
}

class KilledProcessTest : public LiveTest, public testing::WithParamInterface<const char*> {};

// One process is killed in the middle and started again: the others go on, somebody says what is
// missing, and the new one takes part. The player goes on for as long as that takes, and not faster
// than the processes, so neither depends on how fast they are.
TEST_P(KilledProcessTest, OthersGoOnAndSayWhatTheyMiss) {
  const std::string victim = GetParam();
  const std::map<std::string, std::string> products{
      {"airdos-frontend", channel::kStaticFeatures},
      {"airdos-human-tracker", channel::kHumanObservations},
      {"airdos-optimizer", channel::kMapUpdate}};  // which the frontend waits for
  const auto product = products.find(victim);
  const auto num_of_victim = [&] {
    return product == products.end() ? NumFramesDoneBy(victim) : NumRecorded(product->second);
  };
  ASSERT_NO_FATAL_FAILURE(StartAll("2"));
  ChildProcess* player =
      Start("airdos-stereo-player",
            {"--data", log_, "--pace", "lockstep", "--no-check", "--loop", "100", "--one-session"});
  ASSERT_TRUE(WaitUntil([&] { return NumRecorded(channel::kStateEstimate) >= 5; }, kRunDeadline_s))
      << player->Errors();

  processes_[victim]->Signal(SIGKILL);
  EXPECT_EQ(processes_[victim]->Wait(kStartDeadline_s), -SIGKILL);
  const auto somebody_misses_it = [&] {
    for (const auto& [program, process] : processes_) {
      const bool hears_it = product != products.end();
      if (hears_it && process->HasSaid("nothing on " + product->second)) return true;
    }
    return player->HasSaid("waiting for " + victim + " to finish a frame");
  };
  EXPECT_TRUE(WaitUntil(somebody_misses_it, kRunDeadline_s));
  StartNode(victim, "2");
  ASSERT_TRUE(WaitUntil([&] { return processes_[victim]->HasSaid(" READY "); }, kStartDeadline_s));
  const std::int64_t num_before = num_of_victim();
  EXPECT_TRUE(WaitUntil([&] { return num_of_victim() >= num_before + 5; }, kRunDeadline_s))
      << player->Errors();
  const std::int64_t num_estimates = NumRecorded(channel::kStateEstimate);
  EXPECT_TRUE(WaitUntil([&] { return NumRecorded(channel::kStateEstimate) >= num_estimates + 5; },
                        kRunDeadline_s))
      << player->Errors();
  player->Signal(SIGINT);
  EXPECT_EQ(player->Wait(kStartDeadline_s), 0) << player->Errors();
  processes_.erase("airdos-stereo-player");
  StopAll();
}

INSTANTIATE_TEST_SUITE_P(EachProcess, KilledProcessTest,
                         testing::Values("airdos-frontend", "airdos-human-tracker",
                                         "airdos-optimizer", "airdos-map-recorder"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace airdos
