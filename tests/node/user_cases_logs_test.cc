// What users' logs are like: each test stands for a kind of them.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>

#include "airdos/image_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "common/util/error.h"
#include "processes/node/check/check_log.h"
#include "processes/node/log/event_log.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/stereo_player/dataset_source.h"
#include "processes/stereo_player/player_loop.h"
#include "tests/node/small_log_test.h"
#include "tests/support/input_errors.h"
#include "tests/support/small_sequence.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSession = 5;
constexpr std::int64_t kNumFrames = SmallSequence::kNumFrames;

class UserCases : public SmallLogTest {
 protected:
  UserCases() : SmallLogTest("user_cases_logs", kSession) {}

  void ChangeHeaders(const std::function<void(const std::string&, Header*)>& change) {
    for (Envelope& message : messages_) {
      Header header = *PeekHeader(message.payload.data(), message.payload.size());
      change(message.channel, &header);
      WriteHeader(header, message.payload.data(), message.payload.size());
    }
  }
  template <class Message>
  void ChangeAll(const std::string& channel, const std::function<void(Message*)>& change) {
    for (Envelope& envelope : messages_) {
      if (envelope.channel != channel) continue;
      Message message;
      ASSERT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
      change(&message);
      envelope.payload = Encode(message);
    }
  }
  void Rename(const std::function<std::string(const std::string&)>& rename) {
    for (Envelope& message : messages_) message.channel = rename(message.channel);
  }

  /// The lines of errors and warnings that a check makes, without the last one, which counts them.
  std::string Check(CheckOptions::Depth depth = CheckOptions::Depth::kFull) {
    Write();
    CheckOptions options;
    options.depth = depth;
    options.max_frames = 4;
    options.odometry_frames = 0;
    findings_ = FindingList();
    CheckLog(path_, options, &findings_);
    std::string text;
    for (const Finding& finding : findings_.findings()) {
      if (finding.severity == Severity::kNote) continue;
      text += finding.where + ": " + NameOf(finding.severity) + ": " + finding.what + " [" +
              finding.kind + "]\n";
    }
    return text;
  }
  /// Both depths say just this, once, as an error.
  void ExpectOneError(const std::string& part, const std::string& kind) {
    for (const auto depth : {CheckOptions::Depth::kQuick, CheckOptions::Depth::kFull}) {
      const std::string text = Check(depth);
      EXPECT_EQ(findings_.count(Severity::kError), 1) << text;
      EXPECT_TRUE(Holds(text, part)) << text;
      EXPECT_TRUE(Holds(text, "[" + kind + "]")) << text;
    }
  }

