// Recordings as people have them: in folders of any names, in videos.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "common/dataset/image_file.h"
#include "common/dataset/recording/folder_recording.h"
#include "common/dataset/recording/recording_times.h"
#include "common/dataset/recording/rectified_sequence.h"
#include "common/dataset/recording/video_recording.h"
#include "common/dataset/stereo_sequence.h"
#include "common/util/format.h"
#include "tests/support/folder_test.h"
#include "tests/support/input_errors.h"
#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// Each image is of one grey value, 10 times its number, the right ones 5 more.
cv::Mat Plain(int number, bool is_left, int width = kWidth) {
  return cv::Mat(kHeight, width, CV_8UC1, cv::Scalar(10 * number + (is_left ? 0 : 5)));
}

class RecordingTest : public FolderTest {
 protected:
  RecordingTest() : FolderTest("recording_test") {}

  void WriteLeft(const std::string& name, int number) const {
    scratch_.WritePicture(name, Plain(number, true));
  }
  void WriteRight(const std::string& name, int number) const {
    scratch_.WritePicture(name, Plain(number, false));
  }
  /// Folders l and r with 000000.png, ...
  void WriteNumbered(int count) const {
    for (int i = 0; i < count; ++i) {
      WriteLeft(Format("l/%06d.png", i), i);
      WriteRight(Format("r/%06d.png", i), i);
    }
  }
  FolderRecordingOptions Numbered() const { return {Path("l"), Path("r"), "", 20.0}; }
  std::string Refusal(const FolderRecordingOptions& options) const {
    return ErrorOf([&] { FolderRecording recording(options); });
  }

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

/// The numbers of the pairs that can be loaded, by their grey values; -1 if left and right differ.
std::vector<int> NumbersOf(StereoRecording* recording) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < recording->num_pairs(); ++i) {
    const auto pair = recording->Load(i);
    if (!pair) continue;
    const double left = cv::mean(pair->left)[0] / 10;
    const double right = (cv::mean(pair->right)[0] - 5) / 10;
    numbers.push_back(std::lround(left) == std::lround(right) ? static_cast<int>(std::lround(left))
                                                              : -1);
  }
  return numbers;
}

std::vector<std::int64_t> TimesOf(StereoRecording* recording) {
  std::vector<std::int64_t> utimes;
  for (std::size_t i = 0; i < recording->num_pairs(); ++i) utimes.push_back(recording->utime(i));
  return utimes;
}

std::string Notes(StereoRecording* recording) {
  std::string text;
  for (const std::string& note : recording->TakeNotes()) text += note + "\n";
  return text;
}

using Numbers = std::vector<int>;
using Times = std::vector<std::int64_t>;

// ---- folders, names and numbers

TEST_F(RecordingTest, TwoFoldersOfAnyWidth) {
  for (const int i : {0, 1, 2, 10, 11}) {
    WriteLeft(Format("l/%010d.png", i), i);
    WriteRight(Format("r/frame%d.png", i), i);
  }
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 10, 11}));
  EXPECT_EQ(recording.image_size(), std::make_pair(kWidth, kHeight));
  EXPECT_EQ(TimesOf(&recording), (Times{0, 50000, 100000, 500000, 550000})) << "gaps stay";
  EXPECT_EQ(recording.names(3).left, Path("l/0000000010.png"));
  EXPECT_EQ(recording.names(3).right, Path("r/frame10.png"));
}

