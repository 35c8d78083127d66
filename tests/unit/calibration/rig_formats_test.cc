// One rig, written as each tool writes it, must come out as the same rig.
#include "common/calibration/rig_formats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <opencv2/calib3d.hpp>
#include <sstream>

#include "common/calibration/calibration_file.h"
#include "common/calibration/stereo_rectifier.h"
#include "common/util/error.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

/// A rig in which nothing equals anything: not fx and fy, nor left and right; the right camera is
/// turned and stands a little lower and behind.
StereoRig MakeRig(LensModel lens) {
  StereoRig rig;
  rig.left = {640, 480, 461.25, 458.5, 322.75, 236.125, lens, {-0.28, 0.07, 0.0002, 0.00175}};
  rig.right = {640, 480, 457.5, 456.125, 318.5, 243.25, lens, {-0.27, 0.065, -0.0003, 0.0011}};
  if (lens == LensModel::kFisheye) {
    rig.left.distortion = {-0.0137, 0.0207, -0.0128, 0.0025};
    rig.right.distortion = {-0.0085, 0.0114, -0.007, 0.0015};
  }
  rig.T_L_R.rotation = ExpSo3({0.011, -0.023, 0.007});
  rig.T_L_R.translation = {0.112, 0.0021, -0.0034};
  return rig;
}

template <class Derived>
std::string List(const Eigen::MatrixBase<Derived>& matrix) {
  std::ostringstream text;
  text.precision(17);
  for (int row = 0; row < matrix.rows(); ++row) {
    for (int col = 0; col < matrix.cols(); ++col)
      text << (row + col > 0 ? ", " : "") << matrix(row, col);
  }
  return "[" + text.str() + "]";
}

std::string List(const std::vector<double>& values) {
  return List(Eigen::Map<const Eigen::RowVectorXd>(values.data(),
                                                   static_cast<Eigen::Index>(values.size())));
}

Eigen::Matrix3d K(const CameraIntrinsics& camera) {
  Eigen::Matrix3d matrix;
  matrix << camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1;
  return matrix;
}

std::string LensName(const CameraIntrinsics& camera, const std::string& radial,
                     const std::string& fisheye) {
  return camera.lens == LensModel::kFisheye ? fisheye : radial;
}

/// Rows of a 4 x 4 matrix as Kalibr has them.
std::string Rows(const Eigen::Matrix4d& matrix) {
  std::string text;
  for (int row = 0; row < 4; ++row) text += "\n    - " + List(matrix.row(row).eval());
  return text + "\n";
}

std::string OpencvMatrix(const std::string& key, const std::string& list, int rows, int cols) {
  return key + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
         "\n   cols: " + std::to_string(cols) + "\n   dt: d\n   data:" + list + "\n";
}

/// What cv::stereoRectify makes of the rig: the rows of ROS and ORB-SLAM2 files.
struct Rectification {
  cv::Mat R1, R2, P1, P2;
};

Rectification Rectify(const StereoRig& rig) {
  const auto matx = [](const Eigen::Matrix3d& m) {
    return cv::Matx33d(m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1),
                       m(2, 2));
  };
  const Se3 T_R_L = rig.T_L_R.inverse();
  const cv::Vec3d t(T_R_L.translation.x(), T_R_L.translation.y(), T_R_L.translation.z());
  Rectification result;
  cv::Mat Q;
  cv::stereoRectify(matx(K(rig.left)), rig.left.distortion, matx(K(rig.right)),
                    rig.right.distortion, {640, 480}, matx(T_R_L.rotation.toRotationMatrix()), t,
                    result.R1, result.R2, result.P1, result.P2, Q, cv::CALIB_ZERO_DISPARITY, 0.3);
  return result;
}

std::string MatList(const cv::Mat& mat) {
  std::vector<double> values(mat.begin<double>(), mat.end<double>());
  return List(values);
}

