// How a camera process gets its pairs: devices and recordings, drops, loss and return, times; with
// fake sources and a clock that only passes when somebody waits.
#include "processes/stereo_camera/camera_capture.h"

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/util/error.h"
#include "processes/stereo_camera/device_grabber.h"
#include "processes/stereo_camera/recording_grabber.h"

namespace airdos {
namespace {

constexpr int kWidth = 8;
constexpr int kHeight = 6;
constexpr std::int64_t kOffset_us = 1000000000;

class FakeClock {
 public:
  CaptureClock clock() {
    return [this] { return now_us_; };
  }
  std::function<void(std::int64_t)> pause() {
    return [this](std::int64_t us) { now_us_ += us; };
  }
  void Pass(std::int64_t us) { now_us_ += us; }
  std::int64_t now_us() const { return now_us_; }

 private:
  std::int64_t now_us_ = 5000000;
};

cv::Mat Plain(int value, int width = kWidth, int height = kHeight) {
  return cv::Mat(height, width, CV_8UC1, cv::Scalar(value));
}

Grabbed Pair(std::int64_t utime, std::int64_t skew_us = 0, int width = kWidth) {
  Grabbed grabbed{Grabbed::State::kPair, {}, ""};
  grabbed.pair = {utime, skew_us, Plain(1, width), Plain(2, width)};
  return grabbed;
}
Grabbed Lost() { return {Grabbed::State::kLost, {}, "fake is lost"}; }
Grabbed Ended() { return {Grabbed::State::kEnded, {}, ""}; }

/// Hands out what it is told to.
class FakeGrabber : public FrameGrabber {
 public:
  struct Script {
    std::deque<Grabbed> grabs;        // then nothing
    std::deque<std::string> reopens;  // then success
    int num_reopened = 0;
  };
  explicit FakeGrabber(Script* script) : script_(script) {}
  std::string name() const override { return "fake"; }
  std::pair<int, int> image_size() const override { return {kWidth, kHeight}; }
  Grabbed Grab() override {
    if (script_->grabs.empty()) return {};
    Grabbed next = script_->grabs.front();
    script_->grabs.pop_front();
    if (next.why == "throw") throw std::runtime_error("broken");
    return next;
  }
  std::string Reopen() override {
    ++script_->num_reopened;
    if (script_->reopens.empty()) return "";
    std::string why = script_->reopens.front();
    script_->reopens.pop_front();
    return why;
  }

 private:
  Script* script_;
};

class CameraCaptureTest : public testing::Test {
 protected:
  std::unique_ptr<CameraCapture> Make() {
    return std::make_unique<CameraCapture>(std::make_unique<FakeGrabber>(&script_), options_,
                                           kOffset_us, clock_.clock(), clock_.pause());
  }
  static std::vector<std::int64_t> TakeAll(CameraCapture* capture) {
    std::vector<std::int64_t> utimes;
    while (const std::optional<CapturedPair> pair = capture->Take(0)) {
      utimes.push_back(pair->utime - kOffset_us);
    }
    return utimes;
  }
  static std::string Notes(CameraCapture* capture) {
    std::string all;
    for (const std::string& note : capture->TakeNotes()) all += note + "\n";
    return all;
  }