  /// What a program says that plays the log.
  std::string Notes() {
    Write();
    LogSource source(path_);
    std::string text;
    while (!source.NextFrame().empty()) {
    }
    for (const std::string& note : source.TakeNotes()) text += note + "\n";
    return text;
  }
  std::string WhyUnusable(const std::string& path) const {
    try {
      LogSource source(path);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }
};

TEST_F(UserCases, ASoundLogHasNothingToSay) {
  EXPECT_EQ(Check(CheckOptions::Depth::kQuick), "");
  EXPECT_EQ(Check(), "");
  EXPECT_EQ(Notes(), "");
}

TEST_F(UserCases, Case85ChannelNamesWithAPrefixAnotherCaseOrASuffix) {
  const std::vector<std::function<std::string(const std::string&)>> renames{
      [](const std::string& name) { return "robot1/" + name; },
      [](const std::string& name) { return name + "_RAW"; },
      [](std::string name) {
        for (char& c : name) c = c == '_' ? '-' : static_cast<char>(std::tolower(c));
        return name;
      }};
  for (const auto& rename : renames) {
    messages_ = SoundMessages();
    Rename(rename);
    const std::string left = rename(channel::kCameraLeft);
    ExpectOneError(left + " looks like CAMERA_LEFT", "log.images");
    const std::string text = Check();
    for (const std::string& name : InputChannels()) {
      EXPECT_TRUE(Holds(text, name)) << text;
      EXPECT_TRUE(Holds(text, rename(name) + " (")) << text;
    }
    EXPECT_TRUE(Holds(text, left + " (14 messages of image_t, ")) << text;
    const std::string why = WhyUnusable(path_);
    EXPECT_TRUE(Holds(why, path_ + ": contains no message for the processes")) << why;
    EXPECT_TRUE(Holds(why, left + " looks like CAMERA_LEFT")) << why;
    EXPECT_EQ(why.find('\n'), std::string::npos) << why;
  }
}

TEST_F(UserCases, Case85OneChannelOfAnotherName) {
  Rename([](const std::string& name) {
    return name == channel::kCameraRight ? "cam/CAMERA_RIGHT" : name;
  });
  ExpectOneError("cam/CAMERA_RIGHT looks like it", "log.count");
  messages_ = SoundMessages();
  Rename(
      [](const std::string& name) { return name == channel::kPersonMask ? "person_mask" : name; });
  EXPECT_TRUE(Holds(Check(),
                    "PERSON_MASK: warning: no message, for 14 of CAMERA_LEFT; person_mask "
                    "looks like it"))
      << Check();
}

TEST_F(UserCases, Case85ALogOfOthersListsItsChannels) {
  messages_.clear();
  for (int i = 0; i < 30; ++i) messages_.push_back({"JOINT_" + std::to_string(i), {1, 2, 3}});
  const std::string text = Check();
  EXPECT_TRUE(Holds(text, "JOINT_0 (1 message, 1 kB), JOINT_1 (")) << text;
  EXPECT_TRUE(Holds(text, " and 10 more")) << text;
  EXPECT_FALSE(Holds(text, "looks like")) << text;
}

TEST_F(UserCases, Case86AllNumbersAreZero) {
  ChangeHeaders([](const std::string&, Header* header) { header->seq = 0; });
  ExpectOneError("all messages have number 0 (seq): number the images 0, 1, 2, …", "log.numbers");
  EXPECT_EQ(findings_.count(Severity::kWarning), 0) << Check();
  EXPECT_TRUE(Holds(Notes(), "all messages have number 0")) << Notes();
  messages_ = SoundMessages();
  ChangeHeaders([](const std::string&, Header* header) {
    header->session = header->seq;
    header->seq = 0;
  });
  EXPECT_TRUE(Holds(Check(), "has its own session")) << Check();
}

TEST_F(UserCases, Case86cTheRightCameraCountsFromElsewhere) {
  for (const std::int64_t offset : {1000, 20, -1}) {
    messages_ = SoundMessages();
    ChangeHeaders([&](const std::string& name, Header* header) {
      header->seq += 1;
      if (name == channel::kCameraRight) header->seq += offset;
    });
    const std::string text = Check(CheckOptions::Depth::kQuick);
    EXPECT_GE(findings_.count(Severity::kError), 1) << text;
    EXPECT_TRUE(Holds(text, "its numbers are those of CAMERA_LEFT " +
                                std::string(offset < 0 ? "- " : "+ ") +
                                std::to_string(std::abs(offset))))
        << text;
    EXPECT_TRUE(Holds(Notes(), "its numbers are those of CAMERA_LEFT")) << Notes();
  }
}

TEST_F(UserCases, Case86cClocksDifferAsWell) {
  ChangeHeaders([](const std::string& name, Header* header) {
    if (name != channel::kCameraRight) return;
    header->seq += 1000;
    header->utime += 12345;
  });
  ExpectOneError("in the order of the log its numbers are those of CAMERA_LEFT + 1000",
                 "log.partners");
  EXPECT_TRUE(Holds(Check(), "14 of 14 left images have no message with their number")) << Check();
}

TEST_F(UserCases, Case86cSessionsDiffer) {
  ChangeHeaders([](const std::string& name, Header* header) {
    if (name == channel::kCameraRight) header->session = 77;
  });
  ExpectOneError(
      "CAMERA_RIGHT: error: 14 of 14 left images have no message with their number and "
      "session here: its session is 77, that of CAMERA_LEFT 5",
      "log.partners");
}

TEST_F(UserCases, Case86cMasksAndKeypointsCountFromElsewhere) {
  for (const char* channel : {channel::kPersonMask, channel::kPersonKeypointsRight}) {
    messages_ = SoundMessages();
    ChangeHeaders([&](const std::string& name, Header* header) {
      if (name == channel) header->seq += 500;
    });
    ExpectOneError("its numbers are those of CAMERA_LEFT + 500", "log.partners");
  }
}

TEST_F(UserCases, Case86cAFewPartnersAreMissing) {
  int num = 0;
  messages_.erase(std::remove_if(messages_.begin(), messages_.end(),
                                 [&](const Envelope& m) {
                                   return m.channel == channel::kCameraRight && num++ % 6 == 2;
                                 }),
                  messages_.end());
  const std::string text = Check();
  EXPECT_EQ(findings_.count(Severity::kError), 0) << text;
  EXPECT_TRUE(Holds(text,
                    "CAMERA_RIGHT: warning: 2 of 14 left images have no message with their number "
                    "and session here, the first is 2"))
      << text;
  EXPECT_TRUE(Holds(Notes(), "CAMERA_RIGHT: 2 of 14 left images")) << Notes();
  messages_ = SoundMessages();
  Remove(channel::kCameraRight);
  EXPECT_TRUE(Holds(Notes(), "no message on CAMERA_RIGHT")) << Notes();
}

TEST_F(UserCases, Case86cCaptureTimesOfAPairDiffer) {
  ChangeHeaders([](const std::string& name, Header* header) {
    if (name == channel::kCameraRight) header->utime += 33;
  });
  ExpectOneError("and so have 14 of 14, by + 33 us", "log.utime");
}

TEST_F(UserCases, Case87TimesInOtherUnits) {
  const std::vector<std::pair<std::function<std::int64_t(std::int64_t)>, std::string>> units{
      {[](std::int64_t us) { return 1000 * us; }, "ns"},
      {[](std::int64_t us) { return 1000 * us + 1700000000000000000; }, "ns"},
      {[](std::int64_t us) { return us / 1000; }, "ms"},
      {[](std::int64_t us) { return us / 1000000 + 1700000000; }, "s"}};
  for (const auto& [convert, unit] : units) {
    messages_ = SoundMessages();
    ChangeHeaders([convert = convert](const std::string&, Header* header) {
      header->utime = convert(header->utime);
    });
    ExpectOneError("utime is in us, but these are " + unit + ":", "times.unit");
  }
}

TEST_F(UserCases, Case87ClocksThatStandStillOrGoBack) {
  for (const std::int64_t utime : {0, 123456}) {
    messages_ = SoundMessages();
    ChangeHeaders([&](const std::string&, Header* header) { header->utime = utime; });
    ExpectOneError("all 14 images have the capture time " + std::to_string(utime),
                   "times.constant");
  }
  messages_ = SoundMessages();
  ChangeHeaders(
      [](const std::string&, Header* header) { header->utime = 1000000000 - header->utime; });
  ExpectOneError("13 of 14 images have an earlier capture time than the previous one",
                 "times.order");
  messages_ = SoundMessages();
  ChangeHeaders([](const std::string& name, Header* header) {
    if (name == channel::kCameraRight) header->utime *= 1000;
  });
  ExpectOneError("one is 1000 times the other", "log.utime");
}

TEST_F(UserCases, Case88bWidthAndHeightAreExchanged) {
  const auto exchange = [](auto* message) { std::swap(message->width, message->height); };
  ChangeAll<image_t>(channel::kCameraLeft, exchange);
  ExpectOneError(
      "CAMERA_LEFT 0: error: the message says 192 x 320 px, the file in it has 320 x "
      "192 px: width and height are exchanged; so 14 of 14 messages",
      "images.file");
  messages_ = SoundMessages();
  ChangeAll<person_mask_t>(channel::kPersonMask, exchange);
  ExpectOneError("PERSON_MASK 0: error: the message says 192 x 320 px", "masks.file");
  messages_ = SoundMessages();
  ChangeAll<image_t>(channel::kCameraRight, [](image_t* message) {
    message->encoding = image_t::ENCODING_RAW_GRAY8;
    message->width = 192;
    message->height = 320;
    message->num_bytes = 192 * 320;
    message->data.assign(192 * 320, 100);
  });
  ExpectOneError(
      "CAMERA_RIGHT 0: error: is of 192 x 320 px, CALIBRATION is for 320 x 192 px: width "
      "and height are exchanged",
      "images.size");
}

TEST_F(UserCases, Case88bTheCalibrationIsOfAnotherResolution) {
  ChangeAll<stereo_calibration_t>(channel::kCalibration, [](stereo_calibration_t* message) {
    message->width *= 2;
    message->height *= 2;
  });
  const std::string text = Check(CheckOptions::Depth::kQuick);
  EXPECT_TRUE(Holds(text,
                    "CAMERA_LEFT 0: error: is of 320 x 192 px, CALIBRATION is for 640 x 384 px: "
                    "another resolution"))
      << text;
}

TEST_F(UserCases, Case95AnyNameIsLegal) {
  std::vector<Envelope> mixed;
  const std::vector<std::string> names{"MY CAM", " ",     "A.*B",          "[x",
                                       "(a|b",   "a\\b$", "K\xc3\xa4mera", std::string(100, 'n')};
  std::size_t i = 0;
  for (const Envelope& message : messages_) {
    mixed.push_back(message);
    mixed.push_back({names[i++ % names.size()], {'h', 'e', 'l', 'l', 'o'}});
  }
  // Other writers give longer names than ours does: by hand.
  std::ofstream file(path_, std::ios::binary);
  std::int64_t number = 0;
  for (const Envelope& message : mixed) {
    const auto write = [&](std::uint64_t value, int size) {
      for (int k = size - 1; k >= 0; --k) file.put(static_cast<char>(value >> (8 * k)));
    };
    write(0xEDA1DA01, 4);
    write(static_cast<std::uint64_t>(number++), 8);
    write(0, 8);
    write(message.channel.size(), 4);
    write(message.payload.size(), 4);
    file << message.channel;
    file.write(reinterpret_cast<const char*>(message.payload.data()),
               static_cast<std::streamsize>(message.payload.size()));
  }
  file.close();
  EventLogReader reader(path_);
  std::set<std::string> found;
  while (const auto event = reader.Next()) found.insert(event->channel);
  for (const std::string& name : names) EXPECT_EQ(found.count(name), 1u) << name;
  EXPECT_EQ(reader.num_lost(), 0);
  EXPECT_EQ(reader.num_bytes_skipped(), 0);
  CheckOptions options;
  options.max_frames = 2;
  options.odometry_frames = 0;
  CheckLog(path_, options, &findings_);
  EXPECT_EQ(findings_.count(Severity::kError) + findings_.count(Severity::kWarning), 0);
}

TEST_F(UserCases, TypesOfAnotherVersionAreNamedByTheirFingerprints) {
  for (Envelope& message : messages_) {
    if (message.channel == channel::kCameraLeft) message.payload[0] ^= 0x10;
  }
  const std::string text = Check();
  char wanted[32];
  std::snprintf(wanted, sizeof(wanted), "%016llx",
                static_cast<unsigned long long>(image_t::getHash()));
  char found[32];
  std::snprintf(found, sizeof(found), "%016llx",
                static_cast<unsigned long long>(image_t::getHash()) ^ 0x1000000000000000ULL);
  EXPECT_TRUE(Holds(text, "has type fingerprint 0x" + std::string(found) +
                              ", this build wants image_t (0x" + wanted + ")"))
      << text;
  EXPECT_TRUE(Holds(text, "so 14 of 14 messages [log.type]")) << text;
  EXPECT_EQ(findings_.count(Severity::kError), 2) << text;  // and no image can be used
  messages_ = SoundMessages();
  Rename([](const std::string& name) {
    if (name == channel::kCameraRight) return std::string(channel::kPersonMask);
    return name == channel::kPersonMask ? std::string(channel::kCameraRight) : name;
  });
  EXPECT_TRUE(Holds(Check(), "CAMERA_RIGHT has type person_mask_t")) << Check();
}

TEST_F(UserCases, OutputsInALogAreNamed) {
  messages_.push_back({channel::kStateEstimate, {1, 2, 3}});
  EXPECT_EQ(Check(), "");
  const auto& all = findings_.findings();
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), [](const Finding& finding) {
    return finding.kind == "log.outputs" && Holds(finding.what, "STATE_ESTIMATE") &&
           Holds(finding.what, "airdos-record --inputs-only");
  }));
}

