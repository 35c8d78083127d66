// Keypoints and masks of people, and what else lies in their folders, value by value.
#include <gtest/gtest.h>

#include <string>

#include "common/dataset/folder_survey.h"
#include "common/dataset/keypoint_file.h"
#include "common/dataset/mask_file.h"
#include "common/human/body_keypoints.h"
#include "common/util/error.h"
#include "common/util/image_header.h"
#include "tests/support/input_errors.h"
#include "tests/support/palette_png.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

/// Joint j at (j + 0.5, 100 + j) with confidence 0.01 j, but for the first two.
std::string Row(int num_joints) {
  std::string row;
  for (int j = 0; j < num_joints; ++j) {
    const double confidence = j == 0 ? 1.25 : j == 1 ? -0.5 : 0.01 * j;
    row += std::to_string(j + 0.5) + " " + std::to_string(100 + j) + " " +
           std::to_string(confidence) + " ";
  }
  return row + "\n";
}

class KeypointMaskValuesTest : public ::testing::Test {
 protected:
  ScratchFolder folder_{"keypoint_mask_values"};
};

TEST_F(KeypointMaskValuesTest, EachLayoutIsReadJointByJoint) {
  for (const auto& [num, wanted] : {std::make_pair(18, KeypointLayout::kCoco18),
                                    {17, KeypointLayout::kCoco17},
                                    {26, KeypointLayout::kHalpe26}}) {
    const std::string path = folder_.Write("p.txt", "# u v confidence\n\n" + Row(num) + Row(num));
    const KeypointFile raw = ReadRawKeypoints(path);
    const KeypointFile file = ReadKeypoints(path);
    ASSERT_TRUE(file.layout);
    EXPECT_EQ(*file.layout, wanted);
    EXPECT_EQ(FindLayout({"", folder_.PathOf("none.txt"), path}), wanted);
    ASSERT_EQ(file.people.size(), 2u);
    ASSERT_EQ(file.people[1].size(), static_cast<std::size_t>(num));
    const Keypoint& last = file.people[1].back();
    EXPECT_FLOAT_EQ(last.u_px, static_cast<float>(num) - 0.5F);
    EXPECT_FLOAT_EQ(last.v_px, static_cast<float>(num) + 99.F);
    EXPECT_FLOAT_EQ(last.confidence, 0.01F * static_cast<float>(num - 1));
    EXPECT_FLOAT_EQ(raw.people[0][0].confidence, 1.25F);
    EXPECT_FLOAT_EQ(raw.people[0][1].confidence, -0.5F);
    EXPECT_EQ(file.people[0][0].confidence, 1.F);
    EXPECT_EQ(file.people[0][1].confidence, 0.F);
  }
}

TEST_F(KeypointMaskValuesTest, TwoLayoutsAreRefusedWithBothNames) {
  const std::string path = folder_.Write("mixed.txt", Row(18) + Row(17));
  EXPECT_TRUE(
      Holds(ErrorOf([&] { ReadKeypoints(path); }), "mixed.txt:2: holds a person in COCO-17"));
  const std::string a = folder_.Write("a.txt", Row(18));
  const std::string b = folder_.Write("b.txt", Row(18));
  const std::string c = folder_.Write("c.txt", Row(26));
  const std::string error = ErrorOf([&] { FindLayout({a, b, c}); });
  EXPECT_EQ(error, c + ": holds people in Halpe-26, but " + a +
                       " in COCO-18; all of a data set must have the same layout");
}

std::vector<std::uint8_t> Png(const cv::Mat& picture) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", picture, bytes);
  return bytes;
}

PersonMask Decoded(const std::vector<std::uint8_t>& bytes) {
  return DecodePersonMask(bytes.data(), bytes.size(), "mask");
}

const png_color kBlack = {0, 0, 0};
const png_color kRed = {200, 0, 0};
const png_color kGreen = {0, 200, 0};
const png_color kBlue = {0, 0, 200};

