#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "processes/node/message/codec.h"
#include "tests/support/fault_fixture.h"

// What users' own drivers and second plays of a log do to the real processes.

namespace airdos {
namespace {

class UserCases : public FaultTest {
 protected:
  static constexpr std::int64_t kLast = 14;

  void SetUp() override {
    FaultTest::SetUp();
    if (!IsSkipped()) driver_ = std::make_unique<LcmTransport>(kUrl);
  }
  void TearDown() override {
    driver_.reset();
    FaultTest::TearDown();
  }

  void Say(const LogEvent& event) {
    ASSERT_TRUE(driver_->Publish(event.channel, event.payload.data(), event.payload.size()));
  }
  /// Says the events, as an own driver does that asks nobody; waits for the estimate of each left
  /// image as long as `goes_on`, so that nothing is lost to full queues.
  void Drive(const std::vector<LogEvent>& events, const std::function<bool()>& goes_on) {
    std::int64_t seq = -1;
    for (const LogEvent& event : events) {
      if (!goes_on()) return;
      if (SeqOf(event) > seq && event.channel == channel::kCameraLeft) {
        HearEstimateOf(seq, goes_on);
        seq = SeqOf(event);
      }
      Say(event);
    }
    HearEstimateOf(seq, goes_on);
  }
  void HearEstimateOf(std::int64_t seq, const std::function<bool()>& goes_on) {
    if (seq < 0) return;
    EXPECT_TRUE(listener_->HearUntil(
        [&] {
          return !goes_on() || listener_->states().count({kSession, seq}) > 0;
        },
        LiveChain::kRun_s))
        << "image " << seq << "\n"
        << chain_->AllErrors();
  }
  void DriveAll(const std::vector<LogEvent>& events) {
    Drive(events, [] { return true; });
  }
  bool HasSaid(const std::string& program, const std::string& text) {
    return chain_->process(program)->HasSaid(text);
  }
  /// Whether STATUS holds the warning.
  bool IsInStatus(const std::string& program, const std::string& text) {
    const auto status = listener_->statuses().find(program);
    if (status == listener_->statuses().end()) return false;
    const std::vector<std::string>& warnings = status->second.warnings;
    return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
      return warning.find(text) != std::string::npos;
    });
  }
  void ExpectWarning(const std::string& program, const std::string& text) {
    EXPECT_TRUE(listener_->HearUntil([&] { return IsInStatus(program, text); }, LiveChain::kRun_s))
        << chain_->AllErrors();
    EXPECT_TRUE(HasSaid(program, program + ": warning: ")) << chain_->Errors(program);
    EXPECT_TRUE(HasSaid(program, text)) << chain_->Errors(program);
  }

  std::unique_ptr<LcmTransport> driver_;
};

std::vector<LogEvent> Renumbered(std::vector<LogEvent> events, const std::string& channel,
                                 std::int64_t by) {
  for (LogEvent& event : events) {
    if (event.channel != channel) continue;
    image_t image = {};
    EXPECT_TRUE(Decode(event.payload.data(), event.payload.size(), &image));
    image.seq += by;
    event.payload = Encode(image);
  }
  return events;
}

/// Times of a TUM file, s.
std::vector<double> TimesOf(const std::string& path) {
  std::ifstream file(path);
  std::vector<double> times_s;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != '#') times_s.push_back(std::stod(line));
  }
  return times_s;
}

TEST_F(UserCases, CaseC20TheRightCameraOfAnOwnDriverCountsFromAnotherNumber) {
  chain_->SetNodeArguments({"--deadline-s", "2"});
  ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
  DriveAll(Renumbered(SampleEvents(0, kLast), channel::kCameraRight, 1000));
  ExpectWarning("airdos-frontend", "no right image came for 10 of 10 left images");
  // The deadline passes for the right images.
  EXPECT_TRUE(listener_->HearUntil([&] { return listener_->num_without_pose() == kLast + 1; },
                                   LiveChain::kRun_s))
      << chain_->AllErrors();
  EXPECT_EQ(listener_->states().size(), static_cast<std::size_t>(kLast + 1));
  chain_->ExpectInVain();
  StopAndHear();
  for (const char* name : {"trajectory.tum", "trajectory_live.tum"}) {
    const std::vector<double> times_s = TimesOf(folder_ + "map/" + name);
    EXPECT_EQ(times_s.size(), static_cast<std::size_t>(kLast + 1)) << name;
    EXPECT_TRUE(std::is_sorted(times_s.begin(), times_s.end())) << name;
  }
}

TEST_F(UserCases, CaseALogIsPlayedTwice) {
  chain_->SetNodeArguments({"--deadline-s", "200"});
  ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
  DriveAll(SampleEvents(0, 5));
  for (const LogEvent& event : SampleEvents(0, 5)) Say(event);
  for (const std::string program : {"airdos-frontend", "airdos-human-tracker"}) {
    ExpectWarning(program, "session 1 was already processed up to image 5: repeated messages");
  }
  StopAndHear();
  EXPECT_EQ(listener_->num_messages(channel::kStateEstimate), 6);
}