TEST_F(RecordingTest, OneFolderWithBothByTheirNames) {
  const std::pair<const char*, const char*> kinds[] = {
      {"%06d_l.png", "%06d_r.png"},
      {"%04d_left.png", "%04d_right.png"},
      {"left%d.png", "right%d.png"},
      {"frame-left-%04d.png", "frame-right-%04d.png"},
      {"L_%d.png", "R_%d.png"}};
  int k = 0;
  for (const auto& [left, right] : kinds) {
    const std::string folder = "kind" + std::to_string(k++);
    for (int i = 8; i < 12; ++i) {
      char name[100];
      std::snprintf(name, sizeof(name), left, i);  // NOLINT: formats of the table above
      WriteLeft(folder + "/" + name, i);
      std::snprintf(name, sizeof(name), right, i);  // NOLINT
      WriteRight(folder + "/" + name, i);
    }
    FolderRecording recording({Path(folder), "", "", 20.0});
    EXPECT_EQ(NumbersOf(&recording), (Numbers{8, 9, 10, 11})) << left;
  }
}

TEST_F(RecordingTest, OneFolderWithoutSidesIsRefused) {
  WriteLeft("l/000000.png", 0);
  WriteLeft("l/000001.png", 1);
  EXPECT_TRUE(Holds(Refusal({Path("l"), "", "", 20.0}), "which images are left and which right"));
}

TEST_F(RecordingTest, KittiRawAndEurocFoldersAreOneFurtherDown) {
  for (int i = 0; i < 3; ++i) {
    WriteLeft(Format("image_00/data/%010d.png", i), i);
    WriteRight(Format("image_01/data/%010d.png", i), i);
  }
  Write("image_00/timestamps.txt",
        "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.074389445\n"
        "2011-09-27 00:00:00.000000000\n");
  FolderRecording recording({Path("image_00"), Path("image_01"), "", std::nullopt});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2}));
  EXPECT_EQ(TimesOf(&recording), (Times{1317042145964389, 1317042146074389, 1317081600000000}));
}

TEST_F(RecordingTest, FoldersBelowAreNamed) {
  WriteNumbered(2);
  EXPECT_TRUE(Holds(Refusal({Path(""), "", "", 20.0}), "folders with images: 'l', 'r'"));
  EXPECT_TRUE(Holds(Refusal({Path("none"), Path("r"), "", 20.0}), "is not there"));
  EXPECT_TRUE(Holds(Refusal({Path("l"), Path("l"), "", 20.0}), "for the left and for the right"));
}

// ---- times

TEST_F(RecordingTest, TimesInNamesOfEachUnit) {
  const std::pair<std::string, std::string> kinds[] = {
      {"1403636579763555584", "1403636579813555584"},
      {"1403636579763556", "1403636579813556"},
      {"1403636579763", "1403636579813"},
      {"1403636579.763555", "1403636579.813555"}};
  int k = 0;
  for (const auto& [first, second] : kinds) {
    const std::string folder = "t" + std::to_string(k++);
    WriteLeft(folder + "/l/" + first + ".png", 0);
    WriteRight(folder + "/r/" + first + ".png", 0);
    WriteLeft(folder + "/l/" + second + ".png", 1);
    WriteRight(folder + "/r/" + second + ".png", 1);
    FolderRecording recording({Path(folder + "/l"), Path(folder + "/r"), "", std::nullopt});
    EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1}));
    EXPECT_NEAR(static_cast<double>(recording.utime(0)), 1403636579763556, 600) << first;
    EXPECT_EQ(recording.utime(1) - recording.utime(0), 50000) << first;
  }
}

TEST_F(RecordingTest, TimesOfEachCameraArePairedByTime) {
  for (int i = 0; i < 6; ++i) {
    if (i != 2) WriteLeft(Format("l/%ld.png", 1403636579000000000 + 50000000L * i), i);
    if (i != 4) WriteRight(Format("r/%ld.png", 1403636579003000000 + 50000000L * i), i);
  }
  FolderRecording recording({Path("l"), Path("r"), "", std::nullopt});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 3, 5}));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "differ by up to 3 ms")) << notes;
  EXPECT_TRUE(Holds(notes, "no left image: skipped")) << notes;
}