TEST_F(UserCases, ARecordingOfALogThatWasPlayedTwice) {
  const std::vector<Envelope> once = messages_;
  messages_.insert(messages_.end(), once.begin(), once.end());
  const std::string text = Check();
  EXPECT_TRUE(Holds(text, "CAMERA_LEFT 0: error: comes after number 13: its session starts again"))
      << text;
}

TEST_F(UserCases, FilesOfOtherKindsAreNamed) {
  const std::vector<std::pair<std::string, std::string>> files{
      {std::string("#ROSBAG V2.0\n") + '\0', "is a ROS bag"},
      {std::string("\0\0\0\x20", 4) + "ftypisom" + std::string(20, '\0'), "is a video"},
      {"\x1f\x8b\x08zzz", "is compressed: unpack it first"},
      {"\x28\xb5\x2f\xfdzzz", "is compressed: unpack it first"},
      {"timestamp, x, y\n", "is a text file"},
      {"", "holds no LCM event (0 bytes)"}};
  for (const auto& [bytes, what] : files) {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
    EXPECT_TRUE(Holds(WhyUnusable(path_), path_ + ": " + what)) << WhyUnusable(path_);
    EXPECT_THROW(CheckLog(path_, {}, &findings_), InputError);
  }
  EXPECT_TRUE(Holds(WhyUnusable(folder_.string()), "is a folder"));
  EXPECT_TRUE(Holds(WhyUnusable("/dev/zero"), "is a pipe or a device"));
  const std::string fifo = (folder_ / "fifo").string();
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_TRUE(Holds(WhyUnusable(fifo), "is a pipe or a device"));  // and it does not hang
}

