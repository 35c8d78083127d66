#include <gtest/gtest.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "airdos/pose_t.hpp"
#include "airdos/process_status_t.hpp"
#include "common/util/version.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/types_fingerprint.h"
#include "tests/support/child_process.h"
#include "tests/support/live_chain.h"
#include "tests/support/private_network.h"
#include "tests/support/sample_messages.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr double kDeadline_s = 60;  // far above what is needed, for busy machines
const std::string kBin = std::string(AIRDOS_BINARY_DIR) + "/bin/";
const std::string kUrl = "udpm://239.255.76.67:7667?ttl=0";

/// airdos-doctor and airdos-check as programs, on a network of their own.
class DoctorProcessTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_doctor_run_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void EnterNetwork(bool with_multicast = true) {
    const std::string failure = EnterPrivateNetwork(with_multicast);
    if (!failure.empty()) GTEST_SKIP() << failure;
  }

  /// Runs a program to its end, meanwhile calling `meanwhile`; gives its exit code.
  int Run(const std::string& program, std::vector<std::string> arguments,
          const std::function<void()>& meanwhile = {}) {
    arguments.insert(arguments.begin(), kBin + program);
    ChildProcess process(arguments, (folder_ / program).string());
    WaitUntil(
        [&] {
          if (meanwhile) meanwhile();
          return process.HasEnded();
        },
        kDeadline_s);
    const int code = process.Wait(kDeadline_s).value_or(-99);
    output_ = process.Output();
    errors_ = process.Errors();
    return code;
  }
  int RunDoctor(std::vector<std::string> arguments = {},
                const std::function<void()>& meanwhile = {}) {
    if (std::find(arguments.begin(), arguments.end(), "--listen-s") == arguments.end()) {
      arguments.insert(arguments.end(), {"--listen-s", "0.3"});
    }
    arguments.insert(arguments.end(), {"--run-dir", folder_.string()});
    return Run("airdos-doctor", arguments, meanwhile);
  }
  void ExpectLine(const std::string& text) {
    EXPECT_NE(output_.find(text), std::string::npos) << text << "\nin\n" << output_ << errors_;
  }

  fs::path folder_;
  std::string output_;
  std::string errors_;
};

void TakeFlagFromLoopback(short flag) {
  const int handle = socket(AF_INET, SOCK_DGRAM, 0);
  ifreq lo = {};
  std::strcpy(lo.ifr_name, "lo");
  ASSERT_EQ(ioctl(handle, SIOCGIFFLAGS, &lo), 0);
  lo.ifr_flags = static_cast<short>(lo.ifr_flags & ~flag);
  ASSERT_EQ(ioctl(handle, SIOCSIFFLAGS, &lo), 0);
  close(handle);
}

TEST_F(DoctorProcessTest, ASoundNetworkHasNoFailure) {
  EnterNetwork();
  if (IsSkipped()) return;
  const std::string json = (folder_ / "doctor.json").string();
  EXPECT_EQ(RunDoctor({"--round-trip-s", "0.5", "--json", json}), 0) << output_ << errors_;
  ExpectLine("OK   network.route: 239.255.76.67 is routed over lo");
  ExpectLine("OK   network.interface: lo is up and has MULTICAST");
  ExpectLine("OK   network.ttl: ttl=0: messages stay on this host");
  ExpectLine("OK   bus.port: nobody sends on port 7667");
  ExpectLine(" bus.round_trip: 0 of ");
  EXPECT_EQ(output_.find("FAIL"), std::string::npos) << output_;
  std::ifstream file(json);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_NE(text.find("\"kind\": \"network.route\""), std::string::npos) << text;
}

TEST_F(DoctorProcessTest, WithoutARoute) {
  EnterNetwork(false);
  if (IsSkipped()) return;
  EXPECT_EQ(RunDoctor(), 1);
  ExpectLine("FAIL network.route: no route for 239.255.76.67");
  ExpectLine("ip route add 224.0.0.0/4 dev lo");
  ExpectLine("FAIL bus.open");
}

TEST_F(DoctorProcessTest, LoopbackWithoutMulticastFlag) {
  EnterNetwork();
  if (IsSkipped()) return;
  TakeFlagFromLoopback(IFF_MULTICAST);
  EXPECT_EQ(RunDoctor({"--round-trip", "never"}), 1);
  ExpectLine(
      "FAIL network.interface: lo has no MULTICAST flag (mend: sudo ip link set lo multicast on)");
}

TEST_F(DoctorProcessTest, SmallReceiveBuffer) {
  EnterNetwork();
  if (IsSkipped()) return;
  EXPECT_EQ(RunDoctor({"--round-trip", "never", "--lcm-url", kUrl + "&recv_buf_size=20000"}), 1);
  ExpectLine("FAIL network.buffer: a socket gets 20000 bytes");
  ExpectLine("recv_buf_size in --lcm-url");
}