class RigFormats : public testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    return folder_.Write(name, text);
  }
  StereoRig Read(const std::vector<std::string>& paths, const CalibrationOptions& options = {}) {
    return ReadStereoRig(paths, options);
  }

  std::string Kalibr(const StereoRig& rig, const std::string& poses_of_first,
                     const std::string& poses_of_second) {
    const auto camera = [](const std::string& name, const CameraIntrinsics& c,
                           const std::string& poses) {
      return name + ":\n" + poses +
             "  camera_model: pinhole\n  distortion_coeffs: " + List(c.distortion) +
             "\n  distortion_model: " + LensName(c, "radtan", "equidistant") +
             "\n  intrinsics: " + List(std::vector<double>{c.fx_px, c.fy_px, c.cx_px, c.cy_px}) +
             "\n  resolution: [640, 480]\n";
    };
    return "%YAML:1.0 # head\n\n" + camera("cam0", rig.left, poses_of_first) +
           camera("cam1", rig.right, poses_of_second);
  }
  std::string Ros(const CameraIntrinsics& c, const cv::Mat& R, const cv::Mat& P) {
    const auto matrix = [](const std::string& key, const std::string& list, int rows, int cols) {
      return key + ":\n  rows: " + std::to_string(rows) + "\n  cols: " + std::to_string(cols) +
             "\n  data: " + list + "\n";
    };
    return "image_width: 640\nimage_height: 480\ncamera_name: x\n" +
           matrix("camera_matrix", List(K(c)), 3, 3) + "distortion_model: plumb_bob\n" +
           matrix("distortion_coefficients", List(c.distortion), 1,
                  static_cast<int>(c.distortion.size())) +
           matrix("rectification_matrix", MatList(R), 3, 3) +
           matrix("projection_matrix", MatList(P), 3, 4);
  }

 private:
  ScratchFolder folder_{"rig_formats"};
};

/// Largest distance in px between where two rigs' rectifications put the pixels of both images.
double LargestDifference(const StereoRig& a, const StereoRig& b) {
  const StereoRectifier first(a);
  const StereoRectifier second(b);
  double largest =
      std::abs(first.camera().fx_px - second.camera().fx_px) +
      std::abs(first.camera().baseline_m - second.camera().baseline_m) * first.camera().fx_px;
  for (int u = 10; u < 640; u += 62) {
    for (int v = 10; v < 480; v += 46) {
      const Eigen::Vector2d uv(u, v);
      largest = std::max({largest, (first.RectifyLeft(uv) - second.RectifyLeft(uv)).norm(),
                          (first.RectifyRight(uv) - second.RectifyRight(uv)).norm()});
    }
  }
  return largest;
}

/// The whole of a rig, number by number.
void ExpectSame(const StereoRig& rig, const StereoRig& expected) {
  for (const auto& [actual, wanted] :
       {std::make_pair(&rig.left, &expected.left), {&rig.right, &expected.right}}) {
    EXPECT_EQ(actual->width, wanted->width);
    EXPECT_EQ(actual->height, wanted->height);
    EXPECT_DOUBLE_EQ(actual->fx_px, wanted->fx_px);
    EXPECT_DOUBLE_EQ(actual->fy_px, wanted->fy_px);
    EXPECT_DOUBLE_EQ(actual->cx_px, wanted->cx_px);
    EXPECT_DOUBLE_EQ(actual->cy_px, wanted->cy_px);
    EXPECT_EQ(actual->lens, wanted->lens);
    for (std::size_t i = 0; i < wanted->distortion.size(); ++i)
      EXPECT_EQ(actual->distortion.at(i), wanted->distortion[i]);
    for (std::size_t i = wanted->distortion.size(); i < actual->distortion.size(); ++i)
      EXPECT_EQ(actual->distortion[i], 0);
  }
  EXPECT_LT(Boxminus(rig.T_L_R, expected.T_L_R).norm(), 1e-9);
  EXPECT_FALSE(rig.are_images_rectified);
  EXPECT_LT(LargestDifference(rig, expected), 0.02);
}

const Se3 kPoseInImu = [] {
  Se3 T_I_L;
  T_I_L.rotation = ExpSo3({1.2, -0.7, 0.4});
  T_I_L.translation = {0.05, -0.02, 0.3};
  return T_I_L;
}();

TEST_F(RigFormats, Kalibr) {
  for (const LensModel lens : {LensModel::kRadialTangential, LensModel::kFisheye}) {
    const StereoRig rig = MakeRig(lens);
    const std::string chain = "  T_cn_cnm1:" + Rows(rig.T_L_R.inverse().matrix());
    const StereoRig by_chain = Read({Write("chain.yaml", Kalibr(rig, "", chain))});
    ExpectSame(by_chain, rig);
    EXPECT_EQ(by_chain.format, "Kalibr camera chain");
    const Se3 T_I_R = kPoseInImu * rig.T_L_R;
    ExpectSame(Read({Write("imu.yaml", Kalibr(rig, "  T_imu_cam:" + Rows(kPoseInImu.matrix()),
                                              "  T_imu_cam:" + Rows(T_I_R.matrix())))}),
               rig);
    const std::string first = "  T_cam_imu:" + Rows(kPoseInImu.inverse().matrix());
    const std::string second = "  T_cam_imu:" + Rows(T_I_R.inverse().matrix());
    ExpectSame(Read({Write("cam_imu.yaml", Kalibr(rig, first, second))}), rig);
    const StereoRig both = Read({Write("both.yaml", Kalibr(rig, first, second + chain))});
    ExpectSame(both, rig);
    EXPECT_TRUE(both.notes.empty());
  }
}

