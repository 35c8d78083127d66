#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "airdos/frame_done_t.hpp"
#include "airdos/image_t.hpp"
#include "airdos/pose_t.hpp"
#include "airdos/process_status_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/process_usage.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/validate.h"
#include "tests/support/child_process.h"
#include "tests/support/private_network.h"
#include "tests/support/sample_messages.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr double kDeadline_s = 60;  // far above what is needed, for busy machines
const std::string kBin = std::string(AIRDOS_BINARY_DIR) + "/bin/";

/// Real processes on a network of their own, with a folder of a few synthetic frames.
class PlayerProcessTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_player_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "echo.yaml") << "echo:\n  scale: 1\n";
  }
  void TearDown() override { fs::remove_all(folder_); }

  void EnterNetwork(bool with_multicast = true) {
    const std::string failure = EnterPrivateNetwork(with_multicast);
    if (!failure.empty()) GTEST_SKIP() << failure;
    if (with_multicast) Listen();
  }

  void Listen() {
    transport_ = std::make_unique<LcmTransport>("udpm://239.255.76.67:7667?ttl=0");
    transport_->Subscribe("ECHO", [this](const void* data, std::size_t size, std::int64_t) {
      pose_t echo;
      ASSERT_TRUE(Decode(data, size, &echo));
      echoes_.push_back(echo);
    });
    transport_->Subscribe("STATUS", [this](const void* data, std::size_t size, std::int64_t) {
      process_status_t status;
      ASSERT_TRUE(Decode(data, size, &status));
      EXPECT_EQ(Validate(status), "");
      statuses_.push_back(status);
    });
    transport_->Subscribe("FRAME_DONE", [this](const void* data, std::size_t size, std::int64_t) {
      frame_done_t done;
      ASSERT_TRUE(Decode(data, size, &done));
      done_.push_back(done.seq);
    });
  }

  template <class Message>
  void Say(const std::string& channel, const Message& message) {
    const std::vector<std::uint8_t> bytes = Encode(message);
    ASSERT_TRUE(transport_->Publish(channel, bytes.data(), bytes.size()));
  }

  /// Writes `num_frames` frames of growing complexity, so that every file has its own size.
  std::string MakeData(int num_frames) {
    const fs::path data = folder_ / "data";
    for (const char* side : {"image_0", "image_1"}) fs::create_directories(data / side);
    std::ofstream times(data / "times.txt");
    std::ofstream(data / "calib.json")
        << R"({"fx": 100, "fy": 100, "cx": 32, "cy": 24, "baseline_m": 0.25})";
    for (int i = 0; i < num_frames; ++i) {
      times << 0.1 * i << "\n";
      char name[16];
      std::snprintf(name, sizeof(name), "%06d.jpg", i);
      for (const char* side : {"image_0", "image_1"}) {
        cv::Mat image(48, 64, CV_8UC3, cv::Scalar(40, 80, 120));
        cv::circle(image, {32, 24}, 2 + i % 20, {200, 200, 10}, side[6] == '0' ? 1 : 3);
        cv::imwrite((data / side / name).string(), image);
      }
    }
    return data.string();
  }

  std::unique_ptr<ChildProcess> Start(const std::string& program,
                                      std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), kBin + program);
    return std::make_unique<ChildProcess>(
        arguments, (folder_ / (program + std::to_string(num_started_++))).string());
  }
  std::unique_ptr<ChildProcess> StartEcho() {
    return Start("airdos-echo", {"--config", (folder_ / "echo.yaml").string()});
  }
  std::unique_ptr<ChildProcess> StartPlayer(const std::string& data,
                                            std::vector<std::string> arguments = {}) {
    for (const char* argument : {"--wait-for", "airdos-echo", "--session", "5"}) {
      arguments.push_back(argument);
    }
    arguments.insert(arguments.end(), {"--data", data});
    return Start("airdos-stereo-player", arguments);
  }

  void Hear() {
    while (transport_ != nullptr && transport_->Poll(0)) {
    }
  }
  bool HearUntil(const std::function<bool()>& condition) {
    return WaitUntil(
        [&] {
          Hear();
          return condition();
        },
        kDeadline_s);
  }

  /// Exit code 2 and exactly one line on stderr that has `text` in it.
  void ExpectOneLine(const std::string& program, const std::vector<std::string>& arguments,
                     const std::string& text) {
    const auto process = Start(program, arguments);
    EXPECT_EQ(process->Wait(kDeadline_s).value_or(-99), 2) << program << " " << text;
    const std::string errors = process->Errors();
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    EXPECT_NE(errors.find(text), std::string::npos) << errors;
    EXPECT_EQ(process->Output(), "");
  }

  fs::path folder_;
  int num_started_ = 0;
  std::unique_ptr<LcmTransport> transport_;
  std::vector<pose_t> echoes_;
  std::vector<process_status_t> statuses_;
  std::vector<std::int64_t> done_;
};