/// Session and number of all messages, and whether apart from sessions they are those of the log.
std::vector<std::int64_t> SessionsPlayed(FrameSource* source,
                                         const std::vector<Envelope>& messages) {
  std::vector<std::int64_t> sessions;
  std::size_t i = 0;
  for (auto frame = source->NextFrame(); !frame.empty(); frame = source->NextFrame()) {
    for (Envelope& message : frame) {
      const Header header = *PeekHeader(message.payload.data(), message.payload.size());
      if (sessions.empty() || sessions.back() != header.session) sessions.push_back(header.session);
      const Envelope& original = messages.at(i++);
      Header before = *PeekHeader(original.payload.data(), original.payload.size());
      before.session = header.session;
      std::vector<std::uint8_t> expected = original.payload;
      WriteHeader(before, expected.data(), expected.size());
      EXPECT_EQ(message.channel, original.channel);
      EXPECT_EQ(message.payload, expected);
    }
  }
  EXPECT_EQ(i, messages.size());
  return sessions;
}

TEST_F(UserCases, ALogIsPlayedAgainAsNewSessions) {
  const std::vector<Envelope> once = messages_;
  ChangeHeaders([](const std::string&, Header* header) { header->session = 2; });
  messages_.insert(messages_.begin(), once.begin(), once.end());  // sessions 5, then 2
  Write();
  PlayerOptions options;
  options.data = path_;
  EXPECT_EQ(SessionsPlayed(OpenPlayerSource(options, 1000).get(), messages_),
            (std::vector<std::int64_t>{5, 2}));
  options.num_loops = 2;
  EXPECT_EQ(SessionsPlayed(OpenPlayerSource(options, 1000).get(), messages_),
            (std::vector<std::int64_t>{1000, 1001}));
  options.num_loops = 1;
  options.session = 70;
  EXPECT_EQ(SessionsPlayed(OpenPlayerSource(options, 70).get(), messages_),
            (std::vector<std::int64_t>{70, 71}));

  const std::string written = (folder_ / "written.lcm").string();
  WriteLog(written, OpenPlayerSource(options, 70).get(), ProcessLog("player", LogLevel::kError));
  LogSource again(written);
  EXPECT_EQ(SessionsPlayed(&again, messages_), (std::vector<std::int64_t>{70, 71}));
}

}  // namespace
}  // namespace airdos
