#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "common/dataset/sequence_files.h"
#include "common/dataset/shibuya_sequence.h"
#include "common/dataset/stereo_sequence.h"
#include "tests/support/input_errors.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// A folder that lives as long as one test.
class DatasetTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_dataset_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  void Write(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(Path(name)).parent_path());
    std::ofstream(Path(name)) << text;
  }
  void WriteImage(const std::string& name, int width, int height) const {
    fs::create_directories(fs::path(Path(name)).parent_path());
    cv::imwrite(Path(name), cv::Mat(height, width, CV_8UC1, cv::Scalar(90)));
  }
  void WriteCalibration() const {
    Write("calib.json", R"({"fx": 500, "fy": 500, "cx": 321, "cy": 181, "baseline_m": 0.2})");
  }
  void WriteImages(const std::string& left, const std::string& right, int count, int width = 640,
                   int height = 360) const {
    for (int i = 0; i < count; ++i) {
      const std::string name = "00000" + std::to_string(i);
      WriteImage(left + "/" + name + ".png", width, height);
      WriteImage(right + "/" + name + ".jpg", width, height);
    }
  }
  std::string OpenMessage() const {
    return ErrorOf([&] { OpenStereoSequence(folder_.string()); });
  }

  fs::path folder_;
};

std::string PersonRow(double first) {
  std::string row;
  for (int j = 0; j < 18; ++j) {
    row += std::to_string(first + j) + " " + std::to_string(2 * j) + " 0.5 ";
  }
  return row + "\n";
}

TEST(ParseMicrosecondsTest, KeepsEveryMicrosecond) {
  const std::vector<std::pair<std::string, std::int64_t>> cases = {
      {"0", 0},
      {"0.1", 100000},
      {"24.359021056", 24359021},
      {"1311868164.363181", 1311868164363181},
      {"9007199254.740993", 9007199254740993},  // 2^53 + 1: lost in a double
      {"1.036224e-01", 103622},
      {"1.036225e+01", 10362250},
      {"0.0000005", 1},
      {"0.0000004999", 0},
      {"-1.5", -1500000},
      {".5", 500000},
      {"5e-7", 1},
      {"5e-8", 0},
      {"7.", 7000000}};
  for (const auto& [text, expected] : cases) {
    std::int64_t utime = -77;
    EXPECT_TRUE(ParseMicroseconds(text, &utime)) << text;
    EXPECT_EQ(utime, expected) << text;
  }
}

TEST(ParseMicrosecondsTest, RejectsWhatIsNoTime) {
  for (const std::string text : {"", "abc", "1.2.3", "1e", "1e+", "e5", "nan", "inf", "--1", "0x10",
                                 "99999999999999999999", "1e300", "1,5", "."}) {
    std::int64_t utime = 0;
    EXPECT_FALSE(ParseMicroseconds(text, &utime)) << text;
  }
}