TEST_F(RigFormats, KalibrsTwoWaysToThePoseThatDisagreeAreSaid) {
  const StereoRig rig = MakeRig(LensModel::kRadialTangential);
  Se3 T_I_R = kPoseInImu * rig.T_L_R;
  T_I_R.translation.x() += 0.002;
  const std::string text = Kalibr(
      rig, "  T_imu_cam:" + Rows(kPoseInImu.matrix()),
      "  T_imu_cam:" + Rows(T_I_R.matrix()) + "  T_cn_cnm1:" + Rows(rig.T_L_R.inverse().matrix()));
  const StereoRig read = Read({Write("k.yaml", text)});
  ExpectSame(read, rig);
  ASSERT_EQ(read.notes.size(), 1u);
  EXPECT_NE(read.notes[0].find("T_cn_cnm1 is used"), std::string::npos);
}

TEST_F(RigFormats, RosPair) {
  const StereoRig rig = MakeRig(LensModel::kRadialTangential);
  const Rectification r = Rectify(rig);
  const StereoRig read = Read({Write("left.yaml", Ros(rig.left, r.R1, r.P1)),
                               Write("right.yaml", Ros(rig.right, r.R2, r.P2))});
  ExpectSame(read, rig);
  ASSERT_TRUE(read.rectified);
  EXPECT_NEAR(read.rectified->fx_px, r.P1.at<double>(0, 0), 1e-9);
  EXPECT_NEAR(read.rectified->cy_px, r.P1.at<double>(1, 2), 1e-9);
  EXPECT_NEAR(read.rectified->baseline_m, rig.T_L_R.translation.norm(), 1e-9);
}

TEST_F(RigFormats, RosMessagesAsTheyArePrinted) {
  const StereoRig rig = MakeRig(LensModel::kFisheye);
  const Rectification r = Rectify(MakeRig(LensModel::kRadialTangential));
  const auto message = [](const CameraIntrinsics& c, const cv::Mat& R, const cv::Mat& P,
                          bool is_ros2) {
    std::string text =
        "header:\n  seq: 7\nheight: 480\nwidth: 640\ndistortion_model: equidistant\n";
    for (const auto& [key, list] : {std::make_pair("D", List(c.distortion)),
                                    {"K", List(K(c))},
                                    {"R", MatList(R)},
                                    {"P", MatList(P)}}) {
      text += std::string(1, static_cast<char>(is_ros2 ? std::tolower(key[0]) : key[0])) + ": " +
              list + "\n";
    }
    return text + "binning_x: 0\n---\n";
  };
  for (const bool is_ros2 : {false, true}) {
    ExpectSame(Read({Write("left.yaml", message(rig.left, r.R1, r.P1, is_ros2)),
                     Write("right.yaml", message(rig.right, r.R2, r.P2, is_ros2))}),
               rig);
  }
}

TEST_F(RigFormats, OpencvInOneFileAndInTwo) {
  const StereoRig rig = MakeRig(LensModel::kRadialTangential);
  const Se3 T_R_L = rig.T_L_R.inverse();
  const std::string intrinsics = OpencvMatrix("M1", List(K(rig.left)), 3, 3) +
                                 OpencvMatrix("D1", List(rig.left.distortion), 1, 4) +
                                 OpencvMatrix("M2", List(K(rig.right)), 3, 3) +
                                 OpencvMatrix("D2", List(rig.right.distortion), 1, 4);
  const std::string extrinsics = OpencvMatrix("R", List(T_R_L.rotation.toRotationMatrix()), 3, 3) +
                                 OpencvMatrix("T", List((1000 * T_R_L.translation).eval()), 3, 1);
  CalibrationOptions options;
  options.format.image_size = {640, 480};
  const StereoRig two = Read({Write("i.yml", "%YAML:1.0\n---\n" + intrinsics),
                              Write("e.yml", "%YAML:1.0\n---\n" + extrinsics)},
                             options);
  ExpectSame(two, rig);
  ASSERT_EQ(two.notes.size(), 2u);  // four coefficients, and mm
  EXPECT_NE(two.notes[1].find("mm"), std::string::npos);
  ExpectSame(Read({Write("one.yml", "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n" +
                                        intrinsics + extrinsics)}),
             rig);
  EXPECT_THROW(Read({Write("no_size.yml", intrinsics + extrinsics)}), InputError);
}

