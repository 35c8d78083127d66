// What the player makes of a sequence, field by field with values that all differ; and which of its
// frames it plays.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/pose_t.hpp"
#include "airdos/process_status_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "common/util/error.h"
#include "processes/node/live/process_usage.h"
#include "processes/node/log/event_log.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/stereo_player/dataset_source.h"
#include "processes/stereo_player/player_loop.h"
#include "processes/stereo_player/stereo_player.h"
#include "tests/node/fake_nodes.h"
#include "tests/support/small_sequence.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;
using Encoding = ImagePackerOptions::Encoding;

/// 64 x 48 pixels of one gray, or of noise that no encoder makes small.
std::vector<std::uint8_t> ImageFile(const std::string& extension, int gray, bool is_noise = false) {
  cv::Mat image(48, 64, CV_8UC1, cv::Scalar(gray));
  if (is_noise) {
    cv::RNG random(1);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
  }
  std::vector<std::uint8_t> file;
  cv::imencode(extension, image, file);
  return file;
}

class OneFrame : public StereoSequence {
 public:
  OneFrame() {
    frame.left_image_file = ImageFile(".jpg", 50);
    frame.right_image_file = ImageFile(".jpg", 150);
    frame.utime = 7654321;
  }
  const StereoCamera& camera() const override { return camera_; }
  std::size_t num_frames() const override { return 100; }
  TrajectoryAxes ground_truth_axes() const override { return axes; }
  bool has_people() const override { return true; }
  SequenceFrame Load(std::size_t) const override { return frame; }
  SequenceFrame frame;
  TrajectoryAxes axes = TrajectoryAxes::kUnknown;

 private:
  StereoCamera camera_{64, 48, 51.5, 52.5, 31.25, 23.75, 0.375};
};

template <class Message>
Message Find(const StereoPlayer::Frame& frame, const std::string& channel) {
  Message message = {};
  for (const Envelope& envelope : frame.messages) {
    if (envelope.channel != channel) continue;
    EXPECT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
    EXPECT_EQ(message.utime, 7654321);
    EXPECT_EQ(message.seq, 17);
    EXPECT_EQ(message.session, 9);
    return message;
  }
  ADD_FAILURE() << "nothing on " << channel;
  return message;
}

TEST(PlayerBooksTest, EachImageAndTheCalibrationHaveTheirOwnValues) {
  OneFrame sequence;
  const StereoPlayer::Frame frame = StereoPlayer(&sequence, 9, {}).Load(17);
  EXPECT_EQ(frame.header.utime, 7654321);
  EXPECT_EQ(frame.header.seq, 17);
  EXPECT_EQ(frame.header.session, 9);
  const auto left = Find<image_t>(frame, channel::kCameraLeft);
  const auto right = Find<image_t>(frame, channel::kCameraRight);
  EXPECT_EQ(left.data, sequence.frame.left_image_file);
  EXPECT_EQ(right.data, sequence.frame.right_image_file);
  EXPECT_EQ(left.width, 64);
  EXPECT_EQ(left.height, 48);
  const auto calibration = Find<stereo_calibration_t>(frame, channel::kCalibration);
  EXPECT_EQ(calibration.fx_px, 51.5);
  EXPECT_EQ(calibration.fy_px, 52.5);
  EXPECT_EQ(calibration.cx_px, 31.25);
  EXPECT_EQ(calibration.cy_px, 23.75);
  EXPECT_EQ(calibration.baseline_m, 0.375);
}