  FakeClock clock_;
  FakeGrabber::Script script_;
  CameraCaptureOptions options_;
};

using Utimes = std::vector<std::int64_t>;

TEST_F(CameraCaptureTest, PairsComeInOrderWithTheTimeOfTheirCapture) {
  script_.grabs = {Pair(10), {}, Pair(20)};
  const auto capture = Make();
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(capture->Step());
  EXPECT_EQ(TakeAll(capture.get()), (Utimes{10, 20}));
  EXPECT_EQ(capture->counters().num_captured, 2);
  EXPECT_EQ(capture->counters().num_dropped, 0);
  EXPECT_EQ(Notes(capture.get()), "");
  EXPECT_FALSE(capture->has_ended());
}

TEST_F(CameraCaptureTest, TheOldestIsDroppedForANewerOneAndSaidNowAndThen) {
  options_.complain_s = 10;
  for (int i = 1; i <= 6; ++i) script_.grabs.push_back(Pair(i));
  const auto capture = Make();
  for (int i = 0; i < 6; ++i) capture->Step();
  EXPECT_EQ(TakeAll(capture.get()), (Utimes{5, 6}));
  EXPECT_EQ(capture->counters().num_captured, 6);
  EXPECT_EQ(capture->counters().num_dropped, 4);
  EXPECT_EQ(Notes(capture.get()),
            "warning: 1 pairs dropped, of 3 so far: rectifying and sending them takes longer than "
            "the camera's period\n")
      << "the others when ten seconds have passed";
  clock_.Pass(9999999);
  capture->Step();
  EXPECT_EQ(Notes(capture.get()), "");
  clock_.Pass(1);
  capture->Step();
  EXPECT_NE(Notes(capture.get()).find("warning: 3 pairs dropped, of 6 so far"), std::string::npos);
}

TEST_F(CameraCaptureTest, ALostSourceIsSaidOnceWaitedForAndGoneOnWith) {
  options_.retry_s = 1;
  script_.grabs = {Pair(10), Lost(), Pair(7000000)};
  script_.reopens = {"it is not there", "it is not there", "it is another one"};
  const auto capture = Make();
  capture->Step();
  capture->Step();
  EXPECT_TRUE(capture->is_lost());
  EXPECT_EQ(Notes(capture.get()), "warning: fake is lost: waiting for it\n");
  const std::int64_t lost = clock_.now_us();
  while (capture->is_lost()) ASSERT_TRUE(capture->Step());
  EXPECT_EQ(script_.num_reopened, 4);
  EXPECT_EQ(clock_.now_us() - lost, 4000000) << "a look every second";
  EXPECT_EQ(Notes(capture.get()),
            "warning: it is not there\nwarning: it is another one\n"
            "warning: fake is back after 4.0 s: going on in the same session\n");
  capture->Step();
  EXPECT_EQ(TakeAll(capture.get()), (Utimes{10, 7000000}));
  EXPECT_EQ(capture->counters().num_losses, 1);
}

TEST_F(CameraCaptureTest, TimesRise) {
  script_.grabs = {Pair(2000000), Pair(1500000), Pair(2000000), Pair(2000001)};
  const auto capture = Make();
  for (int i = 0; i < 4; ++i) capture->Step();
  EXPECT_EQ(TakeAll(capture.get()), (Utimes{2000000, 2000001}));
  EXPECT_EQ(capture->counters().num_unusable, 2);
  EXPECT_EQ(Notes(capture.get()),
            "warning: fake: an image that is 0.500 s earlier than the one before: left out, as are "
            "others like it (STATUS counts them)\n");
  EXPECT_EQ(capture->counters().last_unusable,
            "fake: an image that is 0.000 s earlier than the one before");
}

TEST_F(CameraCaptureTest, ImagesOfAnotherSizeAreLeftOut) {
  script_.grabs = {Pair(10, 0, kWidth + 1), Pair(20)};
  const auto capture = Make();
  capture->Step();
  capture->Step();
  EXPECT_EQ(TakeAll(capture.get()), (Utimes{20}));
  EXPECT_EQ(capture->counters().num_unusable, 1);
}

TEST_F(CameraCaptureTest, ImagesThatAreNotTakenTogetherAreWarnedOfOnce) {
  options_.max_skew_ms = 5;
  options_.max_waiting = 100;
  std::int64_t utime = 0;
  for (int i = 0; i < 9; ++i) script_.grabs.push_back(Pair(++utime, -6000));
  script_.grabs.push_back(Pair(++utime, 5000));  // no more than is allowed
  for (int i = 0; i < 20; ++i) script_.grabs.push_back(Pair(++utime, -6000));
  const auto capture = Make();
  for (int i = 0; i < 19; ++i) capture->Step();
  EXPECT_EQ(Notes(capture.get()), "");
  for (int i = 0; i < 11; ++i) capture->Step();
  EXPECT_EQ(Notes(capture.get()),
            "warning: fake: right images are taken 6.0 ms earlier than left ones; what moves is "
            "mismeasured, cameras with a common trigger are needed\n");
}

TEST_F(CameraCaptureTest, WhatWaitsAtTheEndIsStillTaken) {
  script_.grabs = {Pair(10), Ended()};
  const auto capture = Make();
  EXPECT_TRUE(capture->Step());
  EXPECT_FALSE(capture->Step());
  EXPECT_EQ(Notes(capture.get()), "fake: has ended\n");
  EXPECT_FALSE(capture->has_ended());
  EXPECT_EQ(TakeAll(capture.get()), (Utimes{10}));
  EXPECT_TRUE(capture->has_ended());
}

TEST_F(CameraCaptureTest, AThreadOfItsOwnCaptures) {
  script_.grabs = {Pair(10), Pair(20), Ended()};
  const auto capture = Make();
  capture->Start();
  Utimes utimes;
  while (!capture->has_ended()) {
    for (const std::int64_t utime : TakeAll(capture.get())) utimes.push_back(utime);
  }
  EXPECT_EQ(utimes, (Utimes{10, 20}));
  EXPECT_EQ(capture->error(), "");
}

TEST_F(CameraCaptureTest, AnErrorEndsItAndIsKept) {
  script_.grabs = {{Grabbed::State::kNothingYet, {}, "throw"}};
  const auto capture = Make();
  capture->Start();
  while (!capture->has_ended()) capture->Take(0.01);
  EXPECT_EQ(capture->error(), "broken");
}

/// A device whose images are numbered by their grey level, from 1.
class FakeDevice : public ImageDevice {
 public:
  struct Script {
    std::string why_not_open;
    cv::Size size{kWidth, kHeight};
    double rate_hz = 20;
    std::deque<std::int64_t> utimes;  // of the images to come; -1: nothing yet, -2: lost
    int depth = CV_8U;
    int num_taken = 0;
    bool is_damaged = false;
  };
  FakeDevice(std::string name, Script* script) : name_(std::move(name)), script_(script) {}
  std::string name() const override { return name_; }
  std::string Open() override { return script_->why_not_open; }
  State Take(int) override {
    if (script_->utimes.empty()) return State::kNothingYet;
    utime_ = script_->utimes.front();
    script_->utimes.pop_front();
    if (utime_ == -1) return State::kNothingYet;
    if (utime_ == -2) return State::kLost;
    ++script_->num_taken;
    return State::kImage;
  }
  std::int64_t utime() const override { return utime_; }
  cv::Mat Retrieve() override {
    if (script_->is_damaged) return {};
    cv::Mat image(script_->size, CV_MAKETYPE(script_->depth, 1), cv::Scalar(script_->num_taken));
    return image;
  }
  double rate_hz() const override { return script_->rate_hz; }
  cv::Size image_size() const override { return script_->size; }