TEST_F(PlayerProcessTest, LockstepLosesNothing) {
  EnterNetwork();
  if (IsSkipped()) return;
  constexpr int kNumFrames = 40;
  const std::string data = MakeData(kNumFrames);
  const auto player = StartPlayer(data);  // first: it must wait
  const auto echo = StartEcho();
  ASSERT_TRUE(HearUntil([&] { return player->HasEnded(); })) << player->Errors();
  EXPECT_EQ(player->Wait(0), 0) << player->Errors();
  ASSERT_TRUE(HearUntil([&] { return echoes_.size() >= kNumFrames; })) << echoes_.size();
  for (int i = 0; i < kNumFrames; ++i) {
    const pose_t& frame = echoes_[static_cast<std::size_t>(i)];
    char name[32];
    std::snprintf(name, sizeof(name), "image_0/%06d.jpg", i);
    EXPECT_EQ(frame.seq, i);
    EXPECT_EQ(frame.session, 5);
    EXPECT_EQ(frame.utime, 100000 * i);
    EXPECT_EQ(frame.position[0], static_cast<double>(fs::file_size(fs::path(data) / name)))
        << "the file travels unchanged";
    EXPECT_GT(frame.position[1], 0);
    EXPECT_EQ(frame.position[2], 0.25);
  }
  echo->Signal(SIGINT);
  EXPECT_EQ(echo->Wait(kDeadline_s), 0);
  EXPECT_NE(echo->Errors().find("frames done 40, incomplete 0, skipped 0"), std::string::npos)
      << echo->Errors();
}

TEST_F(PlayerProcessTest, GoesOnWhenAProcessIsKilledAndRestarted) {
  EnterNetwork();
  if (IsSkipped()) return;
  const std::string data = MakeData(30);
  auto echo = StartEcho();
  const auto player = StartPlayer(data, {"--loop", "0"});
  ASSERT_TRUE(HearUntil([&] { return echoes_.size() >= 10; }));
  echo->Signal(SIGKILL);
  ASSERT_EQ(echo->Wait(kDeadline_s), -SIGKILL);
  Hear();
  echoes_.clear();
  echo = StartEcho();
  ASSERT_TRUE(HearUntil([&] { return echoes_.size() >= 10; })) << player->Errors();
  EXPECT_NE(player->Errors().find("airdos-echo was restarted"), std::string::npos)
      << player->Errors();
  player->Signal(SIGINT);
  EXPECT_EQ(player->Wait(kDeadline_s), 0);
  echo->Signal(SIGTERM);
  EXPECT_EQ(echo->Wait(kDeadline_s), 0);
}

TEST_F(PlayerProcessTest, GoesOnWithoutAProcessThatIsKilled) {
  EnterNetwork();
  if (IsSkipped()) return;
  const auto echo = StartEcho();
  const auto player = StartPlayer(MakeData(600));
  ASSERT_TRUE(HearUntil([&] { return echoes_.size() >= 10; }));
  echo->Signal(SIGKILL);
  EXPECT_EQ(player->Wait(kDeadline_s), 0) << player->Errors();
  EXPECT_NE(player->Errors().find("waiting for airdos-echo to finish a frame"), std::string::npos)
      << player->Errors();
  EXPECT_NE(player->Errors().find("airdos-echo is silent for 10 s: continuing without it"),
            std::string::npos)
      << player->Errors();
}