TEST_F(RecordingTest, TimesOfAFileByNameAndByRow) {
  WriteNumbered(3);
  const auto times_of = [&](const std::string& text) {
    FolderRecording recording({Path("l"), Path("r"), Write("times.csv", text), std::nullopt});
    return TimesOf(&recording);
  };
  const Times expected = {1403636579763556, 1403636579813556, 1403636579863556};
  EXPECT_EQ(times_of("#timestamp [ns],filename\n1403636579763555584,000000.png\n"
                     "1403636579813555584,000001.png\r\n1403636579863555584,000002.png\n"),
            expected);
  EXPECT_EQ(times_of("timestamp;file\n1403636579763556; l/000000.png\n1403636579813556;"
                     "l/000001.png\n1403636579863556;l/000002.png\n"),
            expected);
  EXPECT_EQ(times_of("1403636579.763556\n1403636579.813556\n1403636579.863556\n"), expected);
  EXPECT_EQ(times_of("0.1\n0.2\n0.3\n"), (Times{100000, 200000, 300000}));
  EXPECT_EQ(times_of("100\n200\n300\n"), (Times{100000, 200000, 300000})) << "ms";
}

TEST_F(RecordingTest, AFileOfTimesThatIsNoneIsRefused) {
  WriteNumbered(3);
  const auto refusal = [&](const std::string& text) {
    return Refusal({Path("l"), Path("r"), Write("times.txt", text), std::nullopt});
  };
  EXPECT_TRUE(Holds(refusal("0.1\n0.1\n0.2\n"), "times.txt:2: time '0.1' does not come after"));
  EXPECT_TRUE(Holds(refusal("0.1\nhello\n0.2\n"), "times.txt:2: must hold a time"));
  EXPECT_TRUE(Holds(refusal("0.1 2 3\n"), "times.txt:1: must hold a time"));
  EXPECT_TRUE(Holds(refusal(""), "holds no time"));
  EXPECT_TRUE(Holds(refusal("0.1\n0.2\n"), "holds 2 times for 3 images"));
  EXPECT_TRUE(Holds(Refusal({Path("l"), Path("r"), Path("none.txt"), std::nullopt}), "none.txt"));
}

TEST_F(RecordingTest, RowsStayWithTheirImagesWhereOneIsMissing) {
  WriteNumbered(5);
  fs::remove(Path("l/000001.png"));
  FolderRecording recording(
      {Path("l"), Path("r"), Write("times.txt", "0.0\n0.1\n0.2\n0.35\n0.4\n"), std::nullopt});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 2, 3, 4}));
  EXPECT_EQ(TimesOf(&recording), (Times{0, 200000, 350000, 400000}));
}

TEST_F(RecordingTest, RowsBelongToTheNumbersOfBothCameras) {
  for (int i = 1; i <= 5; ++i) {  // numbers from 1; with the left ones alone they may be from 0
    if (i != 5) WriteLeft(Format("l/%d.png", i), i);
    if (i != 2) WriteRight(Format("r/%d.png", i), i);
  }
  FolderRecording recording(
      {Path("l"), Path("r"), Write("times.txt", "0.0\n0.1\n0.2\n0.35\n0.4\n"), std::nullopt});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{1, 3, 4}));
  EXPECT_EQ(TimesOf(&recording), (Times{0, 200000, 350000}));
}

TEST_F(RecordingTest, WithoutTimesARateIsNeeded) {
  WriteNumbered(3);
  EXPECT_TRUE(Holds(Refusal({Path("l"), Path("r"), "", std::nullopt}), "--rate HZ"));
  EXPECT_TRUE(Holds(Refusal({Path("l"), Path("r"), "", 0.0}), "not positive"));
}

// ---- images that are not as the others

TEST_F(RecordingTest, MissingAndExtraImagesAreLeftOut) {
  WriteNumbered(6);
  fs::remove(Path("l/000002.png"));
  WriteRight("r/000006.png", 6);
  WriteRight("r/overview.png", 6);
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 3, 4, 5}));
  EXPECT_EQ(recording.utime(2), 150000);
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "'000002.png', '000006.png' have no left image: skipped")) << notes;
  EXPECT_TRUE(Holds(notes, "'overview.png' is not named like the other images")) << notes;
}