 private:
  std::string name_;
  Script* script_;
  std::int64_t utime_ = 0;
};

class DeviceGrabberTest : public testing::Test {
 protected:
  DeviceGrabber Make(VideoLayout layout, double stall_s = 2) {
    std::vector<std::unique_ptr<ImageDevice>> devices;
    devices.push_back(std::make_unique<FakeDevice>("dev0", &left_));
    if (layout == VideoLayout::kTwoVideos) {
      devices.push_back(std::make_unique<FakeDevice>("dev1", &right_));
    }
    return {std::move(devices), layout, stall_s, clock_.clock()};
  }
  std::string Refusal(VideoLayout layout) {
    try {
      Make(layout);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }
  std::int64_t now() const { return clock_.now_us(); }

  FakeClock clock_;
  FakeDevice::Script left_;
  FakeDevice::Script right_;
};

TEST_F(DeviceGrabberTest, BothImagesInOne) {
  left_.utimes = {now() - 100};
  DeviceGrabber beside = Make(VideoLayout::kSideBySide);
  EXPECT_EQ(beside.image_size(), std::make_pair(kWidth / 2, kHeight));
  const Grabbed pair = beside.Grab();
  ASSERT_EQ(pair.state, Grabbed::State::kPair);
  EXPECT_EQ(pair.pair.utime, now() - 100) << "when the driver had it, not when it was fetched";
  EXPECT_EQ(pair.pair.left.size(), cv::Size(kWidth / 2, kHeight));
  EXPECT_EQ(pair.pair.right.size(), cv::Size(kWidth / 2, kHeight));
  EXPECT_EQ(pair.pair.right.data, pair.pair.left.data + kWidth / 2);
  EXPECT_EQ(beside.Grab().state, Grabbed::State::kNothingYet);
  left_.utimes = {now()};
  const Grabbed above = Make(VideoLayout::kOverUnder).Grab();
  EXPECT_EQ(above.pair.left.size(), cv::Size(kWidth, kHeight / 2));
  EXPECT_EQ(above.pair.right.data, above.pair.left.data + kWidth * kHeight / 2);
}

TEST_F(DeviceGrabberTest, TwoDevicesArePairedByTime) {
  clock_.Pass(1000000);
  const std::int64_t t = now() - 500000;
  left_.utimes = {t, t + 50000, t + 100000};
  right_.utimes = {t + 48000, t + 101000};  // it began one image later
  DeviceGrabber grabber = Make(VideoLayout::kTwoVideos);
  EXPECT_EQ(grabber.Grab().state, Grabbed::State::kNothingYet);
  const Grabbed first = grabber.Grab();
  ASSERT_EQ(first.state, Grabbed::State::kPair);
  EXPECT_EQ(first.pair.utime, t + 50000);
  EXPECT_EQ(first.pair.skew_us, -2000);
  EXPECT_EQ(first.pair.left.at<std::uint8_t>(0, 0), 2);
  EXPECT_EQ(first.pair.right.at<std::uint8_t>(0, 0), 1);
  EXPECT_EQ(grabber.Grab().pair.skew_us, 1000);
}

TEST_F(DeviceGrabberTest, AnImageWaitsForThatOfTheOtherDevice) {
  left_.utimes = {now()};
  right_.utimes = {-1, now()};
  DeviceGrabber grabber = Make(VideoLayout::kTwoVideos);
  EXPECT_EQ(grabber.Grab().state, Grabbed::State::kNothingYet);
  EXPECT_EQ(grabber.Grab().state, Grabbed::State::kPair);
  EXPECT_EQ(left_.num_taken, 1);
}

TEST_F(DeviceGrabberTest, TimesOfAnotherClockAreReplacedByThatOfArrival) {
  left_.utimes = {now() + 1, now() - 1000000, 0, now() - 999999};
  DeviceGrabber grabber = Make(VideoLayout::kSideBySide);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(grabber.Grab().pair.utime, now()) << i;
  EXPECT_EQ(grabber.Grab().pair.utime, now() - 999999);
}

TEST_F(DeviceGrabberTest, DevicesAreLostWhenTheyAreGoneOrSilent) {
  left_.utimes = {-2};
  DeviceGrabber grabber = Make(VideoLayout::kTwoVideos, 2);
  EXPECT_EQ(grabber.Grab().why, "dev0 is lost");
  left_.utimes = {now()};
  left_.why_not_open = "dev0: No such file";
  EXPECT_EQ(grabber.Reopen(), "dev0: No such file");
  left_.why_not_open.clear();
  EXPECT_EQ(grabber.Reopen(), "");
  clock_.Pass(2000000);
  EXPECT_EQ(grabber.Grab().state, Grabbed::State::kNothingYet);
  clock_.Pass(1);
  const Grabbed silent = grabber.Grab();
  EXPECT_EQ(silent.state, Grabbed::State::kLost);
  EXPECT_EQ(silent.why, "dev1 delivers nothing for 2 s");
  right_.size.width = 2;
  EXPECT_EQ(grabber.Reopen(), "dev1: is back, but gives images of 2x6 px, not 8x6");
  right_.size.width = kWidth;
  left_.utimes = right_.utimes = {now()};
  EXPECT_EQ(grabber.Reopen(), "");
  EXPECT_EQ(grabber.Grab().state, Grabbed::State::kPair);
}

TEST_F(DeviceGrabberTest, UnusableImagesAreNamed) {
  left_.utimes = {now(), now(), now()};
  DeviceGrabber grabber = Make(VideoLayout::kSideBySide);
  left_.is_damaged = true;
  EXPECT_EQ(grabber.Grab().why, "dev0: an image cannot be decoded");
  left_.is_damaged = false;
  left_.depth = CV_16U;
  EXPECT_EQ(grabber.Grab().why, "dev0: an image has more than 8 bits");
  left_.depth = CV_8U;
  left_.size.height = 5;
  EXPECT_EQ(grabber.Grab().why, "dev0: an image has 8x5 px");
}

TEST_F(DeviceGrabberTest, WhatCannotBeUsedIsRefused) {
  left_.size.width = 7;
  EXPECT_EQ(Refusal(VideoLayout::kSideBySide),
            "dev0: gives images of 7x6 px, which cannot be divided into two of one size");
  EXPECT_EQ(Refusal(VideoLayout::kTwoVideos), "dev1: gives images of 8x6 px, dev0 of 7x6");
  right_.why_not_open = "dev1: Permission denied";
  EXPECT_EQ(Refusal(VideoLayout::kTwoVideos), "dev1: Permission denied");
}

/// Pairs at given times; nothing at -1.
class FakeRecording : public StereoRecording {
 public:
  explicit FakeRecording(std::vector<std::int64_t> utimes) : utimes_(std::move(utimes)) {}
  std::string name() const override { return "film"; }
  std::size_t num_pairs() const override { return utimes_.size(); }
  std::pair<int, int> image_size() const override { return {kWidth, kHeight}; }
  std::optional<RecordedPair> Load(std::size_t index) override {
    if (utimes_[index] < 0) return std::nullopt;
    return RecordedPair{utimes_[index], Plain(1), Plain(2)};
  }
  std::int64_t utime(std::size_t index) override { return utimes_[index]; }
  PairNames names(std::size_t index) const override {
    return {"film, image " + std::to_string(index), ""};
  }
  std::vector<std::string> TakeNotes() override { return {}; }

