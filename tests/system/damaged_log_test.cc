#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/header.h"
#include "tests/support/child_process.h"
#include "tests/support/private_network.h"
#include "tests/support/sample_messages.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr double kDeadline_s = 60;  // far above what is needed, for busy machines
constexpr int kNumFrames = 8;
constexpr int kMessagesOfFrame = 5;
const std::string kBin = std::string(AIRDOS_BINARY_DIR) + "/bin/";

constexpr int kInVain = 1;  // exit code

/// What airdos-replay and airdos-stereo-player make of a log in which something is wrong.
class DamagedLogTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_damaged_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    log_ = (folder_ / "in.lcm").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Frames 0.1 s apart with a calibration before the first; `change` may spoil the header of each
  /// message.
  template <class Message>
  void Add(const char* channel, std::int64_t seq, Message message) {
    message.utime = 1000000 + 100000 * seq;
    message.seq = seq;
    message.session = 7;
    Header header = HeaderOf(message);
    if (change_) change_(channel, &header);
    message.utime = header.utime;
    message.seq = header.seq;
    message.session = header.session;
    const std::vector<std::uint8_t> bytes = Encode(message);
    writer_->Append(1000000 + 100000 * seq, channel, bytes.data(), bytes.size());
  }
  void WriteLog() {
    writer_ = std::make_unique<EventLogWriter>(log_);
    auto calibration = Sample<stereo_calibration_t>();
    image_t image = Sample<image_t>();
    calibration.width = image.width = 64;
    calibration.height = image.height = 48;
    calibration.cx_px = 32;
    calibration.cy_px = 24;
    calibration.fx_px = calibration.fy_px = 50;
    image.data.assign(64 * 48, 90);
    image.num_bytes = 64 * 48;
    person_mask_t mask = Sample<person_mask_t>();
    mask.encoding = person_mask_t::ENCODING_NONE;
    mask.data.clear();
    mask.num_bytes = 0;
    Add(channel::kCalibration, 0, calibration);
    for (std::int64_t seq = 0; seq < kNumFrames; ++seq) {
      Add(channel::kCameraLeft, seq, image);
      Add(channel::kCameraRight, seq, image);
      Add(channel::kPersonKeypointsLeft, seq, Sample<person_keypoints_t>());
      Add(channel::kPersonKeypointsRight, seq, Sample<person_keypoints_t>());
      Add(channel::kPersonMask, seq, mask);
    }
    writer_.reset();
  }
  std::string Bytes() const {
    std::ifstream file(log_, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }
  void SetBytes(const std::string& bytes) const {
    std::ofstream(log_, std::ios::binary | std::ios::trunc) << bytes;
  }
  /// Where the n-th event on a channel begins.
  static std::size_t EventAt(const std::string& bytes, const std::string& channel, int n) {
    std::size_t place = bytes.find(channel);
    for (; n > 0; --n) place = bytes.find(channel, place + 1);
    return place - 28;
  }

  std::unique_ptr<ChildProcess> Run(const std::string& program,
                                    std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), kBin + program);
    return std::make_unique<ChildProcess>(
        arguments, (folder_ / (program + std::to_string(num_run_++))).string());
  }
  /// What airdos-replay says of the log; it must come to an end by itself.
  /// Its images are blank, so the poses mean nothing, and it says so.
  std::string Replayed(int exit_code = kInVain, const std::string& check = "--no-check") {
    std::vector<std::string> arguments{log_, "--no-progress", "--run-dir", folder_ / "run"};
    if (!check.empty()) arguments.push_back(check);
    const auto replay = Run("airdos-replay", arguments);
    EXPECT_EQ(replay->Wait(kDeadline_s), exit_code) << replay->Errors();
    return replay->Output() + replay->Errors();
  }
  /// What the player says, without anybody to wait for, in a network of its own.
  std::string Played(const std::vector<std::string>& more = {}, int exit_code = 0) {
    std::vector<std::string> arguments{"--data", log_, "--wait-for", "none", "--no-check"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto player = Run("airdos-stereo-player", arguments);
    EXPECT_EQ(player->Wait(kDeadline_s), exit_code) << player->Errors();
    return player->Errors();
  }
  static void ExpectSaid(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
  }
  /// Both programs: exit code 2, and one line.
  void ExpectUnusable(const std::string& part) {
    const std::string replayed = Replayed(2);
    ExpectSaid(replayed, part);
    EXPECT_EQ(std::count(replayed.begin(), replayed.end(), '\n'), 1) << replayed;
    const std::string written = (folder_ / "written.lcm").string();
    const std::string played = Played({"--write-log", written}, 2);
    ExpectSaid(played, part);
    EXPECT_EQ(std::count(played.begin(), played.end(), '\n'), 1) << played;
  }

  fs::path folder_;
  std::string log_;
  std::function<void(const std::string& channel, Header* header)> change_;

 private:
  std::unique_ptr<EventLogWriter> writer_;
  int num_run_ = 0;
};