TEST_F(PlayerProcessTest, GoesOnWhenAProcessStopsCleanly) {
  EnterNetwork();
  if (IsSkipped()) return;
  const auto echo = StartEcho();
  const auto player = StartPlayer(MakeData(600));
  ASSERT_TRUE(HearUntil([&] { return echoes_.size() >= 10; }));
  echo->Signal(SIGTERM);
  EXPECT_EQ(player->Wait(kDeadline_s), 0) << player->Errors();
  EXPECT_NE(player->Errors().find("airdos-echo has stopped: continuing without it"),
            std::string::npos)
      << player->Errors();
}

TEST_F(PlayerProcessTest, NamesASilentChannelAndCompletesTheFrameWithoutIt) {
  EnterNetwork();
  if (IsSkipped()) return;
  const auto echo =
      Start("airdos-echo", {"--config", (folder_ / "echo.yaml").string(), "--deadline-s", "0.3"});
  ASSERT_TRUE(HearUntil([&] { return !statuses_.empty(); }));
  EXPECT_EQ(statuses_[0].process, "airdos-echo");
  EXPECT_EQ(statuses_[0].pid, echo->pid());
  EXPECT_EQ(statuses_[0].state, +process_status_t::STATE_READY);
  EXPECT_EQ(statuses_[0].num_channels, 3);
  EXPECT_EQ(statuses_[0].waiting_for, "");

  Say("CALIBRATION", Sample<stereo_calibration_t>());
  auto image = Sample<image_t>();
  for (image.seq = 0; image.seq < 2; ++image.seq) Say("CAMERA_LEFT", image);
  for (int i = 0; i < 2; ++i) Say("CAMERA_LEFT", Sample<pose_t>());  // of another type
  ASSERT_TRUE(HearUntil([&] { return done_.size() == 2; })) << echo->Errors();
  EXPECT_EQ(done_, (std::vector<std::int64_t>{0, 1}));
  ASSERT_EQ(echoes_.size(), 2u);
  EXPECT_EQ(echoes_[0].position[0], 12);
  EXPECT_EQ(echoes_[0].position[1], -1);
  const auto stalled = std::find_if(statuses_.begin(), statuses_.end(), [](const auto& status) {
    return status.state == process_status_t::STATE_STALLED;
  });
  ASSERT_NE(stalled, statuses_.end());
  EXPECT_EQ(stalled->waiting_for, "CAMERA_RIGHT");

  echo->Signal(SIGTERM);
  ASSERT_TRUE(
      HearUntil([&] { return statuses_.back().state == process_status_t::STATE_STOPPING; }));
  EXPECT_EQ(echo->Wait(kDeadline_s), 0);
  const process_status_t& last = statuses_.back();
  EXPECT_EQ(last.num_frames_done, 2);
  EXPECT_EQ(last.num_frames_incomplete, 2);
  EXPECT_GT(last.memory_mb, 0);
  for (const channel_status_t& channel : last.channels) {
    if (channel.channel == "CAMERA_LEFT") {
      EXPECT_EQ(channel.num_received, 4);
      EXPECT_EQ(channel.num_rejected, 2);
    }
    if (channel.channel == "CAMERA_RIGHT") {
      EXPECT_EQ(channel.num_missing, 2);
    }
  }
  for (const std::string line : {"nothing on CAMERA_RIGHT for 0.3 s",
                                 "rejected a message on CAMERA_LEFT: does not decode"}) {
    const std::string errors = echo->Errors();
    ASSERT_NE(errors.find(line), std::string::npos) << errors;
    EXPECT_EQ(errors.find(line, errors.find(line) + 1), std::string::npos) << "said once";
  }
}