TEST_F(RigFormats, EurocPair) {
  for (const LensModel lens : {LensModel::kRadialTangential, LensModel::kFisheye}) {
    const StereoRig rig = MakeRig(lens);
    const auto sensor = [](const CameraIntrinsics& c, const Se3& T_B_C) {
      return "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: " + List(T_B_C.matrix()) +
             "\nrate_hz: 20\nresolution: [640, 480]\ncamera_model: pinhole\nintrinsics: " +
             List(std::vector<double>{c.fx_px, c.fy_px, c.cx_px, c.cy_px}) +
             "\ndistortion_model: " + LensName(c, "radial-tangential", "equidistant") +
             "\ndistortion_coefficients: " + List(c.distortion) + "\n";
    };
    ExpectSame(Read({Write("l.yaml", sensor(rig.left, kPoseInImu)),
                     Write("r.yaml", sensor(rig.right, kPoseInImu * rig.T_L_R))}),
               rig);
  }
}

TEST_F(RigFormats, OrbSlam3) {
  for (const LensModel lens : {LensModel::kRadialTangential, LensModel::kFisheye}) {
    const StereoRig rig = MakeRig(lens);
    const auto camera = [&](const std::string& name, const CameraIntrinsics& c) {
      std::ostringstream text;
      text.precision(17);
      text << name << ".fx: " << c.fx_px << "\n"
           << name << ".fy: " << c.fy_px << "\n"
           << name << ".cx: " << c.cx_px << "\n"
           << name << ".cy: " << c.cy_px << "\n";
      const char* radial[] = {"k1", "k2", "p1", "p2"};
      const char* fisheye[] = {"k1", "k2", "k3", "k4"};
      for (std::size_t i = 0; i < 4; ++i) {
        text << name << "." << (lens == LensModel::kFisheye ? fisheye : radial)[i] << ": "
             << c.distortion[i] << "\n";
      }
      return text.str();
    };
    const std::string text =
        "%YAML:1.0\nFile.version: \"1.0\"\nCamera.type: \"" +
        std::string(lens == LensModel::kFisheye ? "KannalaBrandt8" : "PinHole") + "\"\n" +
        camera("Camera1", rig.left) + camera("Camera2", rig.right) +
        "Camera.width: 640\nCamera.height: 480\n" +
        OpencvMatrix("Stereo.T_c1_c2", List(rig.T_L_R.matrix()), 4, 4);
    ExpectSame(Read({Write("orb.yaml", text)}), rig);
  }
}

TEST_F(RigFormats, OrbSlam2ToBeRectifiedAndRectified) {
  const StereoRig rig = MakeRig(LensModel::kRadialTangential);
  const Rectification r = Rectify(rig);
  const std::string head =
      "%YAML:1.0\nCamera.fx: 500.0\nCamera.fy: 501.0\nCamera.cx: 320.5\nCamera.cy: "
      "239.5\nCamera.bf: 55.0\n"
      "Camera.width: 640\nCamera.height: 480\nViewer.PointSize:2\n";
  const auto side = [](const std::string& name, const CameraIntrinsics& c, const cv::Mat& R,
                       const cv::Mat& P) {
    return name + ".height: 480\n" + name + ".width: 640\n" +
           OpencvMatrix(name + ".D", List(c.distortion), 1, 4) +
           OpencvMatrix(name + ".K", List(K(c)), 3, 3) +
           OpencvMatrix(name + ".R", MatList(R), 3, 3) +
           OpencvMatrix(name + ".P", MatList(P), 3, 4);
  };
  ExpectSame(Read({Write("orb.yaml", head + side("LEFT", rig.left, r.R1, r.P1) +
                                         side("RIGHT", rig.right, r.R2, r.P2))}),
             rig);

  const StereoRig rectified = Read({Write("rectified.yaml", head)});
  EXPECT_TRUE(rectified.are_images_rectified);
  const StereoCamera expected = {640, 480, 500, 501, 320.5, 239.5, 0.11};
  EXPECT_NEAR(rectified.rectified->baseline_m, 0.11, 1e-12);
  EXPECT_EQ(rectified.rectified->fy_px, expected.fy_px);
  EXPECT_EQ(rectified.rectified->cx_px, expected.cx_px);
}

