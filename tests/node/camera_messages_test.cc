// What a camera process publishes, and how it tells that the others fall behind.
#include "processes/stereo_camera/camera_messages.h"

#include <gtest/gtest.h>

#include <memory>
#include <opencv2/imgproc.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "airdos/image_t.hpp"
#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/process_status_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "processes/node/live/lag_watch.h"
#include "processes/node/message/image_codec.h"
#include "processes/stereo_camera/camera_loop.h"

namespace airdos {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

StereoRig Rig() {
  StereoRig rig;
  rig.left.width = kWidth;
  rig.left.height = kHeight;
  rig.left.fx_px = rig.left.fy_px = 250;
  rig.left.cx_px = 160;
  rig.left.cy_px = 120;
  rig.left.lens = LensModel::kRadialTangential;
  rig.left.distortion = {-0.2, 0.05, 0, 0};
  rig.right = rig.left;
  rig.right.cy_px = 117;
  rig.T_L_R.translation = {0.2, 0, 0};
  return rig;
}

/// Colour noise, which compresses badly, on request.
CapturedPair MakePair(std::int64_t utime, bool is_noisy = false) {
  CapturedPair pair;
  pair.utime = utime;
  cv::RNG generator(7);
  for (cv::Mat* image : {&pair.left, &pair.right}) {
    *image = cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(50, 100, 150));
    if (is_noisy) generator.fill(*image, cv::RNG::UNIFORM, 0, 255);
    cv::circle(*image, {160, 100}, image == &pair.left ? 50 : 40, {200, 30, 30}, 3);
  }
  return pair;
}

template <class Message>
Message Only(const std::string& channel, const std::vector<Envelope>& messages) {
  Message message{};
  int count = 0;
  for (const Envelope& envelope : messages) {
    if (envelope.channel != channel) continue;
    ++count;
    EXPECT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message)) << channel;
    EXPECT_EQ(Validate(message), "") << channel;
  }
  EXPECT_EQ(count, 1) << channel;
  return message;
}

std::vector<std::string> ChannelsOf(const std::vector<Envelope>& messages) {
  std::vector<std::string> channels;
  for (const Envelope& envelope : messages) channels.push_back(envelope.channel);
  return channels;
}

using Channels = std::vector<std::string>;

