// The same rig in every format that is read gives the same rectified images.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/calibration/calibration_file.h"
#include "common/calibration/rig_writer.h"
#include "common/calibration/stereo_rectifier.h"
#include "common/util/format.h"
#include "tests/support/rendered_scene.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

constexpr int kWidth = 672;  // a resolution of ZED
constexpr int kHeight = 376;
constexpr double kSame_px = 0.02;

StereoRig MakeRig() {
  StereoRig rig;
  rig.left = {kWidth,
              kHeight,
              351.25,
              349.5,
              341.75,
              184.125,
              LensModel::kRadialTangential,
              {-0.17, 0.026, 0.0002, 0.00175}};
  rig.right = {kWidth,
               kHeight,
               348.5,
               347.125,
               329.5,
               192.25,
               LensModel::kRadialTangential,
               {-0.165, 0.024, -0.0003, 0.0011}};
  rig.T_L_R.rotation = ExpSo3({0.011, -0.023, 0.007});
  rig.T_L_R.translation = {0.119, 0.0021, -0.0034};
  return rig;
}

template <class Numbers>
std::string Listed(const Numbers& numbers, const std::string& between) {
  std::string text;
  for (const double number : numbers)
    text += (text.empty() ? "" : between) + Format("%.17g", number);
  return text;
}

std::vector<double> RowByRow(const Eigen::MatrixXd& matrix) {
  std::vector<double> numbers;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index col = 0; col < matrix.cols(); ++col) numbers.push_back(matrix(row, col));
  }
  return numbers;
}

Eigen::Matrix3d CameraMatrix(const CameraIntrinsics& c) {
  Eigen::Matrix3d K;
  K << c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1;
  return K;
}

Eigen::MatrixXd Projection(const StereoCamera& c, double baseline_m) {
  Eigen::MatrixXd P(3, 4);
  P << c.fx_px, 0, c.cx_px, -c.fx_px * baseline_m, 0, c.fy_px, c.cy_px, 0, 0, 0, 1, 0;
  return P;
}

/// A rig in the formats that nobody else writes.
std::string OrbSlam2(const StereoRig& rig) {
  const StereoRectifier r(rig);
  const auto side = [](const std::string& name, const CameraIntrinsics& c, const Eigen::Matrix3d& R,
                       const Eigen::MatrixXd& P) {
    const auto matrix = [&name](const std::string& key, const Eigen::MatrixXd& m) {
      return name + "." + key + ": !!opencv-matrix\n   rows: " + std::to_string(m.rows()) +
             "\n   cols: " + std::to_string(m.cols()) + "\n   dt: d\n   data:[" +
             Listed(RowByRow(m), ", ") + "]\n";
    };
    const Eigen::RowVectorXd D = Eigen::Map<const Eigen::RowVectorXd>(
        c.distortion.data(), static_cast<Eigen::Index>(c.distortion.size()));
    return name + ".height: " + std::to_string(c.height) + "\n" + name +
           ".width: " + std::to_string(c.width) + "\n" + matrix("D", D) +
           matrix("K", CameraMatrix(c)) + matrix("R", R) + matrix("P", P);
  };
  return "%YAML:1.0\nCamera.fx: 435.2\nCamera.bf: 47.9\n" +
         side("LEFT", rig.left, r.R_rect_left(), Projection(r.camera(), 0)) +
         side("RIGHT", rig.right, r.R_rect_right(), Projection(r.camera(), r.camera().baseline_m));
}

std::string KittiRaw(const StereoRig& rig) {
  const StereoRectifier r(rig);
  const auto camera = [](const std::string& i, const CameraIntrinsics& c, const Se3& T_i_0,
                         const Eigen::MatrixXd& P) {
    const std::string size = std::to_string(c.width) + " " + std::to_string(c.height);
    return "S_" + i + ": " + size + "\nK_" + i + ": " + Listed(RowByRow(CameraMatrix(c)), " ") +
           "\nD_" + i + ": " + Listed(c.distortion, " ") + " 0\nR_" + i + ": " +
           Listed(RowByRow(T_i_0.rotation.toRotationMatrix()), " ") + "\nT_" + i + ": " +
           Listed(RowByRow(T_i_0.translation), " ") + "\nS_rect_" + i + ": 640 360\nP_rect_" + i +
           ": " + Listed(RowByRow(P), " ") + "\n";
  };
  return "calib_time: 09-Jan-2012 13:57:47\n" +
         camera("00", rig.left, Se3(), Projection(r.camera(), 0)) +
         camera("01", rig.right, rig.T_L_R.inverse(),
                Projection(r.camera(), r.camera().baseline_m));
}

