// Names, rows, times and pixels of images: each limit just below and just above.
#include <gtest/gtest.h>

#include <string>

#include "common/dataset/file_name.h"
#include "common/dataset/image_file.h"
#include "common/dataset/image_names.h"
#include "common/dataset/image_rows.h"
#include "common/dataset/sequence_files.h"
#include "common/dataset/times_file.h"
#include "common/util/error.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

using Numbers = std::vector<std::uint64_t>;

ImageNames Images(const Numbers& numbers) {
  ImageNames images;
  images.folder = "f";
  images.numbers = numbers;
  for (const std::uint64_t number : numbers) {
    images.keys.push_back(std::to_string(number));
    images.files.push_back(images.keys.back() + ".png");
  }
  return images;
}

class ImageReadersValuesTest : public ::testing::Test {
 protected:
  std::vector<std::int64_t> Times(const std::string& text) {
    return ReadTimes(folder_.Write("times.txt", text));
  }
  std::string TimesError(const std::string& text) {
    return ErrorOf([&] { Times(text); });
  }
  ScratchFolder folder_{"image_readers_values"};
};

TEST(TimeUnitsValuesTest, ByTheFirstTimeOrTheStep) {
  EXPECT_EQ(OtherTimeUnit(1.5e17, 0), "ns");
  EXPECT_EQ(OtherTimeUnit(1.5e14, 0), "us");
  EXPECT_EQ(OtherTimeUnit(1.5e11, 0), "ms");
  EXPECT_EQ(OtherTimeUnit(0.5e11, 0.1), "");
  EXPECT_EQ(OtherTimeUnit(0, 4.99), "");
  EXPECT_EQ(OtherTimeUnit(0, 5), "ms");
  EXPECT_EQ(OtherTimeUnit(0, 1000), "ms");
  EXPECT_EQ(OtherTimeUnit(0, 1001), "");
  EXPECT_EQ(OtherTimeUnit(0, 50000), "us");
  EXPECT_EQ(OtherTimeUnit(0, 5e7), "ns");
}

TEST_F(ImageReadersValuesTest, TimesAreRowsOfOneNumberThatGrows) {
  EXPECT_EQ(Times("0\n0.1\n# a pause\n0.2\n20\n"),
            (std::vector<std::int64_t>{0, 100000, 200000, 20000000}));
  EXPECT_TRUE(Holds(TimesError("5\n5\n5\n"), "all 3 times are '5'"));
  const std::string twice = TimesError("0\n0.1\n0.1\n0.2\n");
  EXPECT_TRUE(Holds(twice, ":3: time '0.1'")) << twice;
  EXPECT_FALSE(Holds(twice, "all 4"));
  EXPECT_TRUE(Holds(TimesError("0\n0.1\n0.0999999\n"), ":3: time '0.0999999'"));
  EXPECT_TRUE(Holds(TimesError("0 1\n0.1 2\n"), ":1: must hold one time"));
}

TEST(ParseMicrosecondsValuesTest, RoundsTheSeventhDecimal) {
  const auto parsed = [](const std::string& text) {
    std::int64_t utime = -77;
    EXPECT_TRUE(ParseMicroseconds(text, &utime)) << text;
    return utime;
  };
  EXPECT_EQ(parsed("1.0000014"), 1000001);
  EXPECT_EQ(parsed("1.0000015"), 1000002);
  EXPECT_EQ(parsed("5e-7"), 1);
  EXPECT_EQ(parsed("4e-7"), 0);
  EXPECT_EQ(parsed("5e-8"), 0);
  EXPECT_EQ(parsed("-1.5"), -1500000);
  EXPECT_EQ(parsed("+12.5e-3"), 12500);
}

TEST(ImageRowsValuesTest, GapsAreCounted) {
  EXPECT_EQ(GapsOf({}), "");
  EXPECT_EQ(GapsOf({3, 4, 5}), "");
  EXPECT_EQ(GapsOf({3, 4, 6}), "5 is missing");
  EXPECT_EQ(GapsOf({3, 4, 6, 9}), "5 and 2 more are missing");
}

