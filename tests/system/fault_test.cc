#include <sched.h>
#include <sys/mount.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ostream>
#include <random>

#include "common/map/four_d_map.h"
#include "processes/node/message/channels.h"
#include "tests/support/fault_fixture.h"

// What happens to a run when processes are killed, the disk is full, the machine is too slow or the
// network is not there. Each test says what is lost. Rounds of each kill: 2, or
// AIRDOS_FAULT_ROUNDS.

namespace airdos {
namespace {

int NumRounds() {
  const char* const rounds = std::getenv("AIRDOS_FAULT_ROUNDS");
  return rounds == nullptr ? 2 : std::max(1, std::atoi(rounds));
}

// In lock-step the player keeps this many frames on their way.
constexpr std::int64_t kInFlight = 4;

class KillTest : public FaultTest, public testing::WithParamInterface<const char*> {
 protected:
  static constexpr std::int64_t kLast = 24;

  /// Kills the program when so many estimates were heard, and starts it again.
  void KillAndRestart(const std::string& program, std::size_t num_estimates) {
    ASSERT_TRUE(listener_->HearUntil([&] { return listener_->states().size() >= num_estimates; },
                                     LiveChain::kRun_s))
        << chain_->AllErrors();
    chain_->process(program)->Signal(SIGKILL);
    EXPECT_EQ(chain_->process(program)->Wait(LiveChain::kStart_s), -SIGKILL);
    if (std::filesystem::exists(chain_->map_path())) {
      std::filesystem::copy(chain_->map_path(), folder_ + "at_the_kill.airdos");
    }
    if (program != "airdos-stereo-player") {
      ASSERT_NO_FATAL_FAILURE(chain_->StartNode(program));
      return;
    }
    listener_->Hear();
    const std::string next = std::to_string(listener_->newest_image() + 1);
    chain_->StartPlayer(folder_ + "input.lcm", {"--first", next});
  }

  /// What was on the disk at the kill can be read, up to the last complete chunk.
  void ExpectReadableAtTheKill(std::size_t num_estimates) {
    if (!std::filesystem::exists(folder_ + "at_the_kill.airdos")) return;
    MapFileSummary summary;
    const FourDMap map = ReadFourDMap(folder_ + "at_the_kill.airdos", &summary);
    constexpr std::size_t kChunkFrames = 10;
    EXPECT_GE(map.frames.size() + kChunkFrames + kInFlight, num_estimates);
    EXPECT_FALSE(map.is_closed);
  }