std::string Zed(const StereoRig& rig) {
  const auto camera = [](const CameraIntrinsics& c) {
    return Format(
        "fx=%.17g\nfy=%.17g\ncx=%.17g\ncy=%.17g\nk1=%.17g\nk2=%.17g\np1=%.17g\np2=%.17g\n", c.fx_px,
        c.fy_px, c.cx_px, c.cy_px, c.distortion[0], c.distortion[1], c.distortion[2],
        c.distortion[3]);
  };
  const Se3 T_R_L = rig.T_L_R.inverse();
  const Eigen::Vector3d r = LogSo3(T_R_L.rotation);
  const Eigen::Vector3d t_mm = -1000 * T_R_L.translation;
  return "[LEFT_CAM_VGA]\n" + camera(rig.left) + "[RIGHT_CAM_VGA]\n" + camera(rig.right) +
         Format(
             "[STEREO]\nBaseline=%.17g\nTY=%.17g\nTZ=%.17g\nRX_VGA=%.17g\nCV_VGA=%.17g\n"
             "RZ_VGA=%.17g\n",
             t_mm.x(), t_mm.y(), t_mm.z(), r.x(), r.y(), r.z());
}

/// Largest distance between where two rectifications put the same pixel.
double LargestDifference_px(const StereoRectifier& a, const StereoRectifier& b) {
  double largest = 0;
  for (int u = 5; u < kWidth; u += 37) {
    for (int v = 5; v < kHeight; v += 29) {
      const Eigen::Vector2d uv(u, v);
      largest = std::max({largest, (a.RectifyLeft(uv) - b.RectifyLeft(uv)).norm(),
                          (a.RectifyRight(uv) - b.RectifyRight(uv)).norm()});
    }
  }
  return largest;
}

/// Maps are rounded to 1/32 px, so that a hair's breadth may turn single pixels.
void ExpectSameImages(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat difference;
  cv::absdiff(a, b, difference);
  EXPECT_LE(cv::norm(difference, cv::NORM_INF), 3);
  EXPECT_LT(cv::countNonZero(difference), kWidth * kHeight / 1000);
}

void ExpectSame(const StereoRig& read, const StereoRig& rig) {
  ASSERT_FALSE(read.are_images_rectified);
  const StereoRectifier actual(read);
  const StereoRectifier expected(rig);
  EXPECT_LT(LargestDifference_px(actual, expected), kSame_px);
  EXPECT_NEAR(actual.camera().baseline_m, expected.camera().baseline_m, 1e-9);
  EXPECT_NEAR(actual.camera().fx_px, expected.camera().fx_px, 1e-6);
  const cv::Mat left = NoisePicture(kWidth, kHeight, 1);
  const cv::Mat right = NoisePicture(kWidth, kHeight, 2);
  ExpectSameImages(actual.Left(left), expected.Left(left));
  ExpectSameImages(actual.Right(right), expected.Right(right));
}

TEST(SameImages, InEveryFormat) {
  const ScratchFolder folder("same_images");
  const StereoRig rig = MakeRig();
  CalibrationOptions options;
  options.format.image_size = {kWidth, kHeight};
  std::vector<std::vector<std::string>> calibrations = {
      {folder.Write("orbslam2.yaml", OrbSlam2(rig))},
      {folder.Write("calib_cam_to_cam.txt", KittiRaw(rig))},
      {folder.Write("SN1.conf", Zed(rig))}};
  for (const std::string& format : WrittenFormats()) {
    if (format == "calib.json") continue;  // of rectified images: see below
    std::vector<std::string> paths;
    for (const NamedText& file : WriteRig(rig, StereoRectifier(rig), format))
      paths.push_back(folder.Write(format + "/" + file.name, file.text));
    calibrations.push_back(paths);
  }
  std::vector<std::string> formats;
  for (const std::vector<std::string>& paths : calibrations) {
    SCOPED_TRACE(paths[0]);
    const StereoRig read = ReadStereoRig(paths, options);
    EXPECT_EQ(read.files, paths);
    ExpectSame(read, rig);
    formats.push_back(read.format);
  }
  EXPECT_EQ(calibrations.size(), CalibrationFormats().size());  // ORB-SLAM's in two forms
}

// Rectified images and calib.json are the same pair as unrectified images and the rig.
TEST(SameImages, InCalibJson) {
  const ScratchFolder folder("same_images_json");
  const StereoRectifier rectifier(MakeRig());
  const NamedText file = WriteRig(MakeRig(), rectifier, "calib.json").front();
  const StereoRig read = ReadStereoRig({folder.Write(file.name, file.text)}, {});
  const StereoRectifier none(read);
  EXPECT_TRUE(none.camera() == rectifier.camera());
  const cv::Mat rectified = rectifier.Left(NoisePicture(kWidth, kHeight, 1));
  EXPECT_EQ(none.Left(rectified).data, rectified.data);
}

}  // namespace
}  // namespace airdos