TEST_F(PlayerProcessTest, HearsWhatIsSaidRightAfterReady) {
  EnterNetwork();
  if (IsSkipped()) return;
  // Whoever plays a log waits for READY and says everything once.
  for (int session = 0; session < 10; ++session) {
    const auto echo = StartEcho();
    ASSERT_TRUE(WaitUntil([&] { return echo->HasSaid(" READY "); }, kDeadline_s));
    auto calibration = Sample<stereo_calibration_t>();
    auto image = Sample<image_t>();
    calibration.session = image.session = session;
    Say("CALIBRATION", calibration);
    Say("CAMERA_LEFT", image);
    Say("CAMERA_RIGHT", image);
    ASSERT_TRUE(HearUntil([&] { return !echoes_.empty() && echoes_.back().session == session; }))
        << "start " << session << ": " << echo->Errors();
    EXPECT_GT(echoes_.back().position[0], 0);
    EXPECT_GT(echoes_.back().position[1], 0);
  }
}

TEST_F(PlayerProcessTest, ASignalEndsThePlayerWhileItWaits) {
  EnterNetwork();
  if (IsSkipped()) return;
  const auto player = StartPlayer(MakeData(3));
  ASSERT_TRUE(HearUntil([&] { return player->Output().find("READY") != std::string::npos; }));
  player->Signal(SIGINT);
  EXPECT_EQ(player->Wait(kDeadline_s), 0);
  EXPECT_NE(player->Errors().find("published 0 frames"), std::string::npos) << player->Errors();
}

TEST_F(PlayerProcessTest, RealtimeFollowsTheCaptureTimes) {
  EnterNetwork();
  if (IsSkipped()) return;
  const auto echo =
      Start("airdos-echo", {"--config", (folder_ / "echo.yaml").string(), "--pace", "realtime"});
  const auto player = StartPlayer(MakeData(20), {"--pace", "realtime", "--speed", "2"});
  ASSERT_TRUE(HearUntil([&] { return player->HasEnded(); }));
  EXPECT_EQ(player->Wait(0), 0) << player->Errors();
  EXPECT_TRUE(HearUntil([&] { return !echoes_.empty() && echoes_.back().seq == 19; }));
}

TEST_F(PlayerProcessTest, BadInputIsOneLineAndExit2) {
  EnterNetwork();
  if (IsSkipped()) return;
  const std::string config = (folder_ / "echo.yaml").string();
  ExpectOneLine("airdos-echo", {"--bogus"}, "--bogus");
  ExpectOneLine("airdos-echo", {"--config", "/nowhere.yaml"}, "/nowhere.yaml");
  ExpectOneLine("airdos-echo", {"--config", config, "--set", "echo.scale=99"}, "echo.scale");
  ExpectOneLine("airdos-echo", {"--config", config, "--set", "echo.none=1"}, "echo.none");
  ExpectOneLine("airdos-echo", {"--config", config, "--set", "echo.factor=1"},
                "'echo.factor' is called 'echo.scale' now");
  ExpectOneLine("airdos-echo", {"--config", config, "--pace", "fast"}, "fast");
  ExpectOneLine("airdos-echo", {"--config", config, "--deadline-s", "soon"}, "--deadline-s");
  ExpectOneLine("airdos-echo", {"--config", config, "--lcm-url", "foo://x"}, "foo://x");
  ExpectOneLine("airdos-echo", {"--config", config, "--resolved-config", "/no/where"}, "/no/where");
  std::ofstream(config, std::ios::app) << "  typo: 1\n";
  ExpectOneLine("airdos-echo", {"--config", config}, "echo.typo");
  const std::string data = MakeData(3);
  ExpectOneLine("airdos-stereo-player", {"--bogus"}, "--bogus");
  ExpectOneLine("airdos-stereo-player", {}, "--data");
  ExpectOneLine("airdos-stereo-player", {"--data", "/nowhere"}, "/nowhere");
  ExpectOneLine("airdos-stereo-player", {"--data", data, "--first", "7"}, "frames 0 to 2");
  ExpectOneLine("airdos-stereo-player", {"--data", data, "--set", "image.size=3"}, "image.size");
}