TEST_F(DatasetTest, ReadsShibuyaLayout) {
  WriteImages("image_0", "image_1", 3);
  Write("calib.json", R"({"fx": 500, "fy": 501, "cx": 321, "cy": 181, "baseline_m": 0.2})");
  Write("times.txt", "10.000001\n10.1\n10.2\n");
  Write("alphapose_0/000001.txt", PersonRow(7) + PersonRow(100));
  Write("alphapose_1/000001.txt", "");
  WriteImage("rcnnseg_image_0/000002.png", 640, 360);
  Write("gt_pose.txt", "10.000001 1 2 3 0 0 0 1\n10.2 2 2 3 0 0 0.6 0.8\n");

  const auto sequence = OpenStereoSequence(folder_.string());
  EXPECT_EQ(sequence->num_frames(), 3u);
  EXPECT_EQ(sequence->camera().width, 640);
  EXPECT_EQ(sequence->camera().height, 360);
  EXPECT_EQ(sequence->camera().fx_px, 500);
  EXPECT_EQ(sequence->camera().fy_px, 501);
  EXPECT_EQ(sequence->camera().cx_px, 321);
  EXPECT_EQ(sequence->camera().cy_px, 181);
  EXPECT_EQ(sequence->camera().baseline_m, 0.2);
  EXPECT_EQ(sequence->ground_truth_axes(), TrajectoryAxes::kNed);
  EXPECT_TRUE(sequence->has_people());

  const SequenceFrame first = sequence->Load(0);
  EXPECT_EQ(first.utime, 10000001);
  EXPECT_EQ(first.left_image_file, ReadBytes(Path("image_0/000000.png")));
  EXPECT_EQ(first.right_image_file, ReadBytes(Path("image_1/000000.jpg")));
  EXPECT_TRUE(first.person_mask_file.empty());
  EXPECT_TRUE(first.keypoints_left.empty());
  ASSERT_TRUE(first.ground_truth);
  EXPECT_EQ(first.ground_truth->translation, Eigen::Vector3d(1, 2, 3));

  const SequenceFrame second = sequence->Load(1);
  ASSERT_EQ(second.keypoints_left.size(), 2u);
  EXPECT_EQ(second.keypoints_left[1][17].u_px, 117);
  EXPECT_EQ(second.keypoints_left[1][17].v_px, 34);
  EXPECT_EQ(second.keypoints_left[1][17].confidence, 0.5f);
  EXPECT_TRUE(second.keypoints_right.empty());
  EXPECT_FALSE(second.ground_truth);

  const SequenceFrame third = sequence->Load(2);
  EXPECT_EQ(third.person_mask_file, ReadBytes(Path("rcnnseg_image_0/000002.png")));
  EXPECT_NEAR(third.ground_truth->rotation.z(), 0.6, 1e-15);
  EXPECT_EQ(sequence->notes().size(), 1u);  // one image without a pose
}

TEST_F(DatasetTest, SaysWhatItAssumed) {
  WriteImages("image_0", "image_1", 2);
  WriteCalibration();
  const auto sequence = OpenStereoSequence(folder_.string());
  EXPECT_EQ(sequence->Load(1).utime, 100000);
  EXPECT_FALSE(sequence->has_people());
  EXPECT_EQ(sequence->ground_truth_axes(), TrajectoryAxes::kUnknown);
  ASSERT_EQ(sequence->notes().size(), 1u);
  EXPECT_NE(sequence->notes()[0].find("0.1 s apart"), std::string::npos);
}

TEST_F(DatasetTest, LendsThePublicCalibrationOnlyWhereItIsAskedFor) {
  WriteImages("image_0", "image_1", 1);
  EXPECT_NE(OpenMessage().find("calib.json: is not there"), std::string::npos) << OpenMessage();
  const auto sequence = OpenStereoSequence(folder_.string(), {kPublicCalibration});
  EXPECT_EQ(sequence->camera().fx_px, 772.5483399593904);
  EXPECT_EQ(sequence->camera().baseline_m, 0.25);
  EXPECT_NE(ErrorOf([&] {
              OpenStereoSequence(folder_.string(), {"zed"});
            }).find("calibration 'zed': is unknown"),
            std::string::npos);
  WriteImages("image_0", "image_1", 1, 320, 240);
  EXPECT_NE(ErrorOf([&] {
              OpenStereoSequence(folder_.string(), {kPublicCalibration});
            }).find("is not that of the public data set"),
            std::string::npos);
}

TEST_F(DatasetTest, NamesFileAndLineOfBadKeypoints) {
  WriteImages("image_0", "image_1", 1);
  WriteCalibration();
  Write("alphapose_0/000000.txt", PersonRow(1) + "1 2 3\n");
  const auto sequence = OpenStereoSequence(folder_.string());
  const std::string where = Path("alphapose_0/000000.txt") + ":2: ";
  EXPECT_EQ(ErrorOf([&] { sequence->Load(0); }).find(where + "holds 3 numbers"), 0u);
  Write("alphapose_0/000000.txt", PersonRow(1) + "1 nan 3\n");
  EXPECT_EQ(ErrorOf([&] { sequence->Load(0); }), where + "'nan' is not a finite number");
}