// What airdos-record kept of a run, inputs and outputs, is played into the same processes. They
// compute the very same bytes, and yet must not go on.
TEST_F(UserCases, CaseALogWithOutputsIsPlayed) {
  const std::string input = Write(SampleEvents(0, kLast));
  ChildProcess replay(
      {std::string(AIRDOS_BINARY_DIR) + "/bin/airdos-replay", input, "--out", folder_ + "all.lcm",
       "--all", "--run-dir", folder_ + "replayed", "--no-progress"},
      folder_ + "airdos-replay");
  ASSERT_EQ(replay.Wait(LiveChain::kRun_s), 0) << replay.Errors();
  std::vector<LogEvent> events;
  EventLogReader reader(folder_ + "all.lcm");
  while (std::optional<LogEvent> event = reader.Next()) events.push_back(std::move(*event));

  ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
  const std::vector<std::pair<std::string, std::string>> publishers = {
      {"airdos-frontend", channel::kStaticFeatures},
      {"airdos-human-tracker", channel::kHumanObservations},
      {"airdos-optimizer", channel::kStateEstimate}};
  for (const LogEvent& event : events) {
    listener_->Hear();
    Say(event);
  }
  for (const auto& [program, channel] : publishers) {
    const std::string name = program;
    EXPECT_TRUE(
        listener_->HearUntil([&] { return chain_->process(name)->HasEnded(); }, LiveChain::kRun_s))
        << chain_->Errors(program);
    EXPECT_EQ(chain_->process(program)->Wait(LiveChain::kStart_s), 1) << chain_->Errors(program);
    EXPECT_TRUE(HasSaid(program, "error: somebody else publishes ")) << channel << "\n"
                                                                     << chain_->Errors(program);
    EXPECT_TRUE(HasSaid(program, "a log that also holds outputs is being played"));
    EXPECT_TRUE(HasSaid(program, "refuses to go on"));
    listener_->Hear();
    const process_status_t& status = listener_->statuses().at(program);
    EXPECT_EQ(status.state, +process_status_t::STATE_STOPPING);
    EXPECT_NE(status.last_error.find("somebody else publishes"), std::string::npos);
  }
}

TEST_F(UserCases, CaseTwoProcessesOfOneName) {
  chain_->SetNodeArguments({"--deadline-s", "200"});
  ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
  ChildProcess second({std::string(AIRDOS_BINARY_DIR) + "/bin/airdos-frontend", "--deadline-s",
                       "200", "--lcm-url", kUrl},
                      folder_ + "second");
  EXPECT_TRUE(listener_->HearUntil(
      [&] {
        return HasSaid("airdos-frontend",
                       "another airdos-frontend runs, process " + std::to_string(second.pid())) &&
               second.HasSaid("another airdos-frontend runs");
      },
      LiveChain::kStart_s))
      << chain_->AllErrors();
  const auto goes_on = [&] {
    return !chain_->process("airdos-frontend")->HasEnded() && !second.HasEnded();
  };
  Drive(SampleEvents(0, kLast), goes_on);
  EXPECT_FALSE(goes_on()) << "both answer each image";
}

TEST_F(UserCases, CaseNoCalibrationIsSaid) {
  chain_->SetNodeArguments({"--deadline-s", "0.5"});
  ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
  for (const LogEvent& event : SampleEvents(0, 3)) {
    if (event.channel != channel::kCalibration) Say(event);
  }
  for (const std::string program : {"airdos-frontend", "airdos-human-tracker"}) {
    ExpectWarning(program, "no CALIBRATION yet for session 1: there are no poses until it arrives");
  }
  StopAndHear();
  EXPECT_EQ(listener_->num_messages(channel::kStateEstimate), 0);
  EXPECT_EQ(listener_->num_messages(channel::kFrameDone), 0) << "the optimizer never hears of them";
}

TEST_F(UserCases, CaseHangUpEndsAProcessAsTermDoes) {
  ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
  for (const std::string& program : LiveChain::NodePrograms()) {
    chain_->process(program)->Signal(SIGHUP);
    EXPECT_EQ(chain_->process(program)->Wait(LiveChain::kStart_s), 0) << chain_->Errors(program);
    EXPECT_TRUE(HasSaid(program, ": stopped; frames done 0"));
  }
}

TEST_F(UserCases, CaseHangUpIsIgnoredUnderNohup) {
  chain_->SetLauncher({"nohup"});
  ASSERT_NO_FATAL_FAILURE(chain_->StartNode("airdos-frontend"));
  ChildProcess* frontend = chain_->process("airdos-frontend");
  frontend->Signal(SIGHUP);
  const std::int64_t num_before = listener_->num_messages(channel::kStatus);
  EXPECT_TRUE(listener_->HearUntil(
      [&] { return listener_->num_messages(channel::kStatus) > num_before + 2; },
      LiveChain::kStart_s))
      << "it goes on";
  frontend->Signal(SIGTERM);
  EXPECT_EQ(frontend->Wait(LiveChain::kStart_s), 0);
}

// airdos-doctor and network_setup.sh --check, each in a network that is set up like this.
TEST_F(UserCases, CaseDoctorAndNetworkSetupAgree) {
  const std::string up = "ip link set lo up; ip link set lo multicast on";
  const std::vector<std::pair<std::string, int>> networks = {
      {":", 1},
      {up, 1},
      {up + "; ip route add 224.0.0.0/4 dev lo", 0},
      {up + "; ip route add default dev lo", 0},
      {up + "; ip route add 239.255.76.0/24 dev lo", 0},
      {up + "; ip route add 224.0.0.0/4 dev lo; ip link set lo multicast off", 1}};
  const std::string setup = std::string(AIRDOS_SOURCE_DIR) + "/launch_scripts/network_setup.sh";
  const std::string doctor = std::string(AIRDOS_BINARY_DIR) +
                             "/bin/airdos-doctor --round-trip never --listen-s 0.1 --run-dir " +
                             folder_;
  for (const auto& [network, expected] : networks) {
    for (const std::string& command : {setup + " --check", doctor}) {
      ChildProcess process({"unshare", "-n", "bash", "-c", network + "; " + command},
                           folder_ + "network");
      EXPECT_EQ(process.Wait(LiveChain::kStart_s), expected)
          << network << "\n"
          << command << "\n"
          << process.Output() << process.Errors();
    }
  }
}

}  // namespace
}  // namespace airdos