TEST(MaskValuesTest, IndicesOfAPaletteWhateverTheirColours) {
  const std::vector<std::uint8_t> indices = {0, 1, 2, 0, 0, 1};
  const PersonMask mask = Decoded(PalettePng({kBlack, kRed, kGreen}, 3, indices));
  EXPECT_EQ(mask.kind, "palette");
  EXPECT_EQ(mask.doubt, "");
  ASSERT_EQ(mask.pixels.size(), cv::Size(3, 2));
  for (int i = 0; i < 6; ++i) {
    const int index = indices[static_cast<std::size_t>(i)];
    EXPECT_EQ(mask.values.at<std::uint8_t>(i / 3, i % 3), index) << i;
    EXPECT_EQ(mask.pixels.at<std::uint8_t>(i / 3, i % 3), index == 0 ? 0 : 255) << i;
  }
}

TEST(MaskValuesTest, AnInterlacedMaskIsReadInAllItsPasses) {
  std::vector<std::uint8_t> indices;
  for (int i = 0; i < 11 * 10; ++i) indices.push_back(static_cast<std::uint8_t>(i % 3));
  const PersonMask mask =
      Decoded(PalettePng({kBlack, kRed, kGreen}, 11, indices, PNG_INTERLACE_ADAM7));
  ASSERT_EQ(mask.values.size(), cv::Size(11, 10));
  for (int i = 0; i < 11 * 10; ++i)
    EXPECT_EQ(mask.values.at<std::uint8_t>(i / 11, i % 11), i % 3) << i;
}

TEST(MaskValuesTest, ABackgroundThatIsNotBlackIsADoubtWhereBlackIsThere) {
  const std::vector<std::uint8_t> indices = {0, 1};
  EXPECT_EQ(Decoded(PalettePng({kRed, kBlue}, 2, indices)).doubt, "");
  EXPECT_NE(Decoded(PalettePng({kRed, kBlack}, 2, indices)).doubt, "");
  EXPECT_NE(Decoded(PalettePng({kGreen, kBlack}, 2, indices)).doubt, "");
  EXPECT_NE(Decoded(PalettePng({kBlue, kBlack}, 2, indices)).doubt, "");
  EXPECT_EQ(Decoded(PalettePng({kBlack, kBlack}, 2, indices)).doubt, "");
}

TEST(MaskValuesTest, TheLargestSampleOfAPixelCounts) {
  for (int channel = 0; channel < 3; ++channel) {
    cv::Mat picture(1, 2, CV_8UC3, cv::Scalar(0, 0, 0));
    picture.at<cv::Vec3b>(0, 1)[channel] = 7;
    const PersonMask mask = Decoded(Png(picture));
    EXPECT_EQ(mask.kind, "RGB");
    EXPECT_EQ(mask.values.at<std::uint8_t>(0, 0), 0);
    EXPECT_EQ(mask.values.at<std::uint8_t>(0, 1), 7) << channel;
  }
}

TEST(MaskValuesTest, NumbersOfSixteenBitsKeepTheirValue) {
  const PersonMask mask = Decoded(Png((cv::Mat_<std::uint16_t>(1, 4) << 0, 1, 256, 513)));
  ASSERT_EQ(mask.values.type(), CV_16UC1);
  EXPECT_EQ(mask.values.at<std::uint16_t>(0, 1), 1);
  EXPECT_EQ(mask.values.at<std::uint16_t>(0, 2), 256);
  EXPECT_EQ(mask.values.at<std::uint16_t>(0, 3), 513);
  EXPECT_EQ(cv::countNonZero(mask.pixels), 3);
}

TEST_F(KeypointMaskValuesTest, OnlyWhatIsPlainIsHandedOnAsItIs) {
  const cv::Mat grey = (cv::Mat_<std::uint8_t>(2, 3) << 0, 1, 2, 0, 0, 9);
  const std::string path = folder_.WritePicture("m.png", grey);
  EXPECT_EQ(ReadMaskFile(path, 3, 2), Png(grey));
  EXPECT_THROW(ReadMaskFile(path, 3, 3), InputError);
  EXPECT_THROW(ReadMaskFile(path, 4, 2), InputError);

  const auto palette = PalettePng({kBlack, kRed, kGreen}, 3, {0, 1, 2, 0, 0, 1});
  folder_.Write("p.png", std::string(palette.begin(), palette.end()));
  const std::vector<std::uint8_t> plain = ReadMaskFile(folder_.PathOf("p.png"), 3, 2);
  EXPECT_FALSE(ReadImageHeader(plain.data(), plain.size())->is_palette);
  const PersonMask mask = Decoded(plain);
  EXPECT_EQ(mask.kind, "8-bit grey");
  EXPECT_EQ(cv::countNonZero(mask.pixels), 3);
}

