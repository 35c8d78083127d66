// Recordings in videos: two, or one with both images.
#include "common/dataset/recording/video_recording.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/rendered_scene.h"
#include "tests/unit/dataset/recording/recording_fixture.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

class VideoTest : public RecordingTest {
 protected:
  std::string WriteVideo(const std::string& name, const std::vector<cv::Mat>& images,
                         double rate_hz = 20) const {
    cv::VideoWriter writer(Path(name), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           rate_hz, images[0].size(), true);
    EXPECT_TRUE(writer.isOpened());
    for (const cv::Mat& image : images) {
      cv::Mat bgr;
      cv::cvtColor(image, bgr, cv::COLOR_GRAY2BGR);
      writer.write(bgr);
    }
    return Path(name);
  }
  std::string WriteSide(const std::string& name, int count, bool is_left,
                        double rate_hz = 20) const {
    std::vector<cv::Mat> images;
    for (int i = 0; i < count; ++i) images.push_back(Plain(i, is_left));
    return WriteVideo(name, images, rate_hz);
  }
};

TEST_F(VideoTest, TwoVideos) {
  VideoRecording recording({WriteSide("l.avi", 6, true), WriteSide("r.avi", 6, false)});
  EXPECT_EQ(recording.num_pairs(), 6u);
  EXPECT_EQ(recording.image_size(), std::make_pair(kWidth, kHeight));
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 3, 4, 5})) << "again from the beginning";
  EXPECT_EQ(TimesOf(&recording), (Times{0, 50000, 100000, 150000, 200000, 250000}));
  EXPECT_TRUE(Holds(Notes(&recording), "taken as started together"));
  EXPECT_TRUE(recording.Load(4) && recording.Load(1));
  EXPECT_EQ(recording.Load(3)->utime, 150000);
}

TEST_F(VideoTest, ARateReplacesTheTimesOfVideos) {
  VideoRecording recording({WriteSide("l.avi", 3, true), WriteSide("r.avi", 3, false, 25),
                            VideoLayout::kTwoVideos, 10.0});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2}));
  EXPECT_EQ(TimesOf(&recording), (Times{0, 100000, 200000}));
}

TEST_F(VideoTest, VideosOfTwoRatesArePairedByTime) {
  std::vector<cv::Mat> twice;
  for (int i = 0; i < 5; ++i) twice.insert(twice.end(), 2, Plain(i, false));
  VideoRecording recording({WriteSide("l.avi", 5, true, 10), WriteVideo("r.avi", twice, 20)});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 3, 4}));
  EXPECT_TRUE(Holds(Notes(&recording), "paired by time"));
}

TEST_F(VideoTest, BothImagesInOneVideo) {
  std::vector<cv::Mat> beside, above;
  for (int i = 0; i < 4; ++i) {
    cv::Mat image;
    cv::hconcat(Plain(i, true), Plain(i, false), image);
    beside.push_back(image.clone());
    cv::vconcat(Plain(i, true), Plain(i, false), image);
    above.push_back(image.clone());
  }
  VideoRecording wide({WriteVideo("wide.avi", beside), "", VideoLayout::kSideBySide, {}});
  EXPECT_EQ(NumbersOf(&wide), (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(wide.image_size(), std::make_pair(kWidth, kHeight));
  VideoRecording tall({WriteVideo("tall.avi", above), "", VideoLayout::kOverUnder, {}});
  EXPECT_EQ(NumbersOf(&tall), (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(tall.image_size(), std::make_pair(kWidth, kHeight));
}

TEST_F(VideoTest, OfVideosOfDifferentLengthsTheCommonPartIsUsed) {
  VideoRecording recording({WriteSide("l.avi", 5, true), WriteSide("r.avi", 8, false)});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 3, 4}));
  EXPECT_TRUE(Holds(Notes(&recording), "has 5 images, " + Path("r.avi") + " 8: the first 5 pairs"));
  VideoRecording other({WriteSide("l2.avi", 8, true), WriteSide("r2.avi", 5, false)});
  EXPECT_EQ(other.num_pairs(), 5u);
  EXPECT_EQ(NumbersOf(&other), (Numbers{0, 1, 2, 3, 4}));
}

TEST_F(VideoTest, OfAVideoThatIsCutShortTheBeginningIsKept) {
  std::vector<cv::Mat> images;
  for (int i = 0; i < 20; ++i) {
    images.push_back(NoisePicture(kWidth, kHeight, static_cast<std::uint32_t>(i)));
  }
  const std::string left = WriteVideo("l.avi", images);
  const std::string right = WriteVideo("r.avi", images);
  fs::resize_file(right, fs::file_size(right) / 2);
  VideoRecording recording({left, right});
  std::size_t num_loaded = 0;
  bool has_ended = false;
  for (std::size_t i = 0; i < recording.num_pairs(); ++i) {
    const auto pair = recording.Load(i);
    if (!pair) has_ended = true;
    if (!pair) continue;
    EXPECT_FALSE(has_ended);
    ++num_loaded;
    EXPECT_LT(cv::norm(pair->left, pair->right, cv::NORM_INF), 1) << i;
  }
  EXPECT_GE(num_loaded, 5u);
  EXPECT_LT(num_loaded, 15u);
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "r.avi: ends after") || Holds(notes, "has 20 images")) << notes;
}

TEST_F(VideoTest, WhatIsNoVideoIsRefused) {
  const std::string good = WriteSide("l.avi", 3, true);
  const auto refusal = [&](const std::string& path) {
    return ErrorOf([&] { VideoRecording recording({good, path}); });
  };
  EXPECT_TRUE(Holds(refusal(Write("text.mp4", "no video")), "text.mp4: cannot be read as a video"));
  EXPECT_TRUE(Holds(refusal(Write("empty.mp4", "")), "empty.mp4"));
  EXPECT_TRUE(Holds(refusal(Path("none.mp4")), "none.mp4"));
  EXPECT_TRUE(Holds(refusal(WriteVideo("wide.avi", {Plain(0, true, 128), Plain(1, true, 128)})),
                    "has images of 128x48 px"));
}

}  // namespace
}  // namespace airdos
