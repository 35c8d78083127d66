// A recording of an unrectified camera as its users meet it: what is wrong with it is one line
// each, and nothing is lost that was good.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "airdos/image_t.hpp"
#include "common/calibration/rig_writer.h"
#include "common/util/format.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "tests/support/child_process.h"
#include "tests/support/distorted_rig.h"
#include "tests/support/input_errors.h"
#include "tests/support/rendered_scene.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr int kNumPairs = 14;

class RecordingProcessTest : public testing::Test {
 protected:
  RecordingProcessTest() {
    const RenderedScene scene(3);
    for (int k = 0; k < kNumPairs; ++k) {
      const StereoPair pair = scene.Render(SmallStereoCamera(), SwayingPath(k));
      left_.push_back(distorted_.Left(pair.left, cv::INTER_CUBIC));
      right_.push_back(distorted_.Right(pair.right, cv::INTER_CUBIC));
    }
    kalibr_ = WriteKalibr("kalibr.yaml", distorted_.rig());
  }

  std::string WriteKalibr(const std::string& name, const StereoRig& rig) const {
    const StereoRectifier unused(distorted_.rig());  // only calib.json needs one
    return folder_.Write(name, WriteRig(rig, unused, "kalibr").front().text);
  }
  void WriteFolders() const {
    for (int k = 0; k < kNumPairs; ++k) {
      folder_.WritePicture(Name("l", k), left_[static_cast<std::size_t>(k)]);
      folder_.WritePicture(Name("r", k), right_[static_cast<std::size_t>(k)]);
    }
  }
  static std::string Name(const std::string& folder, int k) {
    return folder + Format("/%06d.png", k);
  }
  std::string WriteVideo(const std::string& name, const std::vector<cv::Mat>& images,
                         std::size_t count) const {
    cv::VideoWriter writer(folder_.PathOf(name), cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20, images[0].size(), true);
    EXPECT_TRUE(writer.isOpened());
    for (std::size_t i = 0; i < count; ++i) {
      cv::Mat bgr;
      cv::cvtColor(images[i], bgr, cv::COLOR_GRAY2BGR);
      writer.write(bgr);
    }
    return folder_.PathOf(name);
  }
  std::vector<std::string> Folders(const std::string& calibration) const {
    return {"--images", folder_.PathOf("l"), folder_.PathOf("r"), "--rate",
            "20",       "--calibration",     calibration};
  }

  struct Answer {
    int exit_code = -1;
    std::vector<std::string> lines;  // on stderr
    /// Those that hold the text.
    std::vector<std::string> With(const std::string& text) const {
      std::vector<std::string> found;
      std::copy_if(lines.begin(), lines.end(), std::back_inserter(found),
                   [&](const std::string& line) { return Holds(line, text); });
      return found;
    }
  };
  Answer Play(std::vector<std::string> arguments) const {
    fs::remove(log());
    arguments.insert(arguments.begin(), {AIRDOS_BINARY_DIR "/bin/airdos-stereo-player"});
    arguments.insert(arguments.end(), {"--write-log", log()});
    ChildProcess process(arguments, folder_.PathOf("said"));
    constexpr double kDeadline_s = 120;
    Answer answer;
    answer.exit_code = process.Wait(kDeadline_s).value_or(-1000);
    std::istringstream stream(process.Errors());
    for (std::string line; std::getline(stream, line);) answer.lines.push_back(line);
    return answer;
  }
  void ExpectOneLine(const std::vector<std::string>& arguments, const std::string& text) const {
    const Answer answer = Play(arguments);
    EXPECT_EQ(answer.exit_code, 2) << text;
    ASSERT_EQ(answer.lines.size(), 1u) << text;
    EXPECT_TRUE(Holds(answer.lines[0], text)) << answer.lines[0];
    EXPECT_FALSE(fs::exists(log())) << "a log of nothing good: " << text;
  }

  /// Times of the images of both cameras in the log, in steps of the rate.
  std::vector<int> Played() const {
    std::vector<int> left, right;
    EventLogReader reader(log());
    while (const auto event = reader.Next()) {
      if (event->channel != channel::kCameraLeft && event->channel != channel::kCameraRight)
        continue;
      image_t image;
      EXPECT_TRUE(Decode(event->payload.data(), event->payload.size(), &image));
      constexpr std::int64_t kStep_us = 50000;
      (event->channel == channel::kCameraLeft ? left : right)
          .push_back(static_cast<int>(image.utime / kStep_us));
    }
    EXPECT_EQ(left, right);
    return left;
  }

