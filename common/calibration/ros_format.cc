#include <algorithm>
#include <tuple>

#include "common/calibration/calibration_yaml.h"
#include "common/calibration/camera_matrix.h"
#include "common/calibration/rig_formats.h"
#include "common/calibration/rigid_matrix.h"
#include "common/util/error.h"

namespace airdos {
namespace {

struct RosCamera {
  CameraIntrinsics intrinsics;
  Eigen::Matrix3d R;  // p_rect = R * p_camera
  ProjectionMatrix P;
};

/// The one of the names that is there; otherwise the first. A file of camera_calibration_parsers
/// has long names, a message as ROS 1 and ROS 2 print it short ones.
std::string KeyOf(const CalibrationYaml& yaml, const std::vector<std::string>& names) {
  const auto name =
      std::find_if(names.begin(), names.end(), [&](const auto& key) { return yaml.Has(key); });
  return name == names.end() ? names.front() : *name;
}

LensModel RosLens(const CalibrationYaml& yaml) {
  const std::string model = yaml.Text("distortion_model");
  if (model == "plumb_bob" || model == "rational_polynomial") return LensModel::kRadialTangential;
  if (model == "equidistant" || model == "fisheye") return LensModel::kFisheye;
  throw InputError(yaml.Where("distortion_model") + " with value '" + model +
                   "' is not supported: must be plumb_bob, rational_polynomial or equidistant");
}

RosCamera ReadCamera(const CalibrationText& file) {
  const CalibrationYaml yaml = CalibrationYaml::Parse(file.text, file.path);
  const std::string K = KeyOf(yaml, {"camera_matrix", "K", "k"});
  const std::string D = KeyOf(yaml, {"distortion_coefficients", "D", "d"});
  const std::string R = KeyOf(yaml, {"rectification_matrix", "R", "r"});
  const std::string P = KeyOf(yaml, {"projection_matrix", "P", "p"});
  const std::string width = KeyOf(yaml, {"image_width", "width"});
  const std::string height = KeyOf(yaml, {"image_height", "height"});
  RosCamera camera;
  camera.intrinsics = ToIntrinsics(yaml.Matrix3(K), yaml.Where(K));
  std::tie(camera.intrinsics.width, camera.intrinsics.height) =
      ToImageSize(yaml.Number(width), yaml.Number(height), yaml.Where(width));
  camera.intrinsics.lens = RosLens(yaml);
  camera.intrinsics.distortion = yaml.Numbers(D);
  camera.R = ToRotation(yaml.Matrix3(R), yaml.Where(R));
  camera.P = ToProjection(yaml.Numbers(P), yaml.Where(P));
  return camera;
}

bool HasLineOf(const std::string& text, const std::string& key) {
  return text.rfind(key + ":", 0) == 0 || text.find("\n" + key + ":") != std::string::npos;
}

}  // namespace

bool IsRosCameraInfo(const CalibrationText& file) {
  const auto has_all = [&file](const std::vector<std::string>& keys) {
    return std::all_of(keys.begin(), keys.end(),
                       [&](const std::string& key) { return HasLineOf(file.text, key); });
  };
  return has_all({"projection_matrix", "rectification_matrix"}) ||
         has_all({"distortion_model", "K", "R", "P"}) ||
         has_all({"distortion_model", "k", "r", "p"});
}

StereoRig ReadRosPair(const CalibrationText& left_file, const CalibrationText& right_file) {
  const RosCamera left = ReadCamera(left_file);
  const RosCamera right = ReadCamera(right_file);
  const double baseline_m = BaselineOf(left.P, right.P);
  if (baseline_m == 0) {
    throw InputError(
        right_file.path +
        ": the projection matrix's fourth number (-fx * baseline) is the same in both files: they "
        "were calibrated one by one, not as a stereo pair");
  }
  StereoRig rig;
  rig.format = "ROS camera_info pair";
  rig.left = left.intrinsics;
  rig.right = right.intrinsics;
  rig.T_L_R = RelativePose(left.R, right.R, baseline_m);
  rig.rectified = RectifiedPair(left.P, right.P, {rig.left.width, rig.left.height});
  return rig;
}

}  // namespace airdos
