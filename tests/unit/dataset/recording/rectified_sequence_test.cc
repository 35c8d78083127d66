// Recordings as data sets: rectified as they are loaded; the layout of EuRoC.
#include "common/dataset/recording/rectified_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/rendered_scene.h"
#include "tests/unit/dataset/recording/recording_fixture.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

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
  EXPECT_TRUE(frame.left_image_file.empty());
  EXPECT_EQ(cv::norm(frame.left_pixels, rectifier.Left(left), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(frame.right_pixels, rectifier.Right(right), cv::NORM_INF), 0);
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

  static std::string Row(std::int64_t after_first_ns, double distance_m) {
    return Format("%ld,1,%g,2,0.70710678,0,0,0.70710678,0,0,0,0,0,0,0,0,0\n",
                  static_cast<long>(kFirst_ns + after_first_ns), distance_m);
  }
  /// The camera looks along the body's x axis, which points along the world's y axis; there the
  /// body drives, 0.1 m an image.
  void WriteEuroc(int count) const {
    std::string csv = "#timestamp [ns],filename\n";
    std::string truth = "#timestamp, p_RS_R_x [m], ...\n";
    for (int i = 0; i < count; ++i) {
      WriteLeft("mav0/cam0/data/" + Name(i), i);
      WriteRight("mav0/cam1/data/" + Name(i), i);
      csv += Format("%ld,", static_cast<long>(kFirst_ns + 50000000L * i)) + Name(i) + "\r\n";
    }
    for (int i = 0; i < 3 * count;
         ++i) {  // between the images, now nearer to this one, now to that
      truth += Row(15000000L + 20000000L * i, 0.03 + 0.04 * i);
    }
    Write("mav0/cam0/data.csv", csv);
    Write("mav0/cam0/sensor.yaml", Sensor("0,0,1,0, -1,0,0,0, 0,-1,0,0, 0,0,0,1"));
    Write("mav0/cam1/sensor.yaml", Sensor("0,0,1,0, -1,0,0,-0.11, 0,-1,0,0, 0,0,0,1"));
    Write(kTruth, truth);
  }

  static constexpr char kTruth[] = "mav0/state_groundtruth_estimate0/data.csv";
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
  const auto second = sequence->ground_truth(2);
  const auto last = sequence->ground_truth(3);
  ASSERT_TRUE(first && second && last);
  EXPECT_LT(first->translation.norm(), 1e-9);
  EXPECT_LT((second->translation - Eigen::Vector3d(0, 0, 0.1)).norm(), 1e-6)
      << second->translation.transpose();
  EXPECT_LT((last->translation - Eigen::Vector3d(0, 0, 0.2)).norm(), 1e-6)
      << "forward is the camera's z axis: " << last->translation.transpose();
  EXPECT_TRUE(sequence->Load(2).ground_truth);
  EXPECT_TRUE(HasSequenceLayout(Path("mav0")));
  EXPECT_EQ(OpenStereoSequence(Path("mav0"))->num_frames(), 4u);
}

TEST_F(EurocTest, TheGroundTruthIsThatOfTheRectifiedCamera) {
  WriteEuroc(4);
  // The right camera stands 2 cm ahead of the left one, so that rectification turns both.
  Write("mav0/cam1/sensor.yaml", Sensor("0,0,1,0.02, -1,0,0,-0.11, 0,-1,0,0, 0,0,0,1"));
  const auto opened = OpenStereoSequence(folder_.string());
  const auto* const sequence = dynamic_cast<const RectifiedSequence*>(opened.get());
  ASSERT_NE(sequence, nullptr);
  const Eigen::Vector3d forward = sequence->rectifier().R_rect_left() * Eigen::Vector3d(0, 0, 1);
  EXPECT_GT(std::abs(forward.x()), 0.1);
  const auto last = sequence->ground_truth(3);
  ASSERT_TRUE(last);
  EXPECT_LT((last->translation - 0.2 * forward).norm(), 1e-6) << last->translation.transpose();
}

TEST_F(EurocTest, BetweenRowsThatAreFarApartThereIsNoGroundTruth) {
  WriteEuroc(3);
  Write(kTruth, Row(0, 0) + Row(60000000, 0.12) + Row(100000000, 0.2));
  const auto sequence = OpenStereoSequence(folder_.string());
  EXPECT_TRUE(sequence->ground_truth(0));
  EXPECT_FALSE(sequence->ground_truth(1));
  EXPECT_TRUE(sequence->ground_truth(2));
  const std::vector<std::string> notes = sequence->notes();
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return Holds(note, "2 of 3 images have a pose");
  }));
}

TEST_F(EurocTest, WithoutACalibrationItIsRefused) {
  WriteEuroc(3);
  fs::remove(Path("mav0/cam1/sensor.yaml"));
  EXPECT_TRUE(Holds(ErrorOf([&] { OpenStereoSequence(folder_.string()); }),
                    "cam1/sensor.yaml: is not there"));
}

TEST_F(EurocTest, DamagedGroundTruthNamesTheLine) {
  WriteEuroc(3);
  const auto refusal = [&](const std::string& line) {
    Write(kTruth, "#head\n" + line + "\n");
    return ErrorOf([&] { OpenStereoSequence(folder_.string()); });
  };
  EXPECT_TRUE(Holds(refusal("1403636579763555584,1,2,3"), "data.csv:2: must hold a time in ns"));
  EXPECT_TRUE(Holds(refusal("1403636579763555584,1,2,3,0.5,0,0,0"), "not of length 1"));
  EXPECT_TRUE(Holds(refusal("x,1,2,3,1,0,0,0"), "'x' is not a time in ns"));
}

}  // namespace
}  // namespace airdos