TEST_F(DoctorProcessTest, PortInUseByAnotherRun) {
  EnterNetwork();
  if (IsSkipped()) return;
  LcmTransport other(kUrl);
  auto status = Sample<process_status_t>();
  status.version = kVersion;
  status.types_fingerprint = TypesFingerprint();
  const auto say = [&] {
    for (std::int64_t pid = 1; pid <= 2; ++pid) {
      status.pid = pid;
      const std::vector<std::uint8_t> bytes = Encode(status);
      other.Publish("STATUS", bytes.data(), bytes.size());
    }
  };
  EXPECT_EQ(RunDoctor({}, say), 1);
  ExpectLine(
      "FAIL bus.port: two runs share port 7667: airdos-optimizer (1) and airdos-optimizer (2)");
  ExpectLine("239.255.76.67:7668");
  ExpectLine("OK   bus.round_trip: not tried");
}

TEST_F(DoctorProcessTest, ARunOfOtherTypes) {
  EnterNetwork();
  if (IsSkipped()) return;
  LcmTransport other(kUrl);
  const auto say = [&] {
    const std::vector<std::uint8_t> strange = Encode(Sample<pose_t>());
    other.Publish("STATUS", strange.data(), strange.size());
    const std::vector<std::uint8_t> status = Encode(Sample<process_status_t>());
    other.Publish("STATUS", status.data(), status.size());
  };
  EXPECT_EQ(RunDoctor({"--round-trip", "always", "--round-trip-s", "0.2"}, say), 1);
  ExpectLine("STATUS messages cannot be decoded");
  ExpectLine("airdos-optimizer (4711) was built with other message types (0123456789abcdef, here " +
             TypesFingerprint());
  ExpectLine("WARN bus.port: port 7667 is in use: STATUS");
  ExpectLine(" bus.round_trip: 0 of ");
}

// Beside a run it names each process, finds them to be of one build, and does not disturb.
TEST_F(DoctorProcessTest, BesideARunItNamesEachProcess) {
  EnterNetwork();
  if (IsSkipped()) return;
  BusListener listener(kUrl);
  LiveChain chain(folder_.string() + "/", kUrl);
  ASSERT_NO_FATAL_FAILURE(chain.StartNodes());
  WriteEvents(SampleEvents(0, 19), (folder_ / "input.lcm").string());
  ChildProcess* player = chain.StartPlayer((folder_ / "input.lcm").string());
  // Whoever works may be late with STATUS, once a second.
  const int code = RunDoctor({"--listen-s", "5"}, [&] { listener.Hear(); });
  EXPECT_EQ(code, 0) << output_ << errors_;
  for (const std::string& program : LiveChain::NodePrograms()) ExpectLine(program + " (");
  ExpectLine("WARN bus.port: port 7667 is in use: ");
  EXPECT_EQ(output_.find("bus.types"), std::string::npos) << output_;
  EXPECT_TRUE(listener.HearUntil([&] { return player->HasEnded(); }, LiveChain::kRun_s));
  EXPECT_EQ(player->Wait(0), 0) << player->Errors();
  chain.StopNodes();
  EXPECT_EQ(listener.states().size(), 20u);
}

TEST_F(DoctorProcessTest, BadArgumentsAreOneLineAndExit2) {
  EnterNetwork();
  if (IsSkipped()) return;
  const std::vector<std::vector<std::string>> calls = {
      {"airdos-doctor", "--bogus"},
      {"airdos-doctor", "--lcm-url", "memq://"},
      {"airdos-doctor", "--round-trip", "perhaps"},
      {"airdos-check"},
      {"airdos-check", "/nowhere"},
      {"airdos-check", folder_.string()},
      {"airdos-check", kBin + "airdos-check"},
      {"airdos-check", folder_.string(), "--max-frames", "0"}};
  for (const std::vector<std::string>& call : calls) {
    EXPECT_EQ(Run(call[0], {call.begin() + 1, call.end()}), 2) << call[0] << errors_;
    EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << errors_;
    EXPECT_EQ(output_, "");
  }
}

TEST_F(DoctorProcessTest, CheckExitsWithOneOnErrors) {
  // The names of images do not match.
  const fs::path data = folder_ / "data";
  for (const char* name : {"image_0/000000.png", "image_1/000001.png"}) {
    fs::create_directories((data / name).parent_path());
    std::ofstream(data / name) << "x";
  }
  const std::string json = (folder_ / "check.json").string();  // not into the data set
  EXPECT_EQ(Run("airdos-check", {data.string(), "--json", json}), 1) << errors_;
  ExpectLine("only on the left: '000000.png'; only on the right: '000001.png'");
  ExpectLine(": 1 errors, 0 warnings\n");
  std::ifstream file(json);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_NE(text.find("\"kind\": \"folder\""), std::string::npos) << text;
}

TEST_F(DoctorProcessTest, CheckPassesTheSampleLog) {
  const std::string log = std::string(AIRDOS_SOURCE_DIR) + "/logs/road_crossing06.lcm";
  EXPECT_EQ(Run("airdos-check", {log, "--max-frames", "4", "--odometry-frames", "0"}), 0)
      << output_ << errors_;
}

}  // namespace
}  // namespace airdos