TEST_F(DatasetTest, NamesWhatIsWrongWithTheFolder) {
  EXPECT_NE(OpenMessage().find("no known layout"), std::string::npos);
  WriteImages("image_0", "image_1", 2);
  Write("times.txt", "0\n");
  EXPECT_EQ(OpenMessage().find(Path("times.txt") + ": holds 1 times for 2 images"), 0u);
  Write("times.txt", "2\n1\n");
  EXPECT_EQ(OpenMessage(),
            Path("times.txt") + ":2: time '1' does not come after the previous one, '2'");
  Write("times.txt", "0\n1\n");
  Write("calib.json", R"({"fx": 500, "cx": 321, "cy": 181, "baseline_m": 0.2})");
  EXPECT_EQ(OpenMessage().find(Path("calib.json") + ": key 'fy' is missing"), 0u);
  Write("calib.json",
        R"({"fx": 500, "fy": 500, "cx": 321, "cy": 181, "baseline_m": 0.2, "width": 641})");
  EXPECT_EQ(OpenMessage(),
            Path("calib.json") + ": key 'width' with value '641': the first image has 640 px");
  Write("calib.json", "{");
  EXPECT_EQ(OpenMessage().find(Path("calib.json") + ":1: column 2: "), 0u) << OpenMessage();
  Write("calib.json", "[1]");
  EXPECT_EQ(OpenMessage().find(Path("calib.json") + ": is not a JSON object"), 0u);
  WriteCalibration();
  Write("gt_pose.txt", "0 1 2 3 0 0 0 1\n0.1 1 2 3 0 0 0 2\n");
  EXPECT_EQ(OpenMessage(), Path("gt_pose.txt") + ":2: the quaternion is not of length 1");
  fs::remove(Path("gt_pose.txt"));
  fs::remove(Path("image_1/000001.jpg"));
  EXPECT_NE(OpenMessage().find("holds 1 images"), std::string::npos);
  WriteImage("image_1/000007.png", 640, 360);
  EXPECT_NE(OpenMessage().find("only on the left: '000001.png'; only on the right: '000007.png'"),
            std::string::npos);
}

TEST_F(DatasetTest, SaysThatAnImageIsNone) {
  WriteImages("image_0", "image_1", 2);
  WriteCalibration();
  Write("image_1/000001.jpg", "no image");
  const auto sequence = OpenStereoSequence(folder_.string());
  EXPECT_EQ(ErrorOf([&] { sequence->Load(1); }),
            Path("image_1/000001.jpg") + ": is neither a JPEG nor a PNG file");
}

TEST(ContradictsNedTest, TellsDrivingFromFlyingSideways) {
  std::vector<Se3> forward;
  std::vector<Se3> along_z;
  std::vector<Se3> on_its_side;
  for (int i = 0; i < 10; ++i) {
    forward.push_back({Eigen::Quaterniond::Identity(), {0.1 * i, 0.02 * i, 0.01 * i}});
    along_z.push_back({Eigen::Quaterniond::Identity(), {0.02 * i, 0.01 * i, 0.1 * i}});
    on_its_side.push_back(
        {Eigen::Quaterniond(Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitX())), {0.1 * i, 0, 0}});
  }
  EXPECT_FALSE(ContradictsNed(forward));
  EXPECT_TRUE(ContradictsNed(along_z));
  EXPECT_TRUE(ContradictsNed(on_its_side));
  EXPECT_FALSE(ContradictsNed({}));
}

constexpr char kP0[] = "700 0 320 0 0 700 180 0 0 0 1 0";
constexpr char kP1[] = "700 0 320 -350 0 700 180 0 0 0 1 0";

