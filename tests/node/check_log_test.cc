#include "processes/node/check/check_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "airdos/image_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "common/check/check_jpeg.h"
#include "common/util/error.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/stereo_player/dataset_source.h"
#include "tests/node/small_log_test.h"
#include "tests/support/small_sequence.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

class CheckLogTest : public SmallLogTest {
 protected:
  CheckLogTest() : SmallLogTest("check_log", 5) {}

  std::string Check(std::size_t odometry_frames = 0) {
    CheckOptions options;
    options.max_frames = 4;
    options.odometry_frames = odometry_frames;
    findings_ = FindingList();
    CheckLog(path_, options, &findings_);
    std::ostringstream text;
    findings_.Print(path_, &text);
    return text.str();
  }

  /// There is a finding of this kind and severity that names `place`.
  void Expect(Severity severity, const std::string& kind, const std::string& place) {
    Write();
    const std::string text = Check();
    const auto& all = findings_.findings();
    EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                            [&](const Finding& finding) {
                              return finding.severity == severity && finding.kind == kind &&
                                     finding.where.find(place) != std::string::npos;
                            }))
        << kind << "\n"
        << text;
    EXPECT_TRUE(severity != Severity::kError || findings_.has_errors());
  }

  /// Number `index` of the messages on a channel.
  std::vector<Envelope>::iterator Find(const std::string& channel, int index) {
    for (auto it = messages_.begin(); it != messages_.end(); ++it) {
      if (it->channel == channel && index-- == 0) return it;
    }
    ADD_FAILURE() << "no such message on " << channel;
    return messages_.begin();
  }
  /// Decodes a message, has it changed, and puts it back.
  template <class Message>
  void Change(Envelope* envelope, const std::function<void(Message*)>& change) {
    Message message;
    ASSERT_TRUE(Decode(envelope->payload.data(), envelope->payload.size(), &message));
    change(&message);
    envelope->payload = Encode(message);
  }
};

TEST_F(CheckLogTest, ASoundLogHasNothingButNotes) {
  Write();
  const std::string text = Check(SmallSequence::kNumFrames);
  EXPECT_EQ(findings_.count(Severity::kError), 0) << text;
  EXPECT_EQ(findings_.count(Severity::kWarning), 0) << text;
  EXPECT_NE(text.find("NED, and visual odometry agrees"), std::string::npos) << text;
  EXPECT_NE(text.find("100 % of the keypoints lie in them"), std::string::npos) << text;
}

TEST_F(CheckLogTest, WhatIsNoLogIsABadArgument) {
  EXPECT_THROW(Check(), InputError);
  std::ofstream(path_) << "no log";
  EXPECT_THROW(Check(), InputError);
}

TEST_F(CheckLogTest, RejectedMessages) {
  Find(channel::kPersonMask, 2)->payload.resize(20);
  Expect(Severity::kError, "log.rejected", "event");
  messages_ = SoundMessages();
  Change<image_t>(&*Find(channel::kCameraLeft, 0), [](image_t* m) { m->width = 321; });
  Expect(Severity::kError, "images.file", "CAMERA_LEFT 0");
}

TEST_F(CheckLogTest, OrderRepetitionAndGaps) {
  std::iter_swap(Find(channel::kCameraRight, 3), Find(channel::kCameraRight, 4));
  Expect(Severity::kError, "log.order", "CAMERA_RIGHT 3");
  messages_ = SoundMessages();
  messages_.insert(Find(channel::kCameraLeft, 3), *Find(channel::kCameraLeft, 3));
  Expect(Severity::kWarning, "log.repeated", "CAMERA_LEFT 3");
  messages_ = SoundMessages();
  messages_.erase(Find(channel::kPersonMask, 6));
  Expect(Severity::kWarning, "log.gap", "PERSON_MASK 7");
  EXPECT_NE(Check().find("[log.partners]"), std::string::npos) << Check();
  messages_ = SoundMessages();
  Change<image_t>(&*Find(channel::kCameraRight, 5), [](image_t* m) { m->utime += 1; });
  Expect(Severity::kError, "log.utime", "CAMERA_RIGHT 5");
}

TEST_F(CheckLogTest, Calibration) {
  Remove(channel::kCalibration);
  Expect(Severity::kError, "log.calibration", path_);
  messages_ = SoundMessages();
  const Envelope calibration = *Find(channel::kCalibration, 0);
  messages_.erase(Find(channel::kCalibration, 0));
  messages_.insert(std::next(Find(channel::kCameraLeft, 1)), calibration);
  Expect(Severity::kWarning, "log.calibration", path_);
  messages_ = SoundMessages();
  Envelope other = *Find(channel::kCalibration, 0);
  Change<stereo_calibration_t>(&other, [](stereo_calibration_t* m) { m->fx_px += 1; });
  messages_.push_back(other);
  Expect(Severity::kWarning, "log.calibration", "CALIBRATION");
}

TEST_F(CheckLogTest, WithoutImages) {
  Remove(channel::kCameraRight);
  Expect(Severity::kError, "log.count", "CAMERA_RIGHT");
  Remove(channel::kCameraLeft);
  Expect(Severity::kError, "log.images", path_);
  messages_.push_back({channel::kStaticFeatures, {1, 2, 3}});
  Expect(Severity::kWarning, "log.images", path_);
}

TEST_F(CheckLogTest, LargeMessages) {
  Change<image_t>(&*Find(channel::kCameraLeft, 0), [](image_t* m) {
    m->data.resize(140000, 0);  // decoders do not mind what follows an image
    m->num_bytes = 140000;
  });
  Expect(Severity::kWarning, "log.size", "CAMERA_LEFT");
}

TEST_F(CheckLogTest, TwoSessions) {
  std::vector<Envelope> again = SoundMessages();
  for (Envelope& message : again) {
    if (message.channel != channel::kCameraLeft) continue;
    Change<image_t>(&message, [](image_t* m) { m->session += 1; });
    messages_.push_back(message);
  }
  Expect(Severity::kWarning, "log.sessions", path_);
}

TEST_F(CheckLogTest, Damage) {
  Write();
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(30000);
  file << std::string(20000, 'x');
  file.close();
  Check();
  EXPECT_TRUE(findings_.has_errors());
  EXPECT_NE(Check().find("[log.damaged]"), std::string::npos) << Check();
}

TEST(JpegQualityTest, IsNoneOfOtherBytes) {
  EXPECT_EQ(JpegQuality({}), std::nullopt);
  EXPECT_EQ(JpegQuality({0xFF, 0xD8, 0xFF, 0xDB, 0x00}), std::nullopt);
  EXPECT_EQ(JpegQuality({0xFF, 0xD8, 0xFF, 0xDB, 0xFF, 0xFF, 0x00}), std::nullopt);
  EXPECT_EQ(JpegQuality(std::vector<std::uint8_t>(1000, 0xFF)), std::nullopt);
}

}  // namespace
}  // namespace airdos