TEST_F(PlayerProcessTest, LeavesItsConfigurationBehind) {
  const std::string resolved = (folder_ / "resolved.yaml").string();
  const auto player =
      StartPlayer(MakeData(1), {"--write-log", (folder_ / "log").string(), "--resolved-config",
                                resolved, "--set", "lockstep.frames_in_flight=7"});
  ASSERT_EQ(player->Wait(kDeadline_s), 0) << player->Errors();
  std::ifstream file(resolved);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_NE(text.find("lockstep.frames_in_flight: 7\n"), std::string::npos) << text;
}

TEST_F(PlayerProcessTest, WithoutMulticastRouteItSaysWhatToDo) {
  EnterNetwork(false);
  if (IsSkipped()) return;
  ExpectOneLine("airdos-echo", {"--config", (folder_ / "echo.yaml").string()}, "network_setup.sh");
  ExpectOneLine("airdos-stereo-player", {"--data", MakeData(1)}, "network_setup.sh");
}

TEST_F(PlayerProcessTest, AFolderIsASessionOfTheWallClockAndALogKeepsItsOwn) {
  const auto session_of = [&](const std::string& data) {
    const std::string path = (folder_ / "session.log").string();
    const auto player =
        Start("airdos-stereo-player", {"--data", data, "--write-log", path, "--force"});
    EXPECT_EQ(player->Wait(kDeadline_s), 0) << player->Errors();
    image_t image = {};
    EventLogReader reader(path);
    for (std::optional<LogEvent> event = reader.Next(); event; event = reader.Next()) {
      if (event->channel != "CAMERA_LEFT") continue;
      EXPECT_TRUE(Decode(event->payload.data(), event->payload.size(), &image));
    }
    return image.session;
  };
  const std::string data = MakeData(2);
  const std::int64_t before = WallClock_us();
  const std::int64_t session = session_of(data);
  EXPECT_GE(session, before);
  EXPECT_LE(session, WallClock_us());
  fs::rename(folder_ / "session.log", folder_ / "of_a_camera.log");
  EXPECT_EQ(session_of((folder_ / "of_a_camera.log").string()), session);
}

TEST_F(PlayerProcessTest, TheSameFramesGiveTheSameLog) {
  const std::string data = MakeData(5);
  std::vector<std::string> logs;
  for (const char* name : {"a.log", "b.log"}) {
    const std::string path = (folder_ / name).string();
    const auto player = StartPlayer(data, {"--write-log", path});
    ASSERT_EQ(player->Wait(kDeadline_s), 0) << player->Errors();
    std::ifstream file(path, std::ios::binary);
    logs.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  EXPECT_EQ(logs[0], logs[1]);
  // Event by event it is what was put into the folder: five frames 100 ms apart.
  EventLogReader reader((folder_ / "b.log").string());
  for (int i = 0; i < 5; ++i) {
    for (const char* side : {"left", "right"}) {
      std::optional<LogEvent> event = reader.Next();
      while (event && event->channel.find("CAMERA_") != 0) event = reader.Next();
      ASSERT_TRUE(event);
      image_t message;
      ASSERT_TRUE(Decode(event->payload.data(), event->payload.size(), &message));
      EXPECT_EQ(event->channel, side == std::string("left") ? "CAMERA_LEFT" : "CAMERA_RIGHT");
      EXPECT_EQ(event->utime, 100000 * i);
      EXPECT_EQ(message.seq, i);
      char name[32];
      std::snprintf(name, sizeof(name), "image_%d/%06d.jpg", side[0] == 'l' ? 0 : 1, i);
      std::ifstream file(fs::path(data) / name, std::ios::binary);
      const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file),
                                            std::istreambuf_iterator<char>()};
      EXPECT_EQ(message.data, bytes) << name;
    }
  }
  std::optional<LogEvent> event = reader.Next();
  while (event && event->channel.find("CAMERA_") != 0) event = reader.Next();
  EXPECT_FALSE(event) << "a sixth frame";
}

}  // namespace
}  // namespace airdos
