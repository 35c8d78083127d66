// airdos-stereo-camera as a process, on a network of its own, with a video in place of a camera.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "airdos/image_t.hpp"
#include "airdos/person_keypoints_t.hpp"
#include "airdos/process_status_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/process_usage.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/validate.h"
#include "tests/support/child_process.h"
#include "tests/support/private_network.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr double kDeadline_s = 60;  // far above what is needed, for busy machines
constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr double kRate_hz = 20;
const std::string kProgram = std::string(AIRDOS_BINARY_DIR) + "/bin/airdos-stereo-camera";

class CameraProcessTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_camera_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "calib.json")
        << R"({"fx": 100, "fy": 100, "cx": 32, "cy": 24, "baseline_m": 0.25})";
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Side by side, the left half dark, the right one bright.
  std::string WriteVideo(int num_images) const {
    const std::string path = (folder_ / "both.avi").string();
    cv::VideoWriter writer(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           kRate_hz, {2 * kWidth, kHeight}, true);
    EXPECT_TRUE(writer.isOpened());
    for (int i = 0; i < num_images; ++i) {
      cv::Mat image(kHeight, 2 * kWidth, CV_8UC3, cv::Scalar::all(60));
      image.colRange(kWidth, 2 * kWidth) = cv::Scalar::all(180);
      writer.write(image);
    }
    return path;
  }

  template <class Message>
  void Hear(const std::string& channel, std::vector<Message>* heard) {
    transport_->Subscribe(channel, [channel, heard](const void* data, std::size_t size, auto) {
      Message message;
      ASSERT_TRUE(Decode(data, size, &message)) << channel;
      EXPECT_EQ(Validate(message), "") << channel;
      heard->push_back(message);
    });
  }
  void EnterNetwork() {
    const std::string failure = EnterPrivateNetwork(true);
    if (!failure.empty()) GTEST_SKIP() << failure;
    transport_ = std::make_unique<LcmTransport>("udpm://239.255.76.67:7667?ttl=0");
    Hear("CALIBRATION", &calibrations_);
    Hear("CAMERA_LEFT", &left_);
    Hear("CAMERA_RIGHT", &right_);
    Hear("PERSON_KEYPOINTS_LEFT", &keypoints_);
    Hear("STATUS", &statuses_);
  }
  bool HearUntil(const std::function<bool()>& condition) {
    return WaitUntil(
        [&] {
          while (transport_->Poll(0)) {
          }
          return condition();
        },
        kDeadline_s);
  }

  std::unique_ptr<ChildProcess> Start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), kProgram);
    return std::make_unique<ChildProcess>(arguments, (folder_ / "camera").string());
  }
  /// The device of tests/support/fake_v4l2.cc, which is there while its file is.
  static bool CanPreload() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return false;
#else
    return true;
#endif
  }
  std::string device() const { return (folder_ / "video0").string(); }
  void PlugIn() const { std::ofstream(device()).flush(); }
  void Unplug() const { fs::remove(device()); }
  std::unique_ptr<ChildProcess> StartDevice(const std::vector<std::string>& more) const {
    std::vector<std::string> command = {"env",
                                        std::string("LD_PRELOAD=") + AIRDOS_FAKE_V4L2_LIBRARY,
                                        "AIRDOS_FAKE_V4L2=" + device(),
                                        kProgram,
                                        "--camera",
                                        device(),
                                        "--side-by-side",
                                        "--calibration",
                                        (folder_ / "calib.json").string()};
    command.insert(command.end(), more.begin(), more.end());
    return std::make_unique<ChildProcess>(command, (folder_ / "camera").string());
  }
  std::unique_ptr<ChildProcess> StartVideo(const std::string& video,
                                           const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"--video", video, "--side-by-side", "--calibration",
                                          (folder_ / "calib.json").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Start(arguments);
  }

  fs::path folder_;
  std::unique_ptr<LcmTransport> transport_;
  std::vector<stereo_calibration_t> calibrations_;
  std::vector<image_t> left_;
  std::vector<image_t> right_;
  std::vector<person_keypoints_t> keypoints_;
  std::vector<process_status_t> statuses_;
};