TEST_F(DatasetTest, ReadsKittiLayout) {
  WriteImages("image_l", "image_r", 3, 640, 350);
  Write("calib.txt", std::string(kP0) + "\n" + kP1);
  Write("poses.txt",
        "1 0 0 5 0 1 0 6 0 0 1 7\n0 -1 0 8 1 0 0 9 0 0 1 10\n1 0 0 0 0 1 0 0 0 0 1 0\n");
  const auto sequence = OpenStereoSequence(folder_.string());
  EXPECT_EQ(sequence->num_frames(), 3u);
  EXPECT_EQ(sequence->camera().height, 350);
  EXPECT_EQ(sequence->camera().baseline_m, 0.5);
  EXPECT_EQ(sequence->ground_truth_axes(), TrajectoryAxes::kOptical);
  EXPECT_FALSE(sequence->has_people());
  EXPECT_EQ(sequence->Load(2).utime, 200000);
  const Se3 pose = *sequence->Load(1).ground_truth;
  EXPECT_EQ(pose.translation, Eigen::Vector3d(8, 9, 10));
  EXPECT_NEAR((pose.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0,
              1e-12);

  Write("calib.txt", std::string("P0: ") + kP0 + "\nP1: " + kP1 + "\nP2: 1 2\nTr: 1 2 3\n");
  EXPECT_EQ(OpenStereoSequence(folder_.string())->camera(), sequence->camera());
}

TEST_F(DatasetTest, NamesWhatIsWrongWithKittiFiles) {
  WriteImages("image_0", "image_1", 1);
  const std::string calib = Path("calib.txt");
  Write("calib.txt", std::string(kP0) + "\n");
  EXPECT_EQ(OpenMessage(), calib + ": must hold the lines P0: and P1:, or two lines of 12 numbers");
  Write("calib.txt", std::string("P0: ") + kP0 + "\nP1: 1 2 3\n");
  EXPECT_EQ(OpenMessage(), calib + ":2: must hold 12 numbers (3 x 4 projection), holds 3");
  Write("calib.txt", std::string(kP1) + "\n" + kP0);
  EXPECT_NE(OpenMessage().find("baseline -0.5"), std::string::npos) << OpenMessage();
  Write("calib.txt", std::string(kP0) + "\n701 0 320 -350 0 700 180 0 0 0 1 0\n");
  EXPECT_NE(OpenMessage().find("not a rectified pair"), std::string::npos);
  Write("calib.txt", std::string(kP0) + "\n" + kP1);
  Write("poses.txt", "1 0 0 5 0 1 0 6 0 0 1\n");
  EXPECT_EQ(OpenMessage(), Path("poses.txt") + ":1: must hold 12 numbers (3 x 4), holds 11");
  Write("poses.txt", "1 0 0 5 0 1 0 6 0 0 2 7\n");
  EXPECT_NE(OpenMessage().find("poses.txt:1: columns"), std::string::npos);
}

/// A row of OXTS: latitude, longitude (deg), altitude (m), roll, pitch, yaw (rad), and 24 others.
std::string OxtsRow(double latitude, double longitude, double altitude, double yaw) {
  char row[200];
  std::snprintf(row, sizeof row, "%.12f %.12f %.6f 0 0 %.12f", latitude, longitude, altitude, yaw);
  std::string text = row;
  for (int i = 0; i < 24; ++i) text += " 0";
  return text + "\n";
}

/// KITTI tracking with a camera 0.1 m left of camera 0 and 2 m ahead of the inertial unit: I and
/// the laser scanner have x forward, y left, z up.
class KittiTrackingTest : public DatasetTest {
 protected:
  void SetUp() override {
    DatasetTest::SetUp();
    WriteImages("training/image_02/0013", "training/image_03/0013", 3);
    Write("training/calib/0013.txt",
          "P0: 700 0 320 0 0 700 180 0 0 0 1 0\nP1: 700 0 320 -350 0 700 180 0 0 0 1 0\n"
          "P2: 700 0 320 70 0 700 180 0 0 0 1 0\nP3: 700 0 320 -280 0 700 180 0 0 0 1 0\n"
          "R_rect 1 0 0 0 1 0 0 0 1\nTr_velo_cam 0 -1 0 0 0 0 -1 0 1 0 0 -0.5\n"
          "Tr_imu_velo 1 0 0 -1.5 0 1 0 0 0 0 1 0\n");
    // 3 m east, then a turn to the left on the spot.
    const double degree_m = 6378137 * std::cos(60 * M_PI / 180) * M_PI / 180;
    Write("training/oxts/0013.txt", OxtsRow(60, 8, 100, 0) +
                                        OxtsRow(60, 8 + 3 / degree_m, 100.5, 0) +
                                        OxtsRow(60, 8 + 3 / degree_m, 100.5, M_PI / 2));
  }
  std::string Sequence() const { return Path("training/image_02/0013"); }
  std::string Message() const {
    return ErrorOf([&] { OpenStereoSequence(Sequence()); });
  }
};

TEST_F(KittiTrackingTest, GroundTruthIsThatOfTheLeftColourCamera) {
  const auto sequence = OpenStereoSequence(Sequence() + "/");
  EXPECT_EQ(sequence->num_frames(), 3u);
  EXPECT_DOUBLE_EQ(sequence->camera().baseline_m, 0.5);
  EXPECT_EQ(sequence->camera().fx_px, 700);
  EXPECT_EQ(sequence->ground_truth_axes(), TrajectoryAxes::kOptical);
  EXPECT_FALSE(sequence->has_people());
  EXPECT_EQ(sequence->Load(2).utime, 200000);
  EXPECT_NEAR(sequence->Load(0).ground_truth->translation.norm(), 0, 1e-9);
  // 3 m forward and half a metre up.
  const Se3 ahead = *sequence->Load(1).ground_truth;
  EXPECT_NEAR((ahead.translation - Eigen::Vector3d(0, -0.5, 3)).norm(), 0, 1e-6);
  // The camera was 2 m ahead of the unit and 0.1 m left of its x axis: a turn to the left brings it
  // 2 m to the left and 2 m back, and 0.1 m further back.
  const Se3 turned = *sequence->Load(2).ground_truth;
  EXPECT_NEAR((turned.translation - ahead.translation - Eigen::Vector3d(-1.9, 0, -2.1)).norm(), 0,
              1e-6)
      << turned.translation.transpose();
  EXPECT_NEAR((turned.rotation * Eigen::Vector3d::UnitZ() + Eigen::Vector3d::UnitX()).norm(), 0,
              1e-9);
}

TEST_F(KittiTrackingTest, ReadsPeopleAndOtherNamesOfTransforms) {
  Write("training/alphapose_0/0013/000001.txt", PersonRow(1));
  Write("training/alphapose_1/0013/000001.txt", PersonRow(1));
  WriteImage("training/rcnnseg_image_0/0013/000001.png", 640, 360);
  Write("training/calib/0013.txt",
        "P2: 700 0 320 70 0 700 180 0 0 0 1 0\nP3: 700 0 320 -280 0 700 180 0 0 0 1 0\n"
        "R0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: 0 -1 0 0 0 0 -1 0 1 0 0 -0.5\n"
        "Tr_imu_to_velo: 1 0 0 -1.5 0 1 0 0 0 0 1 0\n");
  const auto sequence = OpenStereoSequence(Sequence());
  EXPECT_TRUE(sequence->has_people());
  EXPECT_TRUE(sequence->Load(0).keypoints_left.empty());
  EXPECT_EQ(sequence->Load(1).keypoints_right.size(), 1u);
  EXPECT_FALSE(sequence->Load(1).person_mask_file.empty());
  EXPECT_NEAR(sequence->Load(1).ground_truth->translation.z(), 3, 1e-6);
}

TEST_F(KittiTrackingTest, SaysWhereTheGroundTruthIsMissing) {
  fs::remove(Path("training/oxts/0013.txt"));
  auto sequence = OpenStereoSequence(Sequence());
  EXPECT_FALSE(sequence->Load(1).ground_truth);
  EXPECT_NE(sequence->notes().back().find("oxts/0013.txt is not there"), std::string::npos);
  Write("training/oxts/0013.txt", OxtsRow(60, 8, 100, 0));
  EXPECT_NE(Message().find("holds 1 records for 3 images"), std::string::npos) << Message();
  Write("training/calib/0013.txt",
        "P2: 700 0 320 70 0 700 180 0 0 0 1 0\nP3: 700 0 320 -280 0 700 180 0 0 0 1 0\n");
  EXPECT_FALSE(OpenStereoSequence(Sequence())->Load(0).ground_truth);
}

TEST_F(KittiTrackingTest, NamesWhatIsWrong) {
  Write("training/oxts/0013.txt", "60 8 100 0 0 0\n");
  EXPECT_EQ(Message(), Path("training/oxts/0013.txt") + ":1: must hold 30 numbers (OXTS), holds 6");
  Write("training/oxts/0013.txt", OxtsRow(95, 8, 100, 0));
  EXPECT_NE(Message().find("oxts/0013.txt:1: latitude"), std::string::npos) << Message();
  Write("training/calib/0013.txt", "P2: 700 0 320 70 0 700 180 0 0 0 1 0\n");
  EXPECT_EQ(Message(), Path("training/calib/0013.txt") + ": has no line P3");
  Write("training/calib/0013.txt",
        "P2: 700 0 320 70 0 700 180 0 0 0 1 0\nP3: 700 0 320 -280 0 700 180 0 0 0 1 0\n"
        "R_rect 1 0 0 0 1 0 0 0 2\n");
  EXPECT_NE(Message().find("calib/0013.txt:3: is not a rotation"), std::string::npos) << Message();
}

// The sequences that the project is measured on.
class SharedDataTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("AIRDOS_DATA_DIR");
    data_ = folder != nullptr ? folder : AIRDOS_SOURCE_DIR "/../shared/data";
    if (!fs::is_directory(data_)) GTEST_SKIP() << "no data at " << data_ << " (AIRDOS_DATA_DIR)";
  }
  std::string data_;
};