TEST_F(RecordingTest, FoldersOfTwoRecordingsAreRefused) {
  for (int i = 0; i < 4; ++i) {
    WriteLeft(Format("l/%06d.png", i), i);
    WriteRight(Format("r/%06d.png", 100 + i), i);
  }
  EXPECT_TRUE(Holds(Refusal(Numbered()), "not all have a partner"));
}

TEST_F(RecordingTest, TruncatedAndForeignFilesAreLeftOut) {
  WriteNumbered(5);
  fs::resize_file(Path("l/000001.png"), 60);
  Write("r/000003.png", "no picture");
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 2, 4}));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "l/000001.png: is cut short")) << notes;
  EXPECT_TRUE(Holds(notes, "so are 1 more that cannot be used")) << notes;
}

TEST_F(RecordingTest, WhatIsDamagedInsideIsSkippedWhenItIsRead) {
  WriteNumbered(3);
  const cv::Mat noise = NoisePicture(kWidth, kHeight, 7);
  scratch_.WritePicture("l/000001.png", noise);
  std::string bytes = TextOf("l/000001.png");
  for (std::size_t i = 60; i < bytes.size() - 40; ++i) bytes[i] = 'x';
  Write("l/000001.png", bytes);
  FolderRecording recording(Numbered());
  ASSERT_EQ(recording.num_pairs(), 3u);
  EXPECT_TRUE(recording.Load(0));
  Notes(&recording);
  EXPECT_FALSE(recording.Load(1));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "l/000001.png") && Holds(notes, "skipped")) << notes;
  EXPECT_TRUE(recording.Load(2));
}

TEST_F(RecordingTest, ImagesOfAnotherSizeAreLeftOut) {
  WriteNumbered(5);
  scratch_.WritePicture("r/000002.png", Plain(2, false, 2 * kWidth));
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 3, 4}));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "r/000002.png' is not of the size of the others, 64x48 px")) << notes;
  for (int i = 0; i < 5; ++i) {
    scratch_.WritePicture(Format("r/%06d.png", i), Plain(i, false, 2 * kWidth));
  }
  EXPECT_TRUE(Holds(Refusal(Numbered()), "the right images have 128x48 px, the left ones 64x48"));
}

TEST_F(RecordingTest, SixteenBitImagesAreScaledByOneRange) {
  for (int i = 0; i < 3; ++i) {
    const auto write = [&](const std::string& name, bool is_left) {
      cv::Mat deep;
      Plain(i + 20, is_left).convertTo(deep, CV_16UC1, 16);
      scratch_.WritePicture(name, deep);
    };
    write(Format("l/%06d.png", i), true);
    write(Format("r/%06d.png", i), false);
  }
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{20, 21, 22}));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "12 significant bits: divided by 16")) << notes;
}

TEST_F(RecordingTest, ColourAndGreyMixedAreUsedInGrey) {
  WriteNumbered(4);
  cv::Mat colour;
  cv::cvtColor(Plain(2, false), colour, cv::COLOR_GRAY2BGR);
  scratch_.WritePicture("r/000002.png", colour);
  FolderRecording recording(Numbered());
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "r/000002.png' is in colour, the others grey")) << notes;
  const auto pair = recording.Load(2);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->left.type(), CV_8UC1);
  EXPECT_EQ(pair->right.type(), CV_8UC1);
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 3}));
}

// ---- videos

TEST_F(RecordingTest, TwoVideos) {
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

TEST_F(RecordingTest, ARateReplacesTheTimesOfVideos) {
  VideoRecording recording({WriteSide("l.avi", 3, true), WriteSide("r.avi", 3, false, 25),
                            VideoLayout::kTwoVideos, 10.0});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2}));
  EXPECT_EQ(TimesOf(&recording), (Times{0, 100000, 200000}));
}