  /// The map at the end is one map, closed, with most frames.
  void ExpectOneMap(std::size_t num_frames) {
    MapFileSummary summary;
    const FourDMap map = ReadFourDMap(chain_->map_path(), &summary);
    EXPECT_TRUE(map.is_closed);
    EXPECT_EQ(summary.drop_reason, "");
    const auto num_posed =
        std::count_if(map.frames.begin(), map.frames.end(),
                      [](const auto& frame) { return frame.second.best().has_value(); });
    EXPECT_GE(static_cast<std::size_t>(num_posed), num_frames);
    EXPECT_FALSE(std::filesystem::exists(chain_->map_path() + ".unfinished_1"));
  }
};

// Killed with -9 at a random frame, and started again.
// Lost: what was on its way to the process, at most the frames in flight, and what it remembered:
//   stereo_player: nothing else; it goes on with the next image.
//   frontend: its landmarks. It starts new ones under numbers that were never used; the optimizer
//     carries the camera over the gap with the motion before and with people.
//   human_tracker: who is who: people get new numbers.
//   optimizer: the window. It goes on where the frontend knows W to be.
//   map_recorder: live poses of the chunk that was open (10 frames) and of the gap; it goes on in
//     the same file.
// Not lost: W, the map written so far, the run.
TEST_P(KillTest, TheRunGoesOnInTheSameWorld) {
  const std::string victim = GetParam();
  std::mt19937_64 random(11);
  for (int round = 0; round < NumRounds(); ++round) {
    const std::size_t at = 6 + random() % 9;
    SCOPED_TRACE("round " + std::to_string(round) + ", killed after " + std::to_string(at));
    StartAfresh();
    chain_->SetNodeArguments({"--deadline-s", "3"});
    ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
    chain_->StartPlayer(Write(SampleEvents(0, kLast)));
    ASSERT_NO_FATAL_FAILURE(KillAndRestart(victim, at));
    HearTheEnd(kLast);
    StopAndHear();

    const auto num_estimates = static_cast<std::int64_t>(listener_->states().size());
    std::printf("%s, killed after %d: %d estimates of %d, worst error %.3f m, last %.3f m\n",
                victim.c_str(), static_cast<int>(at), static_cast<int>(num_estimates),
                static_cast<int>(kLast + 1), WorstError_m(0, kLast), Error_m(kLast));
    const std::int64_t num_lost = victim == "airdos-optimizer" ? 2 * kInFlight : 0;
    EXPECT_GE(num_estimates, kLast + 1 - num_lost);
    EXPECT_LT(Error_m(kLast), victim == "airdos-frontend" ? 0.5 : 0.1);
    ExpectReadableAtTheKill(at);
    const bool is_recorder = victim == "airdos-map-recorder";
    ExpectOneMap(static_cast<std::size_t>(num_estimates - (is_recorder ? 10 + 2 * kInFlight : 0)));
    if (HasFailure()) return;
  }
}
INSTANTIATE_TEST_SUITE_P(EachProcess, KillTest,
                         testing::Values("airdos-stereo-player", "airdos-frontend",
                                         "airdos-human-tracker", "airdos-optimizer",
                                         "airdos-map-recorder"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// A disk of so many kB in `folder`, for this process and its children. Why not, or empty.
std::string MountSmallDisk(const std::string& folder, int size_kb) {
  const std::string size = "size=" + std::to_string(size_kb) + "k";
  if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      mount("tmpfs", folder.c_str(), "tmpfs", 0, size.c_str()) != 0) {
    return std::string("a disk of its own needs root or user namespaces: ") + std::strerror(errno);
  }
  return "";
}

// The disk is full. Lost: what the recorder would have written from there on. It says so when
// it happens, and once more when it ends, with exit code 2; the others do not notice; what was
// written is readable.
TEST_F(FaultTest, AFullDiskEndsTheRecordingAndNothingElse) {
  constexpr std::int64_t kLast = 19;
  std::filesystem::create_directories(folder_ + "map");
  const std::string obstacle = MountSmallDisk(folder_ + "map", 68);  // 4 kB: the folder's list
  if (!obstacle.empty()) GTEST_SKIP() << obstacle;
  chain_->SetNodeArguments({"--deadline-s", "200"});
  for (const std::string& program : LiveChain::NodePrograms()) {
    const bool is_recorder = program == "airdos-map-recorder";
    ASSERT_NO_FATAL_FAILURE(chain_->StartNode(
        program, is_recorder ? std::vector<std::string>{"--set", "output.chunk_frames=2"}
                             : std::vector<std::string>{}));
  }
  chain_->StartPlayer(Write(SampleEvents(0, kLast)));
  HearTheEnd(kLast);
  EXPECT_EQ(listener_->states().size(), static_cast<std::size_t>(kLast + 1));
  ChildProcess* recorder = chain_->process("airdos-map-recorder");
  recorder->Signal(SIGINT);
  EXPECT_EQ(recorder->Wait(LiveChain::kStart_s), 2);
  const std::string errors = recorder->Errors();
  const std::string line = "map.airdos: cannot be written: No space left on device";
  EXPECT_NE(errors.find(line), std::string::npos) << errors;
  MapFileSummary summary;
  const FourDMap map = ReadFourDMap(chain_->map_path(), &summary);
  EXPECT_GE(map.frames.size(), 2u);
  EXPECT_LT(map.frames.size(), static_cast<std::size_t>(kLast + 1));
  EXPECT_FALSE(map.is_closed);
  std::filesystem::remove_all(folder_ + "map/people");
  umount2((folder_ + "map").c_str(), MNT_DETACH);
}

// Images come ten times as fast as recorded, in realtime pace: the machine is too slow for them.
// Lost: the frames that are skipped, each of them counted. Not lost: the newest one; nothing piles
// up, so latency and memory are those of a few frames.
TEST_F(FaultTest, ASlowChainSkipsAndCountsAndKeepsUp) {
  constexpr std::int64_t kLast = 39;
  chain_->SetNodeArguments({"--pace", "realtime", "--deadline-s", "1"});
  ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
  chain_->StartPlayer(Write(SampleEvents(0, kLast)), {"--pace", "realtime", "--speed", "10"});
  HearTheEnd(kLast);
  StopAndHear();
  std::int64_t num_skipped = 0;
  for (const std::string& program : LiveChain::NodePrograms()) {
    const process_status_t& status = listener_->statuses().at(program);
    num_skipped += status.num_frames_skipped;
    EXPECT_LT(status.memory_mb, 500) << program;
    EXPECT_EQ(status.waiting_for, "") << program << " still has frames to do";
  }
  EXPECT_GT(num_skipped, 0);
  // Each image was worked on by the frontend, or skipped, or (before it) never complete.
  const process_status_t& frontend = listener_->statuses().at("airdos-frontend");
  EXPECT_EQ(frontend.num_frames_done + frontend.num_frames_skipped, kLast + 1);
  EXPECT_GT(listener_->states().count({kSession, kLast}), 0u) << "the newest image has its pose";
}

struct SlowOptimizer {
  std::string name;
  std::vector<std::string> frontend_arguments;
  std::string who_skips;
};

/// What ctest shows.
[[maybe_unused]] void PrintTo(const SlowOptimizer& slow, std::ostream* stream) {
  *stream << slow.name;
}

class SlowOptimizerTest : public FaultTest, public testing::WithParamInterface<SlowOptimizer> {};

// The optimizer alone is too slow for the camera (10 Hz, realtime pace): it is told to iterate far
// beyond need. The frontend needs its answer of two frames ago, and so skips with it; without that
// feedback the optimizer skips alone. Lost: the skipped frames, each of them counted. Not lost: the
// newest one; few frames wait in the chain, so latency and memory are those of a few.
TEST_P(SlowOptimizerTest, FramesAreSkippedAndFewWait) {
  constexpr std::int64_t kLast = 39;
  chain_->SetNodeArguments({"--pace", "realtime", "--deadline-s", "20"});
  for (const std::string& program : LiveChain::NodePrograms()) {
    std::vector<std::string> arguments;
    if (program == "airdos-frontend") arguments = GetParam().frontend_arguments;
    if (program == "airdos-optimizer")
      arguments = {"--set", "solver.method=ceres",
                   "--set", "solver.max_iterations=200",
                   "--set", "solver.function_tolerance=1e-16"};
    ASSERT_NO_FATAL_FAILURE(chain_->StartNode(program, arguments));
  }
  chain_->StartPlayer(Write(SampleEvents(0, kLast)), {"--pace", "realtime"});
  HearTheEnd(kLast);
  StopAndHear();
  for (const std::string& program : LiveChain::NodePrograms()) {
    const process_status_t& status = listener_->statuses().at(program);
    EXPECT_EQ(status.waiting_for, "") << program << " still has frames to do";
    EXPECT_LT(status.memory_mb, 500) << program;
    std::printf("%s: %d frames, %d skipped, p50 %.0f ms\n", program.c_str(),
                static_cast<int>(status.num_frames_done),
                static_cast<int>(status.num_frames_skipped), status.latency_p50_ms);
  }
  EXPECT_GT(listener_->statuses().at(GetParam().who_skips).num_frames_skipped, 0);
  const process_status_t& frontend = listener_->statuses().at("airdos-frontend");
  EXPECT_EQ(frontend.num_frames_done + frontend.num_frames_skipped, kLast + 1);
  EXPECT_GT(listener_->states().count({kSession, kLast}), 0u) << "the newest image has its pose";
  std::printf("most estimates behind: %d\n", static_cast<int>(listener_->max_estimates_behind()));
  EXPECT_LE(listener_->max_estimates_behind(), 4u);
}
INSTANTIATE_TEST_SUITE_P(Feedback, SlowOptimizerTest,
                         testing::Values(SlowOptimizer{"WithLag", {}, "airdos-frontend"},
                                         SlowOptimizer{"Without",
                                                       {"--set", "feedback.lag_frames=0"},
                                                       "airdos-optimizer"}),
                         [](const auto& instance) { return instance.param.name; });

// The whole machine stands still for longer than the deadline. Lost: nothing, byte for byte: nobody
// is taken for silent who could not speak.
TEST_F(FaultTest, NothingIsLostWhileEverybodyStandsStill) {
  constexpr std::int64_t kLast = 19;
  constexpr double kDeadline_s = 2;
  chain_->SetNodeArguments({"--deadline-s", std::to_string(kDeadline_s)});
  const std::string log = Write(SampleEvents(0, kLast));
  ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
  chain_->StartPlayer(log);
  for (const std::size_t num_estimates : {5, 10}) {
    ASSERT_TRUE(listener_->HearUntil([&] { return listener_->states().size() >= num_estimates; },
                                     LiveChain::kRun_s))
        << chain_->AllErrors();
    std::vector<std::string> programs = LiveChain::NodePrograms();
    programs.push_back("airdos-stereo-player");
    for (const std::string& program : programs) chain_->process(program)->Signal(SIGSTOP);
    listener_->HearUntil([] { return false; }, 1.5 * kDeadline_s);
    for (const std::string& program : programs) chain_->process(program)->Signal(SIGCONT);
  }
  HearTheEnd(kLast);
  StopAndHear();

  EXPECT_EQ(listener_->digests(), ReplayDigests(log, folder_));
  for (const auto& [process, status] : listener_->statuses()) {
    EXPECT_EQ(status.num_frames_incomplete, 0) << process << " " << status.waiting_for;
  }
}

// Two runs on one machine, on two ports. Lost: nothing; neither hears the other.
TEST_F(FaultTest, TwoRunsOnTwoPortsDoNotHearEachOther) {
  constexpr std::int64_t kLast = 9;
  const std::string other_url = "udpm://239.255.76.67:7668?ttl=0";
  const std::string other_folder = folder_ + "other/";
  std::filesystem::create_directories(other_folder);
  BusListener other_listener(other_url);
  LiveChain other(other_folder, other_url);
  std::vector<LogEvent> events = SampleEvents(0, kLast);
  const std::string log = Write(events);
  for (LogEvent& event : events) SetSession(kSession + 1, &event);
  WriteEvents(events, other_folder + "input.lcm");
  for (LiveChain* chain : {chain_.get(), &other}) {
    chain->SetNodeArguments({"--deadline-s", "200"});
    ASSERT_NO_FATAL_FAILURE(chain->StartNodes());
  }
  chain_->StartPlayer(log);
  other.StartPlayer(other_folder + "input.lcm");
  HearTheEnd(kLast);
  EXPECT_TRUE(other_listener.HearUntil(
      [&] {
        return other_listener.IsDone("airdos-map-recorder", {kSession + 1, kLast});
      },
      LiveChain::kRun_s));
  chain_->StopNodes();
  other.StopNodes();
  listener_->Hear();
  EXPECT_EQ(listener_->digests(), ReplayDigests(log, folder_));
  EXPECT_EQ(other_listener.digests(), ReplayDigests(other_folder + "input.lcm", other_folder));
}

// There is no multicast route. Lost: everything, at once: each program ends with exit code 2 and
// one line that says what to do.
TEST_F(FaultTest, WithoutAMulticastRouteEachProgramSaysSoInOneLine) {
  const std::string obstacle = EnterPrivateNetwork(false);
  if (!obstacle.empty()) GTEST_SKIP() << obstacle;
  std::vector<std::string> programs = LiveChain::NodePrograms();
  programs.insert(programs.end(), {"airdos-stereo-player", "airdos-record"});
  const std::string log = Write(SampleEvents(0, 0));
  for (const std::string& program : programs) {
    std::vector<std::string> arguments;
    if (program == "airdos-stereo-player") arguments = {"--data", log};
    if (program == "airdos-record") arguments = {"--out", folder_ + "recorded.lcm"};
    if (program == "airdos-map-recorder") {
      arguments = {"--set", "output.directory=" + folder_ + "map"};
    }
    ChildProcess* process = chain_->Start(program, arguments);
    EXPECT_EQ(process->Wait(LiveChain::kStart_s), 2) << program;
    const std::string errors = process->Errors();
    EXPECT_NE(errors.find("network_setup.sh"), std::string::npos) << errors;
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  }
}

}  // namespace
}  // namespace airdos