TEST_F(CameraProcessTest, PublishesAVideoAtItsOwnRateAndEnds) {
  EnterNetwork();
  if (IsSkipped()) return;
  constexpr int kNumPairs = 30;
  const auto camera = StartVideo(WriteVideo(kNumPairs), {"--session", "7", "--nobody"});
  ASSERT_TRUE(HearUntil([&] { return camera->HasEnded(); })) << camera->Errors();
  EXPECT_EQ(camera->Wait(0), 0) << camera->Errors();
  const auto has_left = [this] {
    return !statuses_.empty() && statuses_.back().state == process_status_t::STATE_STOPPING;
  };
  ASSERT_TRUE(HearUntil(has_left));
  EXPECT_EQ(camera->Output().rfind("airdos-stereo-camera READY version ", 0), 0u);
  EXPECT_NE(camera->Errors().find("both.avi: has ended"), std::string::npos) << camera->Errors();

  ASSERT_FALSE(left_.empty());
  ASSERT_EQ(left_.size(), right_.size());
  EXPECT_EQ(keypoints_.size(), left_.size());
  for (std::size_t i = 0; i < left_.size(); ++i) {
    EXPECT_EQ(left_[i].seq, static_cast<std::int64_t>(i)) << "counted without gaps";
    EXPECT_EQ(right_[i].seq, left_[i].seq);
    EXPECT_EQ(right_[i].utime, left_[i].utime);
    EXPECT_EQ(left_[i].session, 7);
    EXPECT_EQ(left_[i].width, kWidth);
    EXPECT_EQ((left_[i].utime - left_[0].utime) % 50000, 0) << "capture times are the video's";
    if (i > 0) {
      EXPECT_GT(left_[i].utime, left_[i - 1].utime);
    }
  }
  ASSERT_FALSE(calibrations_.empty());
  EXPECT_EQ(calibrations_[0].seq, 0);
  EXPECT_EQ(calibrations_[0].baseline_m, 0.25);
  const process_status_t& last = statuses_.back();
  EXPECT_EQ(last.process, "airdos-stereo-camera");
  EXPECT_EQ(last.num_frames_done, static_cast<std::int64_t>(left_.size()));
  EXPECT_EQ(last.num_frames_done + last.num_frames_skipped, kNumPairs)
      << "what is not published is counted as dropped";
  ASSERT_EQ(last.num_channels, 1);
  EXPECT_EQ(last.channels[0].num_received, kNumPairs);
}

TEST_F(CameraProcessTest, EndsWhenItIsToldTo) {
  EnterNetwork();
  if (IsSkipped()) return;
  const auto camera = StartVideo(WriteVideo(100 * static_cast<int>(kRate_hz)));
  ASSERT_TRUE(HearUntil([&] { return left_.size() >= 3; })) << camera->Errors();
  EXPECT_TRUE(keypoints_.empty()) << "they are the detector's";
  camera->Signal(SIGINT);
  EXPECT_EQ(camera->Wait(kDeadline_s), 0) << camera->Errors();
  EXPECT_NE(camera->Errors().find("pairs captured "), std::string::npos);
}

// A device through OpenCV's V4L2, unplugged and plugged in again.
TEST_F(CameraProcessTest, ADeviceIsCapturedLostAndFoundAgain) {
  if (!CanPreload()) GTEST_SKIP() << "a sanitizer's library must be the first";
  EnterNetwork();
  if (IsSkipped()) return;
  PlugIn();
  const std::int64_t start_us = WallClock_us();
  const auto camera = StartDevice({"--capture-size", "128x48", "--pixel-format", "YUYV"});
  ASSERT_TRUE(HearUntil([&] { return right_.size() >= 5; })) << camera->Errors();
  constexpr std::int64_t kAge_us = 300000;
  EXPECT_GT(left_[0].utime, start_us - kAge_us);
  EXPECT_LE(left_.back().utime, WallClock_us() - kAge_us) << "when the driver says, not on arrival";
  EXPECT_EQ(left_[0].width, kWidth);
  EXPECT_NEAR(cv::mean(cv::imdecode(left_[0].data, cv::IMREAD_GRAYSCALE))[0],
              (60 - 16) * 255.0 / 219, 2)
      << "YUYV has black at 16";
  EXPECT_NEAR(cv::mean(cv::imdecode(right_[0].data, cv::IMREAD_GRAYSCALE))[0],
              (180 - 16) * 255.0 / 219, 2);

  Unplug();
  ASSERT_TRUE(HearUntil([&] {
    return !statuses_.empty() && statuses_.back().state == process_status_t::STATE_STALLED;
  })) << camera->Errors();
  EXPECT_EQ(statuses_.back().waiting_for, "camera");
  ASSERT_TRUE(HearUntil([&] { return camera->HasSaid("video0: No such file or directory"); }));
  EXPECT_TRUE(camera->HasSaid("warning: " + device() + " is lost: waiting for it"))
      << camera->Errors();
  const std::size_t num_before = left_.size();
  PlugIn();
  ASSERT_TRUE(HearUntil([&] { return left_.size() >= num_before + 5; })) << camera->Errors();
  EXPECT_TRUE(camera->HasSaid("going on in the same session")) << camera->Errors();
  EXPECT_EQ(left_.back().session, left_.front().session);
  for (std::size_t i = 1; i < left_.size(); ++i) {
    EXPECT_EQ(left_[i].seq, static_cast<std::int64_t>(i));
    EXPECT_GT(left_[i].utime, left_[i - 1].utime);
  }
  camera->Signal(SIGTERM);
  EXPECT_EQ(camera->Wait(kDeadline_s), 0) << camera->Errors();
}