TEST_F(RecordingTest, VideosOfTwoRatesArePairedByTime) {
  std::vector<cv::Mat> twice;
  for (int i = 0; i < 5; ++i) twice.insert(twice.end(), 2, Plain(i, false));
  VideoRecording recording({WriteSide("l.avi", 5, true, 10), WriteVideo("r.avi", twice, 20)});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 3, 4}));
  EXPECT_TRUE(Holds(Notes(&recording), "paired by time"));
}

TEST_F(RecordingTest, BothImagesInOneVideo) {
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

TEST_F(RecordingTest, OfVideosOfDifferentLengthsTheCommonPartIsUsed) {
  VideoRecording recording({WriteSide("l.avi", 5, true), WriteSide("r.avi", 8, false)});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 3, 4}));
  EXPECT_TRUE(Holds(Notes(&recording), "has 5 images, " + Path("r.avi") + " 8: the first 5 pairs"));
}

TEST_F(RecordingTest, OfAVideoThatIsCutShortTheBeginningIsKept) {
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

TEST_F(RecordingTest, WhatIsNoVideoIsRefused) {
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

// ---- rectified

StereoRig Unrectified() {
  StereoRig rig;
  rig.left = {kWidth, kHeight, 60, 60, 32, 24, LensModel::kRadialTangential, {-0.1, 0.01, 0, 0}};
  rig.right = rig.left;
  rig.T_L_R.rotation = ExpSo3({0.01, -0.02, 0.005});
  rig.T_L_R.translation = {0.12, 0.001, 0};
  rig.files = {"rig.yaml"};
  return rig;
}

TEST_F(RecordingTest, ARectifiedSequenceHoldsWhatTheRectifierMakes) {
  WriteNumbered(3);
  const cv::Mat left = NoisePicture(kWidth, kHeight, 1);
  const cv::Mat right = NoisePicture(kWidth, kHeight, 2);
  scratch_.WritePicture("l/000001.png", left);
  scratch_.WritePicture("r/000001.png", right);
  const RectifiedSequence sequence(std::make_unique<FolderRecording>(Numbered()), Unrectified());
  const StereoRectifier rectifier(Unrectified());
  EXPECT_EQ(sequence.num_frames(), 3u);
  EXPECT_EQ(sequence.camera(), rectifier.camera());
  EXPECT_FALSE(sequence.has_people());
  const SequenceFrame frame = sequence.Load(1);
  EXPECT_EQ(frame.utime, 50000);
  EXPECT_EQ(sequence.utime(1), 50000);
  const auto decode = [](const std::vector<std::uint8_t>& file) {
    return cv::imdecode(file, cv::IMREAD_UNCHANGED);
  };
  EXPECT_EQ(cv::norm(decode(frame.left_image_file), rectifier.Left(left), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(decode(frame.right_image_file), rectifier.Right(right), cv::NORM_INF), 0);
  EXPECT_FALSE(frame.ground_truth);
}

TEST_F(RecordingTest, ACalibrationOfAnotherSizeIsRefused) {
  WriteNumbered(2);
  StereoRig rig = Unrectified();
  rig.left.width = rig.right.width = 80;
  const std::string refusal =
      ErrorOf([&] { RectifiedSequence(std::make_unique<FolderRecording>(Numbered()), rig); });
  EXPECT_TRUE(Holds(refusal, "has images of 64x48 px, the calibration is for 80x48 px")) << refusal;
}

// ---- EuRoC

class EurocTest : public RecordingTest {
 protected:
  static constexpr std::int64_t kFirst_ns = 1403636579763555584;

  static std::string Sensor(const std::string& T_BS) {
    return "%YAML:1.0\nsensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [" + T_BS +
           "]\nrate_hz: 20\nresolution: [64, 48]\ncamera_model: pinhole\n"
           "intrinsics: [60, 60, 32, 24]\ndistortion_model: radial-tangential\n"
           "distortion_coefficients: [-0.1, 0.01, 0, 0]\n";
  }
  static std::string Name(int i) {
    return Format("%ld.png", static_cast<long>(kFirst_ns + 50000000L * i));
  }

  /// The camera looks along the body's x axis; the body drives along x, 0.1 m an image.
  void WriteEuroc(int count) const {
    std::string csv = "#timestamp [ns],filename\n";
    std::string truth = "#timestamp, p_RS_R_x [m], ...\n";
    for (int i = 0; i < count; ++i) {
      WriteLeft("mav0/cam0/data/" + Name(i), i);
      WriteRight("mav0/cam1/data/" + Name(i), i);
      csv += Format("%ld,", static_cast<long>(kFirst_ns + 50000000L * i)) + Name(i) + "\r\n";
    }
    for (int i = 0; i < 2 * count; ++i) {  // between the images
      truth +=
          Format("%ld,%g,1,2,1,0,0,0,0,0,0,0,0,0,0,0,0\n",
                 static_cast<long>(kFirst_ns + 12500000L + 25000000L * i), 0.1 * (0.25 + 0.5 * i));
    }
    Write("mav0/cam0/data.csv", csv);
    Write("mav0/cam0/sensor.yaml", Sensor("0,0,1,0, -1,0,0,0, 0,-1,0,0, 0,0,0,1"));
    Write("mav0/cam1/sensor.yaml", Sensor("0,0,1,0, -1,0,0,-0.11, 0,-1,0,0, 0,0,0,1"));
    Write("mav0/state_groundtruth_estimate0/data.csv", truth);
  }
};

TEST_F(EurocTest, IsADataSetWithGroundTruth) {
  WriteEuroc(4);
  const auto sequence = OpenStereoSequence(folder_.string());
  ASSERT_EQ(sequence->num_frames(), 4u);
  EXPECT_NEAR(sequence->camera().baseline_m, 0.11, 1e-9);
  EXPECT_EQ(sequence->Load(0).utime, 1403636579763556);
  EXPECT_EQ(sequence->ground_truth_axes(), TrajectoryAxes::kOptical);
  EXPECT_FALSE(sequence->ground_truth(0)) << "before the first row";
  const auto first = sequence->ground_truth(1);
  const auto last = sequence->ground_truth(3);
  ASSERT_TRUE(first && last);
  EXPECT_LT(first->translation.norm(), 1e-9);
  EXPECT_LT((last->translation - Eigen::Vector3d(0, 0, 0.2)).norm(), 1e-6)
      << "forward is the camera's z axis: " << last->translation.transpose();
  EXPECT_TRUE(HasSequenceLayout(Path("mav0")));
  EXPECT_EQ(OpenStereoSequence(Path("mav0"))->num_frames(), 4u);
}

TEST_F(EurocTest, WithoutACalibrationItIsRefused) {
  WriteEuroc(3);
  fs::remove(Path("mav0/cam1/sensor.yaml"));
  EXPECT_TRUE(Holds(ErrorOf([&] { OpenStereoSequence(folder_.string()); }),
                    "cam1/sensor.yaml: is not there"));
}

TEST_F(EurocTest, DamagedGroundTruthNamesTheLine) {
  WriteEuroc(3);
  const std::string truth = "mav0/state_groundtruth_estimate0/data.csv";
  const auto refusal = [&](const std::string& line) {
    Write(truth, "#head\n" + line + "\n");
    return ErrorOf([&] { OpenStereoSequence(folder_.string()); });
  };
  EXPECT_TRUE(Holds(refusal("1403636579763555584,1,2,3"), "data.csv:2: must hold a time in ns"));
  EXPECT_TRUE(Holds(refusal("1403636579763555584,1,2,3,0.5,0,0,0"), "not of length 1"));
  EXPECT_TRUE(Holds(refusal("x,1,2,3,1,0,0,0"), "'x' is not a time in ns"));
}

}  // namespace
}  // namespace airdos