TEST_F(DamagedLogTest, AWholeLogGivesNoNotes) {
  WriteLog();
  const std::string text = Replayed();
  ExpectSaid(text, "frames: 8, with a pose: 8");
  EXPECT_EQ(text.find("note:"), std::string::npos) << text;
}

TEST_F(DamagedLogTest, AnEmptyOneIsOneLineAndExit2) {
  SetBytes("");
  ExpectUnusable("holds no LCM event (0 bytes)");
}

TEST_F(DamagedLogTest, GarbageIsOneLineAndExit2) {
  std::string garbage;
  for (int i = 0; i < 100000; ++i) garbage += static_cast<char>((i * 7919) >> 3);
  SetBytes(garbage);
  ExpectUnusable("holds no LCM event");
}

TEST_F(DamagedLogTest, ALogOfOtherPeopleIsOneLineAndExit2) {
  {
    EventLogWriter writer(log_);
    for (int i = 0; i < 5; ++i) writer.Append(i, "WEATHER", "rain", 4);
  }
  ExpectUnusable("no message on CAMERA_LEFT");
}

TEST_F(DamagedLogTest, ACutEndCostsOneEvent) {
  WriteLog();
  const std::string bytes = Bytes();
  SetBytes(bytes.substr(0, bytes.size() - 10));
  const std::string text = Replayed(kInVain, /*check=*/"");
  ExpectSaid(text, "frames: 8, with a pose: 8");
  ExpectSaid(text, "warning: " + log_ + ": 74 bytes are damaged, about 1 events lost");
  ExpectSaid(text, "in.lcm: 1 events lost to damage");
  ExpectSaid(text, "frontend: PERSON_MASK: 1 missing");
}

TEST_F(DamagedLogTest, DamageInTheMiddleCostsWhatItCovers) {
  WriteLog();
  std::string bytes = Bytes();
  const std::size_t from = EventAt(bytes, channel::kCameraLeft, 3);
  const std::size_t to = EventAt(bytes, channel::kPersonKeypointsLeft, 3);
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(from),
            bytes.begin() + static_cast<std::ptrdiff_t>(to), '\x5a');
  bytes[EventAt(bytes, channel::kPersonMask, 6) + 24] = 0x7f;  // a length beyond the file
  SetBytes(bytes);
  const std::string text = Replayed();
  ExpectSaid(text, "3 events lost to damage");
  ExpectSaid(text, "with a pose: 8");  // the frame without images is predicted
  ExpectSaid(text, "frontend: CAMERA_LEFT: 1 missing");
}