TEST(ImageRowsValuesTest, RowsByNumbersFromZeroOrOne) {
  using Rows = std::vector<std::size_t>;
  std::vector<std::string> notes;
  const auto rows = [&](const Numbers& numbers) {
    return RowsOfImages("t", "times", 3, Images(numbers), &notes);
  };
  EXPECT_EQ(rows({7, 8, 9}), (Rows{0, 1, 2}));
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(rows({0, 2}), (Rows{0, 2}));
  EXPECT_EQ(rows({1, 2}), (Rows{1, 2}));
  EXPECT_EQ(rows({1, 3}), (Rows{0, 2}));
  EXPECT_EQ(notes.size(), 3u);
  EXPECT_THROW(rows({0, 3}), InputError);
  EXPECT_THROW(rows({2, 4}), InputError);
  EXPECT_THROW(rows({0, 1, 2, 3}), InputError);
}

TEST_F(ImageReadersValuesTest, ASecondSeriesIsARivalFromAQuarterOn) {
  for (int i = 0; i < 8; ++i) folder_.Write("left" + std::to_string(i) + ".png");
  folder_.Write("other0.png");
  EXPECT_EQ(ListImages(folder_.path()).files.size(), 8u);
  folder_.Write("other1.png");
  EXPECT_TRUE(Holds(ErrorOf([&] { ListImages(folder_.path()); }), "two kinds of names"));
  folder_.Write("left8.png");
  const ImageNames names = ListImages(folder_.path());
  EXPECT_EQ(names.files.size(), 9u);
  ASSERT_EQ(names.notes.size(), 1u);
  EXPECT_TRUE(Holds(names.notes[0], "'other0.png', 'other1.png' are not named"));
}

TEST_F(ImageReadersValuesTest, OneStrayAmongThreeIsNoRival) {
  for (const char* name : {"left0.png", "left1.png", "left2.png", "cover5.png"})
    folder_.Write(name);
  EXPECT_EQ(ListImages(folder_.path()).files.size(), 3u);
}

TEST_F(ImageReadersValuesTest, AHashInANameIsNoNumber) {
  for (const char* name : {"left3of4.png", "left4of4.png", "left5of4.png", "left#of4.png"}) {
    folder_.Write(name);
  }
  const ImageNames names = ListImages(folder_.path());
  EXPECT_EQ(names.files,
            (std::vector<std::string>{"left3of4.png", "left4of4.png", "left5of4.png"}));
  ASSERT_EQ(names.notes.size(), 1u);
  EXPECT_TRUE(Holds(names.notes[0], "'left#of4.png'"));
}

TEST(ImageNamesValuesTest, TimesOfNames) {
  const auto times = TimesFromNames(Images({1403636579763555584, 1403636579813555584}));
  ASSERT_TRUE(times);
  EXPECT_EQ(times->unit, "ns");
  EXPECT_EQ(times->utimes, (std::vector<std::int64_t>{1403636579763556, 1403636579813556}));
  const auto steps = TimesFromNames(Images({0, 5000, 10000}));
  ASSERT_TRUE(steps);
  EXPECT_EQ(steps->unit, "us");
  EXPECT_EQ(steps->utimes, (std::vector<std::int64_t>{0, 5000, 10000}));
  EXPECT_FALSE(TimesFromNames(Images({0, 4999, 9998})));
  const auto seconds = TimesFromNames(Images({1000000000, 1000000050}));
  ASSERT_TRUE(seconds);
  EXPECT_EQ(seconds->unit, "s");
  EXPECT_EQ(seconds->utimes[1], 1000000050000000);
  EXPECT_FALSE(TimesFromNames(Images({1000000000, 1000000100, 1000000200})));
}