 private:
  std::vector<std::int64_t> utimes_;
};

TEST(RecordingGrabberTest, PlaysAtItsOwnRate) {
  FakeClock clock;
  const std::int64_t start = clock.now_us();
  RecordingGrabber grabber(std::make_unique<FakeRecording>(Utimes{700, 50700, -1, 500700, 510700}),
                           clock.clock(), clock.pause());
  EXPECT_EQ(grabber.Grab().pair.utime, start);
  EXPECT_EQ(clock.now_us(), start);
  EXPECT_EQ(grabber.Grab().pair.utime, start + 50000);
  EXPECT_EQ(clock.now_us(), start + 50000) << "not before its time";
  EXPECT_EQ(grabber.Grab().why, "film, image 2: this pair cannot be used");
  EXPECT_EQ(grabber.Grab().state, Grabbed::State::kNothingYet) << "so that it can be stopped";
  EXPECT_EQ(clock.now_us(), start + 250000);
  clock.Pass(400000);  // whoever comes late gets late pairs
  EXPECT_EQ(grabber.Grab().pair.utime, start + 500000);
  EXPECT_EQ(grabber.Grab().pair.utime, start + 510000);
  EXPECT_EQ(clock.now_us(), start + 650000);
  EXPECT_EQ(grabber.Grab().state, Grabbed::State::kEnded);
}

}  // namespace
}  // namespace airdos