TEST(PlayerBooksTest, PeopleOfLeftAndRightKeepTheirNumbers) {
  OneFrame sequence;
  PersonKeypoints left(18);
  PersonKeypoints right(18);
  left[4] = {10, 20, 0.5F};
  right[5] = {30, 40, -0.25F};
  sequence.frame.keypoints_left = {left};
  sequence.frame.keypoints_right = {right, left};
  sequence.frame.person_mask_file = ImageFile(".png", 255);
  const StereoPlayer::Frame frame = StereoPlayer(&sequence, 9, {}).Load(17);
  const auto on_left = Find<person_keypoints_t>(frame, channel::kPersonKeypointsLeft);
  ASSERT_EQ(on_left.num_people, 1);
  EXPECT_EQ(on_left.u_px[0][4], 10);
  EXPECT_EQ(on_left.v_px[0][4], 20);
  EXPECT_EQ(on_left.confidence[0][4], 0.5F);
  const auto on_right = Find<person_keypoints_t>(frame, channel::kPersonKeypointsRight);
  ASSERT_EQ(on_right.num_people, 2);
  EXPECT_EQ(on_right.u_px[0][5], 30);
  EXPECT_EQ(on_right.v_px[0][5], 40);
  EXPECT_EQ(on_right.confidence[0][5], 0) << "detectors give scores slightly below 0";
  const auto mask = Find<person_mask_t>(frame, channel::kPersonMask);
  EXPECT_EQ(mask.width, 64);
  EXPECT_EQ(mask.height, 48);
  EXPECT_EQ(mask.data, sequence.frame.person_mask_file);
}

TEST(PlayerBooksTest, GroundTruthHasItsAxes) {
  OneFrame sequence;
  sequence.frame.ground_truth = Se3{Eigen::Quaterniond(0.1, 0.5, -0.5, 0.7), {1, 2, 3}};
  const std::pair<TrajectoryAxes, std::int8_t> all[] = {
      {TrajectoryAxes::kOptical, pose_t::AXES_OPTICAL},
      {TrajectoryAxes::kNed, pose_t::AXES_NED},
      {TrajectoryAxes::kUnknown, pose_t::AXES_UNKNOWN}};
  for (const auto& [axes, expected] : all) {
    sequence.axes = axes;
    const auto truth = Find<pose_t>(StereoPlayer(&sequence, 9, {}).Load(17), channel::kGroundTruth);
    EXPECT_EQ(truth.axes, expected);
    EXPECT_EQ(truth.position[1], 2);
    EXPECT_NEAR(truth.orientation[3], 0.7, 1e-12);
  }
}

// A data set whose times go back begins anew.
TEST(PlayerBooksTest, TheCalibrationComesAgainWhereTimesGoBack) {
  OneFrame sequence;
  StereoPlayer player(&sequence, 9, {});
  std::string text;
  for (const std::int64_t utime : {5000000, 5999999, 6000000, 5500000, 6499999, 6500000}) {
    sequence.frame.utime = utime;
    text += player.Load(0).messages[0].channel == channel::kCalibration ? "yes " : "no ";
  }
  EXPECT_EQ(text, "yes no yes yes no yes ");
}

struct Packed {
  image_t message;
  std::vector<std::string> notes;
};

Packed Pack(const std::vector<std::uint8_t>& file, Encoding encoding, int max_bytes) {
  ImagePackerOptions options;
  options.encoding = encoding;
  options.max_image_bytes = max_bytes;
  ImagePacker packer(options);
  Packed packed;
  packer.Pack(file, "f", &packed.message);
  packed.notes = packer.TakeNotes();
  return packed;
}

TEST(ImagePackerBooksTest, WhatTravelsInWhichEncoding) {
  const std::vector<std::uint8_t> jpeg = ImageFile(".jpg", 0, true);
  const std::vector<std::uint8_t> png = ImageFile(".png", 0, true);
  const int large = 100000;
  const int small = static_cast<int>(std::min(jpeg.size(), png.size())) - 1;
  EXPECT_EQ(Pack(jpeg, Encoding::kAuto, large).message.data, jpeg);
  EXPECT_EQ(Pack(jpeg, Encoding::kJpeg, large).message.data, jpeg);
  EXPECT_EQ(Pack(jpeg, Encoding::kPng, large).message.encoding, +image_t::ENCODING_PNG);
  EXPECT_EQ(Pack(png, Encoding::kAuto, large).message.data, png);
  EXPECT_EQ(Pack(png, Encoding::kPng, large).message.data, png);
  EXPECT_EQ(Pack(png, Encoding::kJpeg, large).message.encoding, +image_t::ENCODING_JPEG);
  EXPECT_TRUE(Pack(png, Encoding::kPng, large).notes.empty());

  const Packed shrunk = Pack(png, Encoding::kAuto, small);
  EXPECT_EQ(shrunk.message.encoding, +image_t::ENCODING_JPEG);
  EXPECT_LE(shrunk.message.num_bytes, small);
  const Packed lossless = Pack(png, Encoding::kPng, small);
  EXPECT_EQ(lossless.message.data, png);
  EXPECT_EQ(lossless.notes, std::vector<std::string>{"PNG images above the limit: receivers need a "
                                                     "large socket buffer"});
}