TEST_F(SharedDataTest, ReadsTheCrossing) {
  for (const std::string name : {"Standing01", "Standing02", "RoadCrossing03", "RoadCrossing04",
                                 "RoadCrossing05", "RoadCrossing06", "RoadCrossing07"}) {
    const auto sequence = OpenStereoSequence(data_ + "/crossing/" + name);
    EXPECT_EQ(sequence->num_frames(), 100u) << name;
    EXPECT_EQ(sequence->ground_truth_axes(), TrajectoryAxes::kNed) << name;
    EXPECT_TRUE(sequence->notes().empty()) << name << ": " << sequence->notes().front();
    const SequenceFrame frame = sequence->Load(99);
    EXPECT_EQ(frame.utime, 9900000) << name;
    EXPECT_FALSE(frame.keypoints_left.empty()) << name;
    EXPECT_FALSE(frame.keypoints_right.empty()) << name;
    EXPECT_FALSE(frame.person_mask_file.empty()) << name;
    EXPECT_TRUE(frame.ground_truth) << name;
  }
}

TEST_F(SharedDataTest, ReadsTheKittiExcerpts) {
  const auto drive = OpenStereoSequence(data_ + "/kitti_odo_seq1");
  EXPECT_EQ(drive->num_frames(), 51u);
  EXPECT_EQ(drive->camera().width, 1226);
  EXPECT_EQ(drive->camera().height, 370);
  EXPECT_NEAR(drive->camera().baseline_m, 0.5371506, 1e-6);
  EXPECT_FALSE(drive->has_people());
  EXPECT_TRUE(drive->Load(50).ground_truth);

  const auto walk = OpenStereoSequence(data_ + "/kitti_raw_pedestrian");
  EXPECT_EQ(walk->num_frames(), 76u);
  EXPECT_EQ(walk->camera().width, 1242);
  EXPECT_NEAR(walk->camera().baseline_m, 0.5371506, 1e-6);
  EXPECT_TRUE(walk->has_people());
  EXPECT_EQ(walk->Load(0).utime, 24359021);
  EXPECT_EQ(walk->ground_truth_axes(), TrajectoryAxes::kOptical);
  for (std::size_t i = 0; i < walk->num_frames(); ++i) EXPECT_TRUE(walk->Load(i).ground_truth);
}

}  // namespace
}  // namespace airdos