TEST(ImageNamesValuesTest, TimesWithDecimals) {
  ImageNames names;
  names.keys = {"1.5", "1.505"};
  ASSERT_TRUE(TimesFromNames(names));
  EXPECT_EQ(TimesFromNames(names)->utimes, (std::vector<std::int64_t>{1500000, 1505000}));
  names.keys = {"1.5", "1.504"};
  EXPECT_FALSE(TimesFromNames(names));
  names.keys = {"1.5", "61.5"};
  EXPECT_TRUE(TimesFromNames(names));
  names.keys = {"1.5", "61.6"};
  EXPECT_FALSE(TimesFromNames(names));
}

TEST_F(ImageReadersValuesTest, APartnerHasTheLeftNameFirst) {
  ImageNames left = Images({5, 6, 7, 8});
  ImageNames right = left;
  left.files = {"L5.jpg", "L6.jpg", "L7.jpg", "L8.jpg"};
  right.files = {"R5.jpg", "R6.jpg", "R7.jpg", "R8.jpg"};
  for (const char* name : {"L5.txt", "R5.txt", "R6.txt"}) folder_.Write(name);
  EXPECT_EQ(FindPartners(folder_.path(), ".txt", left, right),
            (std::vector<std::string>{"L5.txt", "R6.txt", "", ""}));
  ScratchFolder numbered("image_readers_numbered");
  for (const char* name : {"0006.txt", "0008.txt"}) numbered.Write(name);
  EXPECT_EQ(FindPartners(numbered.path(), ".txt", left, right),
            (std::vector<std::string>{"", "0006.txt", "", "0008.txt"}));
}

TEST(ImageNamesValuesTest, PairsHaveTheSameNumbers) {
  EXPECT_NO_THROW(CheckPairs(Images({1, 2}), Images({1, 2})));
  const std::string error = ErrorOf([] { CheckPairs(Images({1, 2}), Images({1, 3})); });
  EXPECT_TRUE(Holds(error, "only on the left: '2.png'")) << error;
  EXPECT_TRUE(Holds(error, "only on the right: '3.png'")) << error;
}

TEST(FileNameValuesTest, NumbersOfNames) {
  using Parts = std::vector<std::string>;
  EXPECT_EQ(TakeApart("img1.250.png").numbers, (Parts{"1.25"}));
  EXPECT_EQ(TakeApart("img1.25.png").numbers, (Parts{"1", "25"}));
  EXPECT_EQ(TakeApart("123456.7.png").numbers, (Parts{"123456.7"}));
  EXPECT_EQ(TakeApart("12345.7.png").numbers, (Parts{"12345", "7"}));
  EXPECT_EQ(TakeApart("a007b0.png").numbers, (Parts{"7", "0"}));
  EXPECT_TRUE(IsNumberLess("9", "10"));
  EXPECT_FALSE(IsNumberLess("10", "9"));
  EXPECT_TRUE(IsNumberLess("1.25", "1.3"));
  EXPECT_FALSE(IsNumberLess("7", "7"));
}

std::vector<std::uint8_t> Png(const cv::Mat& picture) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", picture, bytes);
  return bytes;
}

TEST(ImageFileValuesTest, SixteenBitsAreShiftedAndBounded) {
  const cv::Mat samples = (cv::Mat_<std::uint16_t>(2, 2) << 4095, 4096, 1615, 0);
  const Picture picture =
      DecodePicture(Png(samples), "x", PictureColor::kGrey, SixteenBitRange{12});
  ASSERT_EQ(picture.pixels.type(), CV_8UC1);
  EXPECT_EQ(picture.pixels.at<std::uint8_t>(0, 0), 255);
  EXPECT_EQ(picture.pixels.at<std::uint8_t>(0, 1), 255);
  EXPECT_EQ(picture.pixels.at<std::uint8_t>(1, 0), 100);
  EXPECT_EQ(picture.pixels.at<std::uint8_t>(1, 1), 0);
  EXPECT_DOUBLE_EQ(picture.saturated, 0.25);
}