  std::string log() const { return folder_.PathOf("out.lcm"); }

  ScratchFolder folder_{"recording_process"};
  const DistortedRig distorted_{SmallStereoCamera()};
  std::vector<cv::Mat> left_;
  std::vector<cv::Mat> right_;
  std::string kalibr_;
};

TEST_F(RecordingProcessTest, EachFaultOfAnImageIsOneLineAndTheOthersArePlayed) {
  WriteFolders();
  fs::remove(folder_.PathOf(Name("l", 2)));               // missing
  folder_.WritePicture(Name("r", kNumPairs), right_[0]);  // extra
  const std::string truncated = folder_.PathOf(Name("l", 4));
  fs::resize_file(truncated, fs::file_size(truncated) / 2);
  cv::Mat deep, colour, small;
  right_[6].convertTo(deep, CV_16UC1, 256);
  folder_.WritePicture(Name("r", 6), deep);
  cv::cvtColor(left_[8], colour, cv::COLOR_GRAY2BGR);
  folder_.WritePicture(Name("l", 8), colour);
  cv::resize(right_[10], small, cv::Size(), 0.5, 0.5);
  folder_.WritePicture(Name("r", 10), small);

  const Answer answer = Play(Folders(kalibr_));
  EXPECT_EQ(answer.exit_code, 0);
  EXPECT_EQ(Played(), (std::vector<int>{0, 1, 3, 5, 6, 7, 8, 9, 11, 12, 13}));
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"000002.png", "no left image: skipped"},
           {"000014.png", "no left image: skipped"},
           {"l/000004.png", "is cut short"},
           {"r/000006.png", "is of 16 bits, the others of 8"},
           {"l/000008.png", "is in colour, the others grey"},
           {"r/000010.png", "is not of the size of the others, 320x192 px: skipped"}}) {
    const std::vector<std::string> lines = answer.With(name);
    ASSERT_EQ(lines.size(), 1u) << name;
    EXPECT_TRUE(Holds(lines[0], text)) << lines[0];
  }
}

TEST_F(RecordingProcessTest, OfVideosOfDifferentLengthsTheCommonPartIsPlayed) {
  const std::string left = WriteVideo("l.avi", left_, 9);
  const std::string right = WriteVideo("r.avi", right_, 12);
  const Answer answer = Play({"--video", left, right, "--calibration", kalibr_});
  EXPECT_EQ(answer.exit_code, 0);
  EXPECT_EQ(Played(), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  const std::vector<std::string> lines = answer.With("9 images");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(Holds(lines[0], "r.avi 12: the first 9 pairs are used")) << lines[0];
}

TEST_F(RecordingProcessTest, WhatCannotBeUsedAtAllIsOneLineAndExit2) {
  WriteFolders();
  const std::vector<std::string> good = Folders(kalibr_);
  StereoRig rig = distorted_.rig();
  rig.left = Resized(rig.left, {640, 384});
  rig.right = Resized(rig.right, {640, 384});
  ExpectOneLine(Folders(WriteKalibr("large.yaml", rig)), "640x384");
  ExpectOneLine(Folders(WriteKalibr("swapped.yaml", Swapped(distorted_.rig()))), "--swap");
  ExpectOneLine({"--images", good[2], good[1], "--rate", "20", "--calibration", kalibr_},
                "exchanged");
  ExpectOneLine({"--images", good[1], good[2], "--rate", "20"}, "the calibration is missing");
  ExpectOneLine({"--images", good[1], good[2], "--calibration", kalibr_}, "--rate HZ");
  ExpectOneLine({"--video", WriteVideo("l.avi", left_, 2), folder_.Write("r.mp4", "no video"),
                 "--calibration", kalibr_},
                "r.mp4: cannot be read as a video");
  for (int k = 0; k < kNumPairs; k += 2) fs::remove(folder_.PathOf(Name("r", k)));
  for (int k = 1; k < kNumPairs; k += 2) fs::remove(folder_.PathOf(Name("l", k)));
  ExpectOneLine(good, "not all have a partner");
}

}  // namespace
}  // namespace airdos