TEST_F(RigFormats, KittiRaw) {
  const StereoRig rig = MakeRig(LensModel::kRadialTangential);
  const Rectification r = Rectify(rig);
  // p_i = R_i p_0 + T_i, where camera 0 is neither of the two.
  const auto numbers = [](const std::string& list) {
    std::string text = list.substr(1, list.size() - 2);
    text.erase(std::remove(text.begin(), text.end(), ','), text.end());
    return text;
  };
  const auto camera = [&](const std::string& i, const CameraIntrinsics& c, const Se3& T_i_0,
                          const cv::Mat& R, const cv::Mat& P) {
    std::vector<double> distortion = c.distortion;
    distortion.push_back(0);
    return "S_" + i + ": 640 480\nK_" + i + ": " + numbers(List(K(c))) + "\nD_" + i + ": " +
           numbers(List(distortion)) + "\nR_" + i + ": " +
           numbers(List(T_i_0.rotation.toRotationMatrix())) + "\nT_" + i + ": " +
           numbers(List(T_i_0.translation)) + "\nS_rect_" + i + ": 600 440\nR_rect_" + i + ": " +
           numbers(MatList(R)) + "\nP_rect_" + i + ": " + numbers(MatList(P)) + "\n";
  };
  const Se3 T_2_0 = kPoseInImu.inverse();
  const Se3 T_3_0 = (kPoseInImu * rig.T_L_R).inverse();
  const std::string path = Write("calib_cam_to_cam.txt",
                                 "calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.950000e-02\n" +
                                     camera("02", rig.left, T_2_0, r.R1, r.P1) +
                                     camera("03", rig.right, T_3_0, r.R2, r.P2));
  CalibrationOptions options;
  options.format.kitti_cameras = {2, 3};
  options.format.image_size = {640, 480};
  ExpectSame(Read({path}, options), rig);
  options.format.image_size = {600, 440};
  const StereoRig rectified = Read({path}, options);
  EXPECT_TRUE(rectified.are_images_rectified);
  EXPECT_NEAR(rectified.rectified->fx_px, r.P1.at<double>(0, 0), 1e-9);
  EXPECT_EQ(rectified.rectified->width, 600);
  EXPECT_NEAR(rectified.rectified->baseline_m, rig.T_L_R.translation.norm(), 1e-9);
}

TEST_F(RigFormats, Zed) {
  StereoRig rig = MakeRig(LensModel::kRadialTangential);
  std::ostringstream text;
  text.precision(17);
  const auto camera = [&text](const std::string& name, const CameraIntrinsics& c, double factor) {
    text << "[" << name << "]\r\nfx=" << c.fx_px * factor << "\r\nfy=" << c.fy_px * factor
         << "\r\ncx=" << c.cx_px * factor << "\r\ncy=" << c.cy_px * factor
         << "\r\nk1=" << c.distortion[0] << "\r\nk2=" << c.distortion[1]
         << " \r\np1=" << c.distortion[2] << "\r\np2=" << c.distortion[3] << "\r\n\r\n";
  };
  camera("LEFT_CAM_VGA", rig.left, 1);
  camera("RIGHT_CAM_VGA", rig.right, 1);
  camera("LEFT_CAM_HD", rig.left, 2);
  camera("RIGHT_CAM_HD", rig.right, 2);
  const Se3 T_R_L = rig.T_L_R.inverse();
  const Eigen::Vector3d rotation = LogSo3(T_R_L.rotation);
  const Eigen::Vector3d t_mm = -1000 * T_R_L.translation;
  text << "[STEREO]\r\nBaseline=" << t_mm.x() << "\r\nTY=" << t_mm.y() << "\r\nTZ=" << t_mm.z()
       << "\r\nCV_VGA=" << rotation.y() << "\r\nRX_VGA=" << rotation.x()
       << "\r\nRZ_VGA=" << rotation.z() << "\r\nCV_HD=0\r\nRX_HD=0\r\nRZ_HD=0\r\n";
  const std::string path = Write("SN1.conf", text.str());
  CalibrationOptions options;
  options.format.image_size = {672, 376};
  const StereoRig read = Read({path}, options);
  rig.left.width = rig.right.width = 672;
  rig.left.height = rig.right.height = 376;
  ExpectSame(read, rig);
  options.format.image_size = {1280, 720};
  EXPECT_DOUBLE_EQ(Read({path}, options).left.fx_px, 2 * rig.left.fx_px);
  for (const auto& size : {std::make_pair(0, 0), {640, 480}}) {
    options.format.image_size = size;
    EXPECT_THROW(Read({path}, options), InputError);
  }
}

}  // namespace
}  // namespace airdos