// An image of 16 bits is none that a receiver reads, however small it is.
TEST(ImagePackerBooksTest, SixteenBitsDoNotTravelUnchanged) {
  std::vector<std::uint8_t> file;
  cv::imencode(".png", cv::Mat(48, 64, CV_16UC1, cv::Scalar(16 * 77)), file);
  ImagePackerOptions options;
  options.encoding = Encoding::kPng;
  ImagePacker packer(options);
  packer.SetSixteenBitRange({12});
  image_t message = {};
  packer.Pack(file, "f", &message);
  const cv::Mat image = cv::imdecode(message.data, cv::IMREAD_UNCHANGED);
  EXPECT_EQ(image.type(), CV_8UC1);
  EXPECT_EQ(image.at<std::uint8_t>(20, 30), 77);
}

// ---- Which frames are played, and how they lie in a log ----

class PlayerFilesTest : public testing::Test {
 protected:
  PlayerFilesTest() : folder_(testing::TempDir() + "airdos_player_" + std::to_string(getpid())) {
    fs::create_directories(folder_);
  }
  ~PlayerFilesTest() override { fs::remove_all(folder_); }
  static std::string Seqs(DatasetSource* source) {
    std::string text;
    for (auto frame = source->NextFrame(); !frame.empty(); frame = source->NextFrame()) {
      const Envelope& message = frame.back();
      text += std::to_string(PeekHeader(message.payload.data(), message.payload.size())->seq) + " ";
    }
    return text;
  }
  std::string folder_;
};

TEST_F(PlayerFilesTest, AFolderIsPlayedFromTheFirstToTheLastAndNotFurther) {
  SmallSequence::Make().Write(folder_ + "/data");  // frames 0 to 13
  fs::remove(folder_ + "/data/times.txt");         // then it says what it takes for granted
  const auto seqs = [&](std::int64_t first, std::int64_t last) {
    DatasetSource source(folder_ + "/data", first, last, 9, {}, "");
    return Seqs(&source);
  };
  EXPECT_EQ(seqs(3, 5), "3 4 5 ");
  EXPECT_EQ(seqs(-7, 1), "0 1 ");
  EXPECT_EQ(seqs(12, 1000), "12 13 ");
  EXPECT_THROW(seqs(14, 1000), InputError);
  EXPECT_THROW(seqs(5, 4), InputError);

  DatasetSource source(folder_ + "/data", 4, 7, 9, {}, "");
  EXPECT_EQ(source.fraction_done(), 0);
  EXPECT_FALSE(source.TakeNotes().empty());
  source.NextFrame();
  EXPECT_EQ(source.fraction_done(), 0.25);
  EXPECT_TRUE(source.TakeNotes().empty()) << "said once";
  Seqs(&source);
  EXPECT_EQ(source.fraction_done(), 1);
}

/// A frame with a message of the one before, which came late; then another, the other way round.
class TwoFrames : public FrameSource {
 public:
  std::vector<Envelope> NextFrame() override {
    ++num_;
    if (num_ == 1) return {TextEnvelope("A", 3, "x"), TextEnvelope("B", 2, "x")};
    if (num_ == 2) return {TextEnvelope("B", 3, "x"), TextEnvelope("A", 4, "x")};
    return {};
  }
  double fraction_done() const override { return 0; }
  std::vector<std::string> TakeNotes() override { return {}; }

 private:
  int num_ = 0;
};