double Rippled(const cv::Mat& values) {
  PersonMask mask;
  mask.values = values;
  return RippledShare(mask);
}

// Of 7 x 7 numbers the inner 25 have neighbours on all sides.
TEST(MaskValuesTest, RipplesAreCountedInRowsAndColumns) {
  cv::Mat values(7, 7, CV_8UC1, cv::Scalar(100));
  EXPECT_EQ(Rippled(values), 0);
  values.at<std::uint8_t>(3, 3) = 112;
  EXPECT_DOUBLE_EQ(Rippled(values), 1 / 25.0);
  values.at<std::uint8_t>(3, 3) = 88;
  EXPECT_DOUBLE_EQ(Rippled(values), 1 / 25.0);
  values.at<std::uint8_t>(3, 3) = 113;
  EXPECT_EQ(Rippled(values), 0);
  values = cv::Mat(7, 7, CV_8UC1, cv::Scalar(100));
  values.row(3).setTo(110);
  EXPECT_DOUBLE_EQ(Rippled(values), 5 / 25.0);
  values = cv::Mat(7, 7, CV_8UC1, cv::Scalar(100));
  values.col(2).setTo(110);
  EXPECT_DOUBLE_EQ(Rippled(values), 5 / 25.0);
  values.colRange(4, 7).setTo(0);  // 3 x 5 inner ones are marked
  EXPECT_DOUBLE_EQ(Rippled(values), 5 / 15.0);
}

TEST_F(KeypointMaskValuesTest, OtherMaskFilesAreFilesThatAreSeen) {
  for (const char* name : {"b.jpg", "a.npy", "c.png", ".d.jpg", "e.jpg/f.png"}) folder_.Write(name);
  EXPECT_EQ(ListOtherMaskFiles(folder_.path()), (std::vector<std::string>{"a.npy", "b.jpg"}));
}

/// "WHERE: WHAT" of everything that is not read; errors begin with "!".
std::vector<std::string> Unread(const ScratchFolder& folder) {
  std::vector<std::string> all;
  for (const UnreadFiles& unread : FindUnreadFiles(folder.path()))
    all.push_back((unread.is_error ? "!" : "") + unread.where.substr(folder.path().size()) + ": " +
                  unread.what);
  return all;
}

bool HasOne(const std::vector<std::string>& all, const std::string& start,
            const std::string& part) {
  int num = 0;
  for (const std::string& one : all) num += one.rfind(start, 0) == 0 && Holds(one, part) ? 1 : 0;
  return num == 1;
}

TEST_F(KeypointMaskValuesTest, OtherFilesInOurFoldersAreErrorsWhereNothingElseIsThere) {
  for (const char* name : {"image_0/0.png", "image_0/0.tif", "image_1/0.png", "alphapose_0/0.json",
                           "alphapose_1/0.txt", "keypoints_b/0.txt"}) {
    folder_.Write(name);
  }
  const std::vector<std::string> unread = Unread(folder_);
  EXPECT_TRUE(HasOne(unread, "/image_0: holds 1 .tif", "not read"));
  EXPECT_TRUE(HasOne(unread, "!/alphapose_0: holds only 1 .json", "not read"));
  EXPECT_TRUE(HasOne(unread, "!/alphapose_0: holds only 1 .json", "airdos-import"));
  EXPECT_TRUE(HasOne(unread, "/keypoints_b: ", "rename"));
  EXPECT_EQ(unread.size(), 3u);
}

TEST_F(KeypointMaskValuesTest, KeypointsOfBothCamerasMakeOtherFoldersIdle) {
  for (const char* name :
       {"image_0/0.png", "image_1/0.png", "alphapose_0/0.txt", "keypoints_b/0.txt"})
    folder_.Write(name);
  EXPECT_TRUE(HasOne(Unread(folder_), "/keypoints_b: ", "rename"));
  folder_.Write("alphapose_1/0.txt");
  EXPECT_TRUE(Unread(folder_).empty());
}

