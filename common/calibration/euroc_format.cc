#include "common/calibration/calibration_yaml.h"
#include "common/calibration/camera_matrix.h"
#include "common/calibration/rig_formats.h"
#include "common/calibration/rigid_matrix.h"
#include "common/util/error.h"

namespace airdos {
namespace {

LensModel EurocLens(const CalibrationYaml& yaml) {
  const std::string model = yaml.Text("distortion_model");
  if (model == "radial-tangential" || model == "radtan") return LensModel::kRadialTangential;
  if (model == "equidistant") return LensModel::kFisheye;
  throw InputError(yaml.Where("distortion_model") + " with value '" + model +
                   "' is not supported: must be radial-tangential or equidistant");
}

/// The camera, and its pose in the body.
std::pair<CameraIntrinsics, Se3> ReadCamera(const CalibrationText& file) {
  const CalibrationYaml yaml = CalibrationYaml::Parse(file.text, file.path);
  const std::vector<double> size = yaml.Numbers("resolution", 2);
  const auto [width, height] = ToImageSize(size[0], size[1], yaml.Where("resolution"));
  const std::vector<double> k = yaml.Numbers("intrinsics", 4);
  const CameraIntrinsics camera = {width,
                                   height,
                                   k[0],
                                   k[1],
                                   k[2],
                                   k[3],
                                   EurocLens(yaml),
                                   yaml.Numbers("distortion_coefficients")};
  return {camera, ToSe3(yaml.Transform("T_BS"), yaml.Where("T_BS"))};
}

}  // namespace

bool IsEurocSensor(const CalibrationText& file) {
  return file.text.find("T_BS") != std::string::npos &&
         file.text.find("intrinsics") != std::string::npos;
}

StereoRig ReadEurocPair(const CalibrationText& left_file, const CalibrationText& right_file) {
  const auto [left, T_B_L] = ReadCamera(left_file);
  const auto [right, T_B_R] = ReadCamera(right_file);
  StereoRig rig;
  rig.format = "EuRoC sensor.yaml pair";
  rig.left = left;
  rig.right = right;
  rig.T_L_R = T_B_L.inverse() * T_B_R;
  return rig;
}

}  // namespace airdos