TEST_F(CameraProcessTest, ADeviceThatGivesSomethingElseIsRefused) {
  if (!CanPreload()) GTEST_SKIP() << "a sanitizer's library must be the first";
  PlugIn();
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--capture-size", "640x480"}, "video0: gives images of 128x48 px, not 640x480\n"},
      {{"--pixel-format", "MJPG"}, "video0: does not have the pixel format MJPG\n"},
      {{"--rate", "10"}, "video0: gives 50 images a second, not 10\n"}};
  for (const auto& [arguments, text] : cases) {
    const auto camera = StartDevice(arguments);
    EXPECT_EQ(camera->Wait(kDeadline_s).value_or(-99), 2) << text;
    EXPECT_NE(camera->Errors().find(text), std::string::npos) << camera->Errors();
  }
}

TEST_F(CameraProcessTest, WhatCannotWorkIsSaidInOneLine) {
  const std::string video = WriteVideo(2);
  const std::string calibration = (folder_ / "calib.json").string();
  std::ofstream(folder_ / "large.json")
      << R"({"width": 640, "height": 480, "fx": 500, "fy": 500, "cx": 320, "cy": 240,
             "baseline_m": 0.25})";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{}, "--camera is missing"},
      {{"--video", video, "--side-by-side"}, "--video: the calibration is missing"},
      {{"--camera", "/dev/null", "--side-by-side"}, "--camera: the calibration is missing"},
      {{"--video", video, "--calibration", calibration}, "--side-by-side or --over-under?"},
      {{"--camera", "a", "b", "--over-under", "--calibration", calibration}, "for one source"},
      {{"--camera", "a", "a", "--calibration", calibration}, "cannot be the left and the right"},
      {{"--camera", "/nope", "--side-by-side", "--calibration", calibration},
       "/nope: No such file or directory"},
      {{"--camera", video, "--side-by-side", "--calibration", calibration},
       "both.avi: is no device (a recording is played with --video)"},
      {{"--camera", "/dev/null", "--side-by-side", "--calibration", calibration},
       "/dev/null: is no camera"},
      {{"--video", calibration, "--side-by-side", "--calibration", calibration},
       "cannot be read as a video"},
      {{"--video", video, "--side-by-side", "--calibration", "/nope"}, "/nope"},
      {{"--video", video, "--side-by-side", "--calibration", (folder_ / "large.json").string()},
       "640x480"},
      {{"--video", video, "--side-by-side", "--calibration", calibration, "--capture-size", "2x2"},
       "--capture-size is for --camera"},
      {{"--camera", "a", "--side-by-side", "--calibration", calibration, "--pixel-format", "MJPEG"},
       "must be four letters"},
  };
  for (const auto& [arguments, text] : cases) {
    const auto camera = Start(arguments);
    EXPECT_EQ(camera->Wait(kDeadline_s).value_or(-99), 2) << text;
    const std::string errors = camera->Errors();
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    EXPECT_NE(errors.find(text), std::string::npos) << text << " is not in " << errors;
    EXPECT_EQ(camera->Output(), "");
  }
}

}  // namespace
}  // namespace airdos
