#include <cmath>

#include "common/calibration/calibration_yaml.h"
#include "common/calibration/rig_formats.h"
#include "common/calibration/rigid_matrix.h"
#include "common/util/error.h"

namespace airdos {
namespace {

struct RosCamera {
  CameraIntrinsics intrinsics;
  Eigen::Matrix3d R;  // p_rect = R * p_camera
  std::vector<double> P;
};

LensModel RosLens(const CalibrationYaml& yaml) {
  const std::string model = yaml.Text("distortion_model");
  if (model == "plumb_bob" || model == "rational_polynomial") return LensModel::kRadialTangential;
  if (model == "equidistant" || model == "fisheye") return LensModel::kFisheye;
  throw InputError(yaml.Where("distortion_model") + " with value '" + model +
                   "' is not supported: must be plumb_bob, rational_polynomial or equidistant");
}

RosCamera ReadCamera(const CalibrationText& file) {
  const CalibrationYaml yaml = CalibrationYaml::Parse(file.text, file.path);
  RosCamera camera;
  const Eigen::Matrix3d K = yaml.Matrix3("camera_matrix");
  camera.intrinsics = {yaml.Whole("image_width"),
                       yaml.Whole("image_height"),
                       K(0, 0),
                       K(1, 1),
                       K(0, 2),
                       K(1, 2),
                       RosLens(yaml),
                       yaml.Numbers("distortion_coefficients")};
  camera.R = ToRotation(yaml.Matrix3("rectification_matrix"), yaml.Where("rectification_matrix"));
  camera.P = yaml.Numbers("projection_matrix", 12);
  if (!(camera.P[0] > 0)) {
    throw InputError(yaml.Where("projection_matrix") +
                     ": the first number (focal length, px) must be above 0");
  }
  return camera;
}

}  // namespace

bool IsRosCameraInfo(const CalibrationText& file) {
  return file.text.find("projection_matrix") != std::string::npos &&
         file.text.find("rectification_matrix") != std::string::npos;
}

StereoRig ReadRosPair(const CalibrationText& left_file, const CalibrationText& right_file) {
  const RosCamera left = ReadCamera(left_file);
  const RosCamera right = ReadCamera(right_file);
  const double baseline_m = (left.P[3] - right.P[3]) / left.P[0];
  if (baseline_m == 0) {
    throw InputError(
        right_file.path +
        ": key 'projection_matrix': its fourth number (-fx * baseline) is 0 in both files: "
        "calibrated one by one, not as a stereo pair");
  }
  StereoRig rig;
  rig.format = "ROS camera_info pair";
  rig.left = left.intrinsics;
  rig.right = right.intrinsics;
  rig.T_L_R = RelativePose(left.R, right.R, baseline_m);
  rig.rectified = StereoCamera{rig.left.width, rig.left.height, left.P[0], left.P[5],
                               left.P[2],      left.P[6],       baseline_m};
  return rig;
}

}  // namespace airdos