TEST_F(KeypointMaskValuesTest, FilesOfOtherNamesCountWhereOursIsMissing) {
  for (const char* name :
       {"image_0/0.png", "image_1/0.png", "calib.json", "timestamps.csv", "truth.csv"})
    folder_.Write(name);
  EXPECT_TRUE(HasOne(Unread(folder_), "/timestamps.csv: ", "times.txt"));
  EXPECT_TRUE(HasOne(Unread(folder_), "/truth.csv: ", "is read from gt_pose.txt"));
  folder_.Write("times.txt");
  EXPECT_FALSE(HasOne(Unread(folder_), "/timestamps.csv: ", "times.txt"));
  folder_.Write("calib.txt");  // now it is KITTI's layout
  EXPECT_TRUE(HasOne(Unread(folder_), "/truth.csv: ", "is read from poses.txt"));
  folder_.Write("gt_pose.txt");
  EXPECT_TRUE(HasOne(Unread(folder_), "/gt_pose.txt: ", "is read from poses.txt"));
  folder_.Write("poses.txt");
  EXPECT_TRUE(Unread(folder_).empty());
}

TEST_F(KeypointMaskValuesTest, DataSetsBelowAreListedUpToTwelve) {
  const auto make = [&](int i) { folder_.Write("s" + std::to_string(10 + i) + "/calib.txt"); };
  make(0);
  EXPECT_TRUE(Holds(ExplainFolder(folder_.path()), "the data set is the folder below it"));
  make(1);
  EXPECT_TRUE(Holds(ExplainFolder(folder_.path()), "holds 2 data sets: s10, s11; choose"));
  for (int i = 2; i < 12; ++i) make(i);
  EXPECT_TRUE(Holds(ExplainFolder(folder_.path()), "s20, s21; choose"));
  make(12);
  EXPECT_TRUE(Holds(ExplainFolder(folder_.path()), "s20, s21 and 1 more; choose"));
}

TEST(SideSwapValuesTest, EachConcernsItsJointsInBothDirections) {
  const std::vector<std::pair<int, int>> legs = {{kRightKnee, kLeftKnee},
                                                 {kRightAnkle, kLeftAnkle}};
  const std::vector<std::pair<int, int>> arms = {{kRightElbow, kLeftElbow},
                                                 {kRightWrist, kLeftWrist}};
  const std::vector<std::pair<int, int>> trunk = {{kRightShoulder, kLeftShoulder},
                                                  {kRightHip, kLeftHip}};
  const auto expect = [](const auto& pairs, SideSwap swap, bool are_swapped) {
    for (const auto& [right, left] : pairs) {
      EXPECT_EQ(SwappedJoint(right, swap), are_swapped ? left : right);
      EXPECT_EQ(SwappedJoint(left, swap), are_swapped ? right : left);
    }
  };
  for (const SideSwap swap :
       {SideSwap::kNone, SideSwap::kLowerLegs, SideSwap::kLowerArms, SideSwap::kAll}) {
    expect(legs, swap, swap == SideSwap::kLowerLegs || swap == SideSwap::kAll);
    expect(arms, swap, swap == SideSwap::kLowerArms || swap == SideSwap::kAll);
    expect(trunk, swap, swap == SideSwap::kAll);
    EXPECT_EQ(SwappedJoint(kNose, swap), kNose);
    EXPECT_EQ(SwappedJoint(kNeck, swap), kNeck);
  }
}

TEST(KeypointNoiseValuesTest, TheFactorOfDoubtIsOfWhatTheHeightAllows) {
  KeypointNoise noise;
  noise.min_px = 2;
  noise.per_height = 0.01;
  noise.full_confidence = 0.9;
  noise.per_confidence = 3;
  noise.max_factor = 2.8;
  EXPECT_DOUBLE_EQ(noise.Sigma(0.9, 100), 2);
  EXPECT_DOUBLE_EQ(noise.Sigma(1, 100), 2);
  EXPECT_DOUBLE_EQ(noise.Sigma(0.4, 100), 5);  // 1 + 3 * 0.5 times
  EXPECT_DOUBLE_EQ(noise.Sigma(0.4, 400), 10);
  EXPECT_DOUBLE_EQ(noise.Sigma(0, 100), 5.6);  // 3.7 times would be too much
}

TEST(MedianValuesTest, IsTheLowerOfTwo) {
  EXPECT_EQ(Median({4, 1, 3, 2}), 2);
  EXPECT_EQ(Median({9, 1, 5}), 5);
  EXPECT_FALSE(Median({}));
}

}  // namespace
}  // namespace airdos