/// Four frames of one large message each, all taken at once.
class LargeFrames : public FrameSource {
 public:
  static constexpr std::size_t kBytes = 1000000;
  std::vector<Envelope> NextFrame() override {
    if (num_ == 4) return {};
    frame_done_t message = TextMessage(num_++, std::string(kBytes, 'x'));
    message.utime = 0;
    return {{"LARGE", Encode(message)}};
  }
  double fraction_done() const override { return 0; }
  std::vector<std::string> TakeNotes() override { return {}; }

 private:
  std::int64_t num_ = 0;
};

TEST(PlayerLoopTest, GoesNoFasterThanReceiversBuffersAreEmptied) {
  constexpr double kMaxBytesPerSecond = 30e6;
  PlayerOptions options;
  options.pace = PlayerPace::kRealtime;
  options.gate.wait_for.clear();
  LcmTransport transport("memq://");
  std::ostringstream said;
  const ProcessLog log("player", LogLevel::kInfo, LogStyle::kJournal, &said, nullptr);
  PlayerLoop loop(
      options, [](int) { return std::make_unique<LargeFrames>(); }, &transport, &log);
  const double start_s = SteadyClock_s();
  loop.Run();
  EXPECT_GE(SteadyClock_s() - start_s, 4 * LargeFrames::kBytes / kMaxBytesPerSecond);
  EXPECT_NE(said.str().find("published 4 frames"), std::string::npos) << said.str();
}

/// Three frames five seconds apart; before the last one, somebody says that it is at the first.
class SlowReader : public FrameSource {
 public:
  explicit SlowReader(LcmTransport* transport) : transport_(transport) {}
  std::vector<Envelope> NextFrame() override {
    if (num_ == 3) return {};
    if (num_ == 2) {
      auto status = MessageOf<process_status_t>({0, 0, 7});
      status.process = "slow";
      status.state = process_status_t::STATE_READY;
      status.num_frames_done = 1;
      const std::vector<std::uint8_t> bytes = Encode(status);
      transport_->Publish(channel::kStatus, bytes.data(), bytes.size());
    }
    frame_done_t message = TextMessage(num_, "x");
    message.utime = 5000000 * num_++;
    return {{"A", Encode(message)}};
  }
  double fraction_done() const override { return 0; }
  std::vector<std::string> TakeNotes() override { return {}; }

 private:
  LcmTransport* transport_;
  std::int64_t num_ = 0;
};

TEST(PlayerLoopTest, InRealtimePaceItSaysThatProcessesFallBehind) {
  PlayerOptions options;
  options.pace = PlayerPace::kRealtime;
  options.speed = 1000;
  options.gate.wait_for.clear();
  LcmTransport transport("memq://");
  std::ostringstream said;
  const ProcessLog log("player", LogLevel::kInfo, LogStyle::kJournal, &said, nullptr);
  PlayerLoop loop(
      options, [&](int) { return std::make_unique<SlowReader>(&transport); }, &transport, &log);
  loop.Run();
  EXPECT_NE(said.str().find("<4>5.0 s behind, growing: slow has done image 0 of 1"),
            std::string::npos)
      << said.str();
}

TEST_F(PlayerFilesTest, EventsHaveTheTimeOfTheNewestMessageOfTheirFrame) {
  TwoFrames source;
  std::ostringstream said;
  const std::string path = folder_ + "/out.lcm";
  WriteLog(path, &source,
           ProcessLog("player", LogLevel::kInfo, LogStyle::kJournal, &said, nullptr));
  EventLogReader reader(path);
  std::string text;
  while (const auto event = reader.Next()) {
    text += std::to_string(event->number) + event->channel + std::to_string(event->utime) + " ";
  }
  EXPECT_EQ(text, "0A3000 1B3000 2B4000 3A4000 ");
  // Of each event 28 bytes of head and one of name, then 8 + 24 and the text with its length and
  // end.
  EXPECT_EQ(said.str(), "<6>" + path + ": 4 messages, " +
                            std::to_string(4 * (28 + 1 + 8 + 24 + 4 + 2)) + " bytes\n");
}

}  // namespace
}  // namespace airdos