/// Pairs of files in a folder: L0.png, R0.png, ..
class PairsOfFiles : public StereoSequence {
 public:
  PairsOfFiles(const ScratchFolder& folder, std::size_t num) : folder_(folder), num_(num) {}
  const StereoCamera& camera() const override { return camera_; }
  std::size_t num_frames() const override { return num_; }
  TrajectoryAxes ground_truth_axes() const override { return TrajectoryAxes::kUnknown; }
  bool has_people() const override { return false; }
  SequenceFrame Load(std::size_t /*index*/) const override { return {}; }
  FrameFiles files(std::size_t index) const override {
    const std::string name = std::to_string(index) + ".png";
    return {folder_.PathOf("L" + name), folder_.PathOf("R" + name), "", "", ""};
  }

 private:
  const ScratchFolder& folder_;
  std::size_t num_;
  StereoCamera camera_;
};

TEST_F(ImageReadersValuesTest, TheRangeOfBitsIsThatOfFirstAndLastAndNotOfAHotPixel) {
  cv::Mat samples(50, 100, CV_16UC1, cv::Scalar(1000));  // ten bits
  folder_.WritePicture("R0.png", samples);
  samples.at<std::uint16_t>(3, 4) = 40000;
  folder_.WritePicture("L0.png", samples);
  EXPECT_EQ(FindSixteenBitRange(PairsOfFiles(folder_, 1))->bits, 10);  // 1 of 10000
  samples.at<std::uint16_t>(5, 6) = 40000;
  folder_.WritePicture("L0.png", samples);
  EXPECT_EQ(FindSixteenBitRange(PairsOfFiles(folder_, 1))->bits, 16);

  for (int i = 0; i < 12; ++i) {
    const cv::Mat plain(4, 6, CV_16UC1, cv::Scalar(i == 11 ? 4000 : 1000));
    folder_.WritePicture("L" + std::to_string(i) + ".png", plain);
    folder_.WritePicture("R" + std::to_string(i) + ".png", plain);
  }
  EXPECT_EQ(FindSixteenBitRange(PairsOfFiles(folder_, 12))->bits, 12);
  EXPECT_EQ(FindSixteenBitRange(PairsOfFiles(folder_, 11))->bits, 10);
}

TEST_F(ImageReadersValuesTest, ASurveyGoesOverBothCameras) {
  folder_.WritePicture("L0.png", cv::Mat(4, 6, CV_8UC1, cv::Scalar(1)));
  folder_.WritePicture("R0.png", cv::Mat(5, 7, CV_8UC3, cv::Scalar(1, 2, 3)));
  folder_.Write("L1.png", "no picture");
  const std::vector<SurveyedImage> images = SurveyImages(PairsOfFiles(folder_, 2));
  ASSERT_EQ(images.size(), 4u);
  EXPECT_EQ(images[0].path, folder_.PathOf("L0.png"));
  EXPECT_TRUE(images[0].is_left);
  EXPECT_EQ(images[1].path, folder_.PathOf("R0.png"));
  EXPECT_FALSE(images[1].is_left);
  ASSERT_TRUE(images[0].header && images[1].header);
  EXPECT_EQ(images[0].header->width, 6);
  EXPECT_EQ(images[0].header->height, 4);
  EXPECT_EQ(images[1].header->width, 7);
  EXPECT_EQ(images[1].header->num_channels, 3);
  EXPECT_EQ(images[1].error, "");
  EXPECT_TRUE(Holds(images[2].error, "L1.png: is neither"));
  EXPECT_TRUE(Holds(images[3].error, "R1.png"));
}

TEST(ImageFileValuesTest, HowSizesDiffer) {
  const auto text = [](int width, int height) {
    return SizeMismatchText(width, height, "x", 640, 360);
  };
  EXPECT_TRUE(Holds(text(360, 640), "turned by 90"));
  EXPECT_FALSE(Holds(text(360, 200), "turned"));
  EXPECT_TRUE(Holds(text(320, 180), "0.5 times as large"));
  EXPECT_TRUE(Holds(text(320, 90), "another aspect ratio"));
  EXPECT_TRUE(Holds(text(160, 180), "another aspect ratio"));
  EXPECT_TRUE(Holds(text(320, 180), "has 320 x 180 px, x 640 x 360 px"));
}

}  // namespace
}  // namespace airdos