TEST(CameraMessagesTest, ImagesAreRectifiedAndCountedAndTheCalibrationIsTheirs) {
  const StereoRectifier rectifier(Rig());
  CameraMessageOptions options;
  options.session = 77;
  options.is_lossless = true;
  CameraMessages camera(&rectifier, options);
  const CapturedPair pair = MakePair(5000000);
  const std::vector<Envelope> first = camera.Pack(pair);
  EXPECT_EQ(ChannelsOf(first), (Channels{"CALIBRATION", "CAMERA_LEFT", "CAMERA_RIGHT"}));
  const auto left = Only<image_t>("CAMERA_LEFT", first);
  const auto right = Only<image_t>("CAMERA_RIGHT", first);
  EXPECT_EQ(cv::norm(*DecodeColor(left), rectifier.Left(pair.left), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(*DecodeColor(right), rectifier.Right(pair.right), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(*DecodeColor(left), pair.left, cv::NORM_INF), 50);
  const auto calibration = Only<stereo_calibration_t>("CALIBRATION", first);
  EXPECT_EQ(calibration.fx_px, rectifier.camera().fx_px);
  EXPECT_NEAR(calibration.baseline_m, 0.2, 1e-12);
  for (const Header& header : {HeaderOf(left), HeaderOf(right), HeaderOf(calibration)}) {
    EXPECT_EQ(header.session, 77);
    EXPECT_EQ(header.seq, 0);
    EXPECT_EQ(header.utime, 5000000);
  }
  EXPECT_EQ(Only<image_t>("CAMERA_RIGHT", camera.Pack(MakePair(5100000))).seq, 1);
  EXPECT_EQ(camera.newest()->utime, 5100000);
}

TEST(CameraMessagesTest, TheCalibrationComesOnceASecond) {
  const StereoRectifier rectifier(Rig());
  CameraMessages camera(&rectifier, {});
  std::vector<std::size_t> sizes;
  for (const std::int64_t utime : {0, 500000, 999999, 1000000, 1900000, 9000000}) {
    sizes.push_back(camera.Pack(MakePair(utime)).size());
  }
  EXPECT_EQ(sizes, (std::vector<std::size_t>{3, 2, 2, 3, 2, 3}));
}

TEST(CameraMessagesTest, NobodyIsPublishedOnRequest) {
  const StereoRectifier rectifier(Rig());
  CameraMessageOptions options;
  options.publishes_nobody = true;
  CameraMessages camera(&rectifier, options);
  const std::vector<Envelope> messages = camera.Pack(MakePair(1));
  EXPECT_EQ(Only<person_keypoints_t>("PERSON_KEYPOINTS_LEFT", messages).num_people, 0);
  EXPECT_EQ(Only<person_keypoints_t>("PERSON_KEYPOINTS_RIGHT", messages).num_people, 0);
  EXPECT_EQ(Only<person_mask_t>("PERSON_MASK", messages).encoding,
            int{person_mask_t::ENCODING_NONE});
}

TEST(CameraMessagesTest, TheQualityIsLoweredUntilImagesFitAndRaisedAgain) {
  const StereoRectifier rectifier(Rig());
  CameraMessageOptions options;
  options.max_image_bytes = 60000;
  options.jpeg_qualities = {95, 60, 30};
  CameraMessages camera(&rectifier, options);
  const auto bytes = [&](std::int64_t utime, bool is_noisy) {
    return Only<image_t>("CAMERA_LEFT", camera.Pack(MakePair(utime, is_noisy))).num_bytes;
  };
  const int good = bytes(0, false);
  EXPECT_EQ(camera.TakeNotes(), Channels{});
  EXPECT_LE(bytes(1, true), 60000);
  const std::vector<std::string> notes = camera.TakeNotes();
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("JPEG with quality"), std::string::npos) << notes[0];
  EXPECT_LT(bytes(2, false), good) << "the quality stays as it was found";
  for (int i = 3; i < 100; ++i) bytes(i, false);
  EXPECT_EQ(bytes(100, false), good) << "a better one is tried now and then";
}

TEST(CameraMessagesTest, WhatDoesNotFitIsLeftOutWithoutAGap) {
  const StereoRectifier rectifier(Rig());
  CameraMessageOptions options;
  options.max_image_bytes = 15000;
  CameraMessages camera(&rectifier, options);
  EXPECT_TRUE(camera.Pack(MakePair(0, true)).empty());
  EXPECT_TRUE(camera.Pack(MakePair(1, true)).empty());
  EXPECT_EQ(camera.TakeNotes().size(), 1u);
  const std::vector<Envelope> messages = camera.Pack(MakePair(2));
  EXPECT_EQ(ChannelsOf(messages), (Channels{"CALIBRATION", "CAMERA_LEFT", "CAMERA_RIGHT"}));
  EXPECT_EQ(Only<image_t>("CAMERA_LEFT", messages).seq, 0);
  CameraMessages other(&rectifier, options);
  EXPECT_LT(Only<image_t>("CAMERA_LEFT", messages).num_bytes,
            Only<image_t>("CAMERA_LEFT", other.Pack(MakePair(2))).num_bytes)
      << "the last quality that was tried is gone on with";
}

process_status_t StatusOf(const std::string& process, std::int64_t seq, std::int64_t utime) {
  auto status = MessageOf<process_status_t>({utime, seq, 5});
  status.process = process;
  status.state = process_status_t::STATE_READY;
  status.num_frames_done = seq + 1;
  return status;
}

TEST(LagWatchTest, SaysALagThatGrowsAndItsEnd) {
  LagWatch watch;
  watch.OnStatus(StatusOf("slow", 1, 0));
  EXPECT_EQ(watch.TakeNotes(), Channels{}) << "nothing was published";
  watch.OnPublished({10000000, 100, 5});
  watch.OnStatus(StatusOf("slow", 91, 9001000));
  EXPECT_EQ(watch.TakeNotes(), Channels{}) << "below a second";
  watch.OnStatus(StatusOf("slow", 77, 7700000));
  watch.OnStatus(StatusOf("fast", 99, 9900000));
  EXPECT_EQ(watch.TakeNotes(),
            Channels{"warning: 2.3 s behind, growing: slow has done image 77 of 100"});
  watch.OnPublished({20000000, 200, 5});
  watch.OnStatus(StatusOf("slow", 162, 16200000));
  EXPECT_EQ(watch.TakeNotes(), Channels{}) << "a little more is not said";
  watch.OnStatus(StatusOf("slow", 160, 16000000));
  EXPECT_EQ(watch.TakeNotes(),
            Channels{"warning: 4.0 s behind, growing: slow has done image 160 of 200"});
  watch.OnStatus(StatusOf("slow", 190, 19000000));
  watch.OnStatus(StatusOf("fast", 200, 20000000));
  EXPECT_EQ(watch.TakeNotes(), Channels{}) << "not yet";
  watch.OnStatus(StatusOf("slow", 196, 19600000));
  EXPECT_EQ(watch.TakeNotes(), Channels{"all processes have caught up"});
  watch.OnStatus(StatusOf("slow", 200, 20000000));
  EXPECT_EQ(watch.TakeNotes(), Channels{});
}

TEST(LagWatchTest, WhoHasNothingToDoWithItCountsForNothing) {
  LagWatch watch;
  watch.OnPublished({90000000, 900, 5});
  process_status_t other = StatusOf("other session", 1, 100000);
  other.session = 6;
  process_status_t idle = StatusOf("idle", 0, 0);
  idle.num_frames_done = 0;
  process_status_t leaving = StatusOf("leaving", 1, 100000);
  leaving.state = process_status_t::STATE_STOPPING;
  for (const process_status_t& status : {other, idle, leaving}) watch.OnStatus(status);
  EXPECT_EQ(watch.TakeNotes(), Channels{});
}

/// A damaged pair, pairs at once, and then the end.
class BurstGrabber : public FrameGrabber {
 public:
  explicit BurstGrabber(int count) : left_(count) {}
  std::string name() const override { return "burst"; }
  std::pair<int, int> image_size() const override { return {kWidth, kHeight}; }
  Grabbed Grab() override {
    if (left_ == 0) return {Grabbed::State::kEnded, {}, ""};
    if (!is_damage_over_) {
      is_damage_over_ = true;
      return {Grabbed::State::kUnusable, {}, "burst: half an image"};
    }
    return {Grabbed::State::kPair, MakePair(1000 * (100 - left_--)), ""};
  }
  std::string Reopen() override { return ""; }

 private:
  int left_;
  bool is_damage_over_ = false;
};

TEST(CameraLoopTest, WhatWasCapturedIsPublishedOrCountedAsDropped) {
  constexpr int kPairs = 12;
  LcmTransport transport("memq://");
  std::set<std::int64_t> left, right;
  process_status_t last{};
  // All of them: the loop itself has a handler for STATUS.
  transport.SubscribeAll([&](const std::string& channel, const void* data, std::size_t size, auto) {
    if (channel == "STATUS") {
      ASSERT_TRUE(Decode(data, size, &last));
      EXPECT_EQ(Validate(last), "");
    } else if (channel == "CAMERA_LEFT" || channel == "CAMERA_RIGHT") {
      image_t image;
      ASSERT_TRUE(Decode(data, size, &image));
      EXPECT_TRUE((channel == "CAMERA_LEFT" ? left : right).insert(image.seq).second);
    }
  });
  std::ostringstream said;
  const ProcessLog log("camera", LogLevel::kInfo, LogStyle::kJournal, &said, [] { return 0; });
  const StereoRectifier rectifier(Rig());
  CameraMessages messages(&rectifier, {});
  CameraCapture capture(std::make_unique<BurstGrabber>(kPairs), {}, 0, [] { return 0; });
  while (capture.Step()) {
  }
  CameraLoop loop(&capture, &messages, 0, &transport, &log, "");
  EXPECT_EQ(loop.Run(), 0);
  while (transport.Poll(0)) {
  }
  const CaptureCounters counters = capture.counters();
  EXPECT_EQ(counters.num_captured, kPairs);
  EXPECT_EQ(messages.num_packed() + counters.num_dropped, kPairs);
  EXPECT_GE(messages.num_packed(), 1);
  EXPECT_EQ(left.size(), static_cast<std::size_t>(messages.num_packed()));
  EXPECT_EQ(left.count(messages.num_packed() - 1), 1u) << "without gaps";
  EXPECT_EQ(left, right);
  EXPECT_EQ(last.state, int{process_status_t::STATE_STOPPING});
  EXPECT_EQ(last.num_frames_done, messages.num_packed());
  EXPECT_EQ(last.num_frames_skipped, counters.num_dropped);
  EXPECT_GT(last.num_frames_skipped, 0) << "all come before the first is taken";
  ASSERT_EQ(last.channels.size(), 1u);
  EXPECT_EQ(last.channels[0].channel, "camera");
  EXPECT_EQ(last.channels[0].num_received, kPairs + 1);
  EXPECT_EQ(last.channels[0].num_rejected, 1);
  EXPECT_EQ(last.channels[0].last_reject, "burst: half an image");
  ASSERT_GE(last.warnings.size(), 1u);
  EXPECT_EQ(last.warnings[0].find("burst: half an image: left out"), 0u) << last.warnings[0];
  EXPECT_NE(said.str().find("<6>burst: has ended"), std::string::npos) << said.str();
  EXPECT_NE(said.str().find("pairs captured 12, dropped " + std::to_string(counters.num_dropped) +
                            ", published " + std::to_string(messages.num_packed())),
            std::string::npos)
      << said.str();
}

}  // namespace
}  // namespace airdos
