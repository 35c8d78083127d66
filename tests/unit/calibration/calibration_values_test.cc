// What calibrations, poses and their causes of error are made of, number by number: all differ, and
// none is zero by chance.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <string>

#include "common/calibration/calib_json.h"
#include "common/calibration/camera_causes.h"
#include "common/dataset/kitti_calibration.h"
#include "common/dataset/oxts.h"
#include "common/dataset/sequence_files.h"
#include "common/dataset/shibuya_sequence.h"
#include "common/dataset/stereo_sequence.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

class CalibrationValuesTest : public ::testing::Test {
 protected:
  StereoCamera ReadJson(const std::string& text, std::pair<int, int> size = {1242, 375}) {
    return ReadCalibJson(folder_.Write("calib.json", text), size);
  }
  std::string JsonError(const std::string& text) {
    return ErrorOf([&] { ReadJson(text); });
  }
  ScratchFolder folder_{"calibration_values"};
};

constexpr char kFive[] = R"("fx":721.5,"fy":688.25,"cx":609.5,"cy":172.75,"baseline_m":0.54)";

std::string Json(const std::string& more = "") {
  return std::string("{").append(kFive).append(more.empty() ? "" : ",").append(more).append("}");
}

TEST_F(CalibrationValuesTest, AJsonCameraFieldByField) {
  for (const char* more :
       {"", R"("width":1242)", R"("height":375)", R"("width":1242,"height":375)"}) {
    const StereoCamera camera = ReadJson(Json(more));
    EXPECT_EQ(camera.fx_px, 721.5);
    EXPECT_EQ(camera.fy_px, 688.25);
    EXPECT_EQ(camera.cx_px, 609.5);
    EXPECT_EQ(camera.cy_px, 172.75);
    EXPECT_EQ(camera.baseline_m, 0.54);
    EXPECT_EQ(camera.width, 1242);
    EXPECT_EQ(camera.height, 375);
  }
}

TEST_F(CalibrationValuesTest, AnotherSizeThanTheImagesHaveIsRefusedWithItsCause) {
  for (const char* said :
       {R"("width":1241)", R"("width":1243)", R"("height":374)", R"("height":376)"}) {
    const std::string error = JsonError(Json(said));
    EXPECT_TRUE(Holds(error, Holds(said, "width") ? "has 1242 px" : "has 375 px")) << error;
    EXPECT_FALSE(Holds(error, ";")) << error;
  }
  EXPECT_TRUE(Holds(JsonError(Json(R"("width":2484,"height":750)")), "twice as large"));
  EXPECT_FALSE(Holds(JsonError(Json(R"("width":2484,"height":1500)")), "as large"));
  EXPECT_TRUE(Holds(JsonError(Json(R"("width":375,"height":1242)")), "are exchanged"));
  EXPECT_FALSE(Holds(JsonError(Json(R"("width":375,"height":1241)")), "are exchanged"));
}

TEST_F(CalibrationValuesTest, AJsonThatIsNoneIsRefusedAtItsPlace) {
  EXPECT_TRUE(Holds(JsonError("{\"fx\": 1,\n \"fy\": @}"), ":2: column 8:"));
  EXPECT_TRUE(Holds(JsonError("{\"fx\": @}"), ":1: column 8:"));
  EXPECT_TRUE(Holds(JsonError(R"({"fx":"721.5"})"), "without quotes"));
  EXPECT_TRUE(Holds(JsonError(R"({"fx":[1]})"), "must be a number"));
  std::string text = Json();
  text.resize(100000, ' ');
  EXPECT_EQ(JsonError(text), "");
  EXPECT_TRUE(Holds(JsonError(text + " "), "more than 100000 bytes"));
}