// One flipped bit in the session or in the number of an image would make all that follows late.
TEST_F(DamagedLogTest, AFlippedBitOfAHeaderCostsOneMessage) {
  change_ = [](const std::string& channel, Header* header) {
    if (channel == channel::kCameraLeft && header->seq == 2) header->session ^= 1 << 20;
    if (channel == channel::kCameraRight && header->seq == 4) header->seq ^= std::int64_t{1} << 33;
    if (channel == channel::kPersonMask && header->seq == 5) header->seq ^= 1 << 9;
  };
  WriteLog();
  const std::string text = Replayed();
  ExpectSaid(text, "frames: 8, with a pose: 8");
  ExpectSaid(text, "in.lcm: 3 messages skipped");
  ExpectSaid(text, "frontend: CAMERA_LEFT: 1 missing");
  ExpectSaid(text, "frontend: CAMERA_RIGHT: 1 missing");
  EXPECT_EQ(text.find("duplicate or late"), std::string::npos) << text;
}

TEST_F(DamagedLogTest, WrongTypesAreRejectedAndSaid) {
  WriteLog();
  std::string bytes = Bytes();
  for (int i = 0; i < 3; ++i) {  // the fingerprints of three messages
    const std::size_t event = EventAt(bytes, channel::kPersonMask, i);
    bytes[event + 28 + std::string(channel::kPersonMask).size()] ^= 0x55;
  }
  SetBytes(bytes);
  const std::string text = Replayed();
  ExpectSaid(text, "frames: 8, with a pose: 8");
  ExpectSaid(text, "frontend: PERSON_MASK: 3 rejected, the last because: does not decode");
}

TEST_F(DamagedLogTest, ThePlayerSaysWhatWasLostAndWritesTheRest) {
  WriteLog();
  std::string bytes = Bytes();
  bytes[EventAt(bytes, channel::kCameraLeft, 3)] = 0;
  SetBytes(bytes);
  const std::string written = (folder_ / "written.lcm").string();
  const std::string text = Played({"--write-log", written});
  ExpectSaid(text, "1 events lost to damage");
  ExpectSaid(text, std::to_string(kNumFrames * kMessagesOfFrame) + " messages");
}

TEST_F(DamagedLogTest, TypesThatAreWrongAreSaidBeforeARun) {
  WriteLog();
  std::string bytes = Bytes();
  bytes[EventAt(bytes, channel::kPersonMask, 0) + 28 + std::string(channel::kPersonMask).size()] ^=
      0x55;
  SetBytes(bytes);
  const std::string text = Replayed(2, /*check=*/"");
  ExpectSaid(text, "a message on PERSON_MASK has type fingerprint 0x");
  ExpectSaid(text, "--no-check continues anyway");
}

/// Capture times that nobody may wait for: the log itself is whole.
class JumpingClockTest : public DamagedLogTest {};

TEST_F(JumpingClockTest, RealtimeDoesNotWaitForTheFarFutureOrThePast) {
  const std::string failure = EnterPrivateNetwork(true);
  if (!failure.empty()) GTEST_SKIP() << failure;
  change_ = [](const std::string&, Header* header) {
    if (header->seq == 2) header->utime = std::int64_t{1} << 61;
    if (header->seq == 4) header->utime = 0;
    if (header->seq == 6) header->utime = std::numeric_limits<std::int64_t>::min();
  };
  WriteLog();
  const std::string text = Played({"--pace", "realtime"});
  ExpectSaid(text, "capture time jumps by 2.31e+12 s at image 2: continuing without waiting");
  ExpectSaid(text, "at image 3");
  ExpectSaid(text, "capture time jumps by -1.3 s at image 4");
  ExpectSaid(text, "at image 6");
  ExpectSaid(text, "published 8 frames");
}

TEST_F(JumpingClockTest, ReplayComesToItsEnd) {
  change_ = [](const std::string&, Header* header) {
    if (header->seq == 2) header->utime = std::int64_t{1} << 61;
    if (header->seq == 4) header->utime = 0;
  };
  WriteLog();
  ExpectSaid(Replayed(), "frames: 8, with a pose: 8");
}

}  // namespace
}  // namespace airdos