TEST_F(CalibrationValuesTest, AProjectionHasTwelveNumbers) {
  const TextLine line = {7, {"P2:", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12"}};
  const KittiProjection projection = ParseProjection("x", line, 1);
  EXPECT_EQ(projection.line, 7);
  EXPECT_EQ(projection.p, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  EXPECT_TRUE(Holds(ErrorOf([&] { ParseProjection("x", line, 2); }), "x:7: must hold 12"));
  TextLine longer = line;
  longer.words.push_back("13");
  EXPECT_TRUE(Holds(ErrorOf([&] { ParseProjection("x", longer, 1); }), "holds 13"));
}

StereoCamera Camera(double cx_px, double cy_px) {
  StereoCamera camera;
  camera.width = 640;
  camera.height = 360;
  camera.fx_px = 500;
  camera.fy_px = 480;
  camera.cx_px = cx_px;
  camera.cy_px = cy_px;
  camera.baseline_m = 0.25;
  return camera;
}

TEST(CameraCausesValuesTest, TheFactorIsThatOfBothSides) {
  EXPECT_NEAR(ResolutionFactor(Camera(640, 360)).value_or(0), 2, 1e-12);
  EXPECT_NEAR(ResolutionFactor(Camera(640, 367.2)).value_or(0), std::sqrt(2 * 2.04), 1e-12);
  EXPECT_FALSE(ResolutionFactor(Camera(640, 180)));
  EXPECT_FALSE(ResolutionFactor(Camera(320, 360)));
  EXPECT_FALSE(ResolutionFactor(Camera(1.09 * 320, 1.09 * 180)));
  EXPECT_TRUE(ResolutionFactor(Camera(1.11 * 320, 1.11 * 180)));
}

TEST(CameraCausesValuesTest, BothCoordinatesOfAPointAreExchanged) {
  EXPECT_TRUE(IsPrincipalPointSwapped(Camera(180, 320)));
  EXPECT_FALSE(IsPrincipalPointSwapped(Camera(180, 100)));
  EXPECT_FALSE(IsPrincipalPointSwapped(Camera(400, 320)));
  StereoCamera square = Camera(200, 200);
  square.width = square.height = 400;
  EXPECT_FALSE(IsPrincipalPointSwapped(square));
}

TEST(CameraCausesValuesTest, ABaselineInOtherUnits) {
  StereoCamera camera = Camera(320, 180);
  camera.baseline_m = 125;  // 500 px * 0.25 m, 12.5 cm
  EXPECT_TRUE(Holds(ExplainBaseline(camera), "(bf) in px m it would be 0.25 m"));
  EXPECT_TRUE(Holds(ExplainBaseline(camera), "mm instead of m it would be 0.125 m"));
  camera.baseline_m = 1.9;
  EXPECT_EQ(ExplainBaseline(camera), "");
}

TEST(CameraCausesValuesTest, APointOnTheImagesEdgeIsOutside) {
  for (const auto& [cx, cy] :
       {std::make_pair(640.0, 180.0), {320.0, 360.0}, {0.0, 180.0}, {320.0, 0.0}}) {
    EXPECT_FALSE(Camera(cx, cy).IsValid());
    EXPECT_TRUE(Holds(WhyNoCamera(Camera(cx, cy)), "principal point")) << cx << " " << cy;
  }
  EXPECT_EQ(WhyNoCamera(Camera(639.5, 359.5)), "");
}

/// The folder of a sequence with pictures of 40 x 30 px.
class SequenceValuesTest : public CalibrationValuesTest {
 protected:
  void WritePictures(const std::string& left, const std::string& right, int num) {
    for (int i = 0; i < num; ++i) {
      const std::string name = std::string("/00000").append(std::to_string(i)) + ".png";
      folder_.WritePicture(left + name, cv::Mat(30, 40, CV_8UC1, cv::Scalar(50 + i)));
      folder_.WritePicture(right + name, cv::Mat(30, 40, CV_8UC1, cv::Scalar(90 + i)));
    }
  }
  std::string NotesOf(const StereoSequence& sequence) {
    std::string all;
    for (const std::string& note : sequence.notes()) all += note + "\n";
    return all;
  }
};

constexpr char kP0[] = "50 0 20.5 0 0 48 14.25 0 0 0 1 0\n";
constexpr char kP1[] = "50 0 20.5 -25 0 48 14.25 0 0 0 1 0\n";

void ExpectSmallCamera(const StereoCamera& camera) {
  EXPECT_EQ(camera.width, 40);
  EXPECT_EQ(camera.height, 30);
  EXPECT_EQ(camera.fx_px, 50);
  EXPECT_EQ(camera.fy_px, 48);
  EXPECT_EQ(camera.cx_px, 20.5);
  EXPECT_EQ(camera.cy_px, 14.25);
  EXPECT_NEAR(camera.baseline_m, 0.5, 1e-12);
}

TEST_F(SequenceValuesTest, KittiByNamesOrByTwoLines) {
  WritePictures("image_0", "image_1", 2);
  folder_.Write("times.txt", "0\n0.1\n");
  for (const std::string& text : {std::string("P0: ") + kP0 + "P1: " + kP1, std::string(kP0) + kP1,
                                  std::string("P1: ") + kP1 + "P0: " + kP0 + "P2: " + kP0}) {
    folder_.Write("calib.txt", text);
    const auto sequence = OpenStereoSequence(folder_.path());
    ExpectSmallCamera(sequence->camera());
    EXPECT_FALSE(Holds(NotesOf(*sequence), "lies off")) << text;
  }
  folder_.Write("calib.txt", std::string(kP0) + kP1 + kP1);
  EXPECT_TRUE(Holds(ErrorOf([&] { OpenStereoSequence(folder_.path()); }), "calib.txt:3:"));
}

TEST_F(SequenceValuesTest, KittiColourCamerasAreNotedByTheirOffsets) {
  WritePictures("image_0", "image_1", 1);
  folder_.Write("times.txt", "0\n");
  const auto note = [&](const std::string& left, const std::string& right) {
    folder_.Write("calib.txt", std::string("P0: ").append(left) + "\nP1: " + right + "\n");
    return NotesOf(*OpenStereoSequence(folder_.path()));
  };
  const std::string plain = "50 0 20.5 -25 0 48 14.25 0 0 0 1 0";
  for (const char* left : {"50 0 20.5 5 0 48 14.25 0 0 0 1 0", "50 0 20.5 -5 0 48 14.25 0 0 0 1 0"})
    EXPECT_TRUE(Holds(note(left, plain), "calib.txt:1: a camera that lies off")) << left;
  const std::string first = "50 0 20.5 0 0 48 14.25 0 0 0 1 0";
  EXPECT_TRUE(Holds(note("50 0 20.5 0 0 48 14.25 -2 0 0 1 0", plain), "lies off"));
  EXPECT_TRUE(Holds(note("50 0 20.5 0 0 48 14.25 0 0 0 1 -2", plain), "lies off"));
  EXPECT_TRUE(Holds(note(first, "50 0 20.5 -25 0 48 14.25 -2 0 0 1 0"), "calib.txt:2:"));
  EXPECT_TRUE(Holds(note(first, "50 0 20.5 -25 0 48 14.25 0 0 0 1 -2"), "calib.txt:2:"));
}

// A quarter turn about z: what was x is y.
TEST_F(SequenceValuesTest, KittiPosesAreRowsOfMatrices) {
  WritePictures("image_0", "image_1", 2);
  folder_.Write("times.txt", "0\n0.1\n");
  folder_.Write("calib.txt", std::string(kP0) + kP1);
  folder_.Write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 1 1 0 0 2 0 0 1 3\n");
  const auto sequence = OpenStereoSequence(folder_.path());
  EXPECT_EQ(sequence->ground_truth_axes(), TrajectoryAxes::kOptical);
  const std::optional<Se3> pose = sequence->ground_truth(1);
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->translation - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT((pose->rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((pose->rotation * Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitX()).norm(), 1e-12);
  folder_.Write("poses.txt", "1 0 0 0 0 1 0 0 0 0 -1 0\n");
  EXPECT_TRUE(
      Holds(ErrorOf([&] { ReadKittiPoses(folder_.PathOf("poses.txt")); }), "not a rotation"));
}

constexpr char kRect[] = "R_rect 0 -1 0 1 0 0 0 0 1\n";
constexpr char kOthers[] =
    "P2: 50 0 20.5 2.5 0 48 14.25 -1.25 0 0 1 0.0625\n"
    "P3: 50 0 20.5 -24.5 0 48 14.25 0.5 0 0 1 0.03\n"
    "Tr_velo_cam 1 0 0 0.1 0 0 -1 0.2 0 1 0 0.3\nTr_imu_velo 0 0 1 -0.4 0 1 0 0.5 -1 0 0 0.6\n";

std::string OxtsRow(const std::string& start) {
  std::string row = start;
  for (int i = 6; i < 30; ++i) row.append(" ").append(std::to_string(i));
  return row + "\n";
}

Eigen::Matrix4d Homogeneous(const Se3& pose) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
  T.topRightCorner<3, 1>() = pose.translation;
  return T;
}

TEST_F(SequenceValuesTest, KittiTrackingGoesThroughAllTransforms) {
  WritePictures("image_02/0004", "image_03/0004", 2);
  folder_.Write("calib/0004.txt", std::string(kRect) + kOthers);
  const std::string oxts_path =
      folder_.Write("oxts/0004.txt", OxtsRow("49.5 8.25 115.5 0.1 -0.2 0.7") +
                                         OxtsRow("49.50001 8.25002 116 0.15 -0.1 0.9"));
  const auto sequence = OpenStereoSequence(folder_.PathOf("image_02/0004"));
  EXPECT_NEAR(sequence->camera().baseline_m, 0.54, 1e-12);
  EXPECT_EQ(sequence->camera().fy_px, 48);

  Eigen::Matrix3d K;
  K << 50, 0, 20.5, 0, 48, 14.25, 0, 0, 1;
  Eigen::Matrix4d T_C_rect = Eigen::Matrix4d::Identity();  // K (p + t) is P2 applied to p
  T_C_rect.topRightCorner<3, 1>() = K.inverse() * Eigen::Vector3d(2.5, -1.25, 0.0625);
  Eigen::Matrix4d R_rect, T_cam_velo, T_velo_imu;
  R_rect << 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  T_cam_velo << 1, 0, 0, 0.1, 0, 0, -1, 0.2, 0, 1, 0, 0.3, 0, 0, 0, 1;
  T_velo_imu << 0, 0, 1, -0.4, 0, 1, 0, 0.5, -1, 0, 0, 0.6, 0, 0, 0, 1;
  const Eigen::Matrix4d T_C_I = T_C_rect * R_rect * T_cam_velo * T_velo_imu;
  const std::vector<Se3> imu = ReadOxts(oxts_path);  // for itself in dataset_values_test
  const Eigen::Matrix4d expected =
      T_C_I * Homogeneous(imu[0]).inverse() * Homogeneous(imu[1]) * T_C_I.inverse();
  ASSERT_TRUE(sequence->ground_truth(0) && sequence->ground_truth(1));
  EXPECT_TRUE(Homogeneous(*sequence->ground_truth(0)).isIdentity(1e-6));
  EXPECT_LT((Homogeneous(*sequence->ground_truth(1)) - expected).norm(), 1e-6);

  folder_.Write("calib/0004.txt", std::string("R_rect 1 0 0 0 1 0 0 0 -1\n") + kOthers);
  EXPECT_TRUE(Holds(ErrorOf([&] { OpenStereoSequence(folder_.PathOf("image_02/0004")); }),
                    "0004.txt:1: is not a rotation"));
}

TEST_F(SequenceValuesTest, TheScaleOfTheMapIsThatOfTheFirstRow) {
  const std::string path = folder_.Write(
      "oxts.txt", OxtsRow("49.5 8.25 115.5 0 0 0") + OxtsRow("60.5 8.25 115.5 0 0 0"));
  const std::vector<Se3> poses = ReadOxts(path);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_NEAR(poses[0].translation.x(), poses[1].translation.x(), 1e-6);
}

TEST_F(SequenceValuesTest, ShibuyaPosesFindTheirImagesWithinAMillisecond) {
  WritePictures("image_0", "image_1", 3);
  folder_.Write("times.txt", "0\n0.1\n0.2\n");
  folder_.Write("calib.json", R"({"fx":50,"fy":48,"cx":20.5,"cy":14.25,"baseline_m":0.5})");
  folder_.Write("gt_pose.txt",
                "0 9 9 9 0 0 0 1\n0.001 1 2 3 0 0 0.6 0.8\n0.099 4 5 6 0 0 0 1\n"
                "0.201001 7 8 9 0 0 0 1\n");
  const auto sequence = OpenStereoSequence(folder_.path());
  ExpectSmallCamera(sequence->camera());
  const std::optional<Se3> first = sequence->ground_truth(0);
  ASSERT_TRUE(first);
  EXPECT_LT((first->translation - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  // Half the angle has the sine 0.6 and the cosine 0.8, so the angle has 0.96 and 0.28.
  EXPECT_LT((first->rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d(0.28, 0.96, 0)).norm(),
            1e-12);
  EXPECT_TRUE(sequence->ground_truth(1));
  EXPECT_FALSE(sequence->ground_truth(2));
  EXPECT_TRUE(Holds(NotesOf(*sequence), "gt_pose.txt: 2 of 3 images have a pose"));
}

// The camera looks 50 degrees up and travels along its own axis of view.
TEST(ContradictsNedValuesTest, TravelIsThatInBodyAxes) {
  const Eigen::Quaterniond R(Eigen::AngleAxisd(50 * M_PI / 180, Eigen::Vector3d::UnitY()));
  std::vector<Se3> poses;
  for (int i = 0; i < 5; ++i) {
    Se3 pose;
    pose.rotation = R;
    pose.translation = R * Eigen::Vector3d(0.5 * i, 0, 0);
    poses.push_back(pose);
  }
  EXPECT_FALSE(ContradictsNed(poses));
  for (int i = 0; i < 5; ++i)
    poses[static_cast<std::size_t>(i)].translation = R * Eigen::Vector3d(0.1 * i, 0, 0.31 * i);
  EXPECT_TRUE(ContradictsNed(poses));
  for (int i = 0; i < 5; ++i)
    poses[static_cast<std::size_t>(i)].translation = R * Eigen::Vector3d(0.1 * i, 0, 0.29 * i);
  EXPECT_FALSE(ContradictsNed(poses));
}

}  // namespace
}  // namespace airdos
