#include <tuple>

#include "common/calibration/calibration_yaml.h"
#include "common/calibration/camera_matrix.h"
#include "common/calibration/rig_formats.h"
#include "common/calibration/rigid_matrix.h"
#include "common/util/error.h"

namespace airdos {
namespace {

LensModel KalibrLens(const CalibrationYaml& camera) {
  const std::string model = camera.Text("distortion_model");
  if (model == "radtan" || model == "plumb_bob") return LensModel::kRadialTangential;
  if (model == "equidistant" || model == "equi") return LensModel::kFisheye;
  if (model == "none") return LensModel::kNone;
  throw InputError(camera.Where("distortion_model") + " with value '" + model +
                   "' is not supported: must be radtan, equidistant or none");
}

CameraIntrinsics KalibrCamera(const CalibrationYaml& camera) {
  if (camera.Has("camera_model") && camera.Text("camera_model") != "pinhole") {
    throw InputError(
        camera.Where("camera_model") + " with value '" + camera.Text("camera_model") +
        "' is not supported: must be pinhole (calibrate with pinhole-radtan or pinhole-equi)");
  }
  CameraIntrinsics intrinsics;
  const std::vector<double> k = camera.Numbers("intrinsics", 4);
  intrinsics.fx_px = k[0];
  intrinsics.fy_px = k[1];
  intrinsics.cx_px = k[2];
  intrinsics.cy_px = k[3];
  intrinsics.lens = KalibrLens(camera);
  if (intrinsics.lens != LensModel::kNone) {
    intrinsics.distortion = camera.Numbers("distortion_coeffs", 4);
  }
  const std::vector<double> size = camera.Numbers("resolution", 2);
  std::tie(intrinsics.width, intrinsics.height) =
      ToImageSize(size[0], size[1], camera.Where("resolution"));
  return intrinsics;
}

/// Pose of the camera in the IMU, where the file has it.
std::optional<Se3> PoseInImu(const CalibrationYaml& camera) {
  if (camera.Has("T_imu_cam")) {
    return ToSe3(camera.Transform("T_imu_cam"), camera.Where("T_imu_cam"));
  }
  if (camera.Has("T_cam_imu")) {
    return ToSe3(camera.Transform("T_cam_imu"), camera.Where("T_cam_imu")).inverse();
  }
  return std::nullopt;
}

/// Says where the two ways to the relative pose do not lead to the same.
void CompareWithImu(const Se3& T_L_R, const Se3& T_L_R_by_imu, StereoRig* rig) {
  const Vector6d difference = Boxminus(T_L_R_by_imu, T_L_R);
  constexpr double kMaxDifference_m = 1e-3;
  constexpr double kMaxDifference_rad = 2e-3;
  if (difference.head<3>().norm() > kMaxDifference_m ||
      difference.tail<3>().norm() > kMaxDifference_rad) {
    rig->notes.push_back("T_cn_cnm1 and the poses in the IMU differ; T_cn_cnm1 is used");
  }
}

}  // namespace

bool IsKalibr(const CalibrationText& file) {
  return file.text.find("cam0:") != std::string::npos &&
         file.text.find("cam1:") != std::string::npos;
}

StereoRig ReadKalibr(const CalibrationText& file) {
  const CalibrationYaml yaml = CalibrationYaml::Parse(file.text, file.path);
  const CalibrationYaml first = yaml.Section("cam0");
  const CalibrationYaml second = yaml.Section("cam1");
  StereoRig rig;
  rig.format = "Kalibr camera chain";
  rig.left = KalibrCamera(first);
  rig.right = KalibrCamera(second);
  const std::optional<Se3> T_I_L = PoseInImu(first);
  const std::optional<Se3> T_I_R = PoseInImu(second);
  if (second.Has("T_cn_cnm1")) {
    rig.T_L_R = ToSe3(second.Transform("T_cn_cnm1"), second.Where("T_cn_cnm1")).inverse();
    if (T_I_L && T_I_R) CompareWithImu(rig.T_L_R, T_I_L->inverse() * *T_I_R, &rig);
  } else if (T_I_L && T_I_R) {
    rig.T_L_R = T_I_L->inverse() * *T_I_R;
  } else {
    throw InputError(second.Where("T_cn_cnm1") +
                     " is missing, and so is T_cam_imu or T_imu_cam of both cameras: where is the "
                     "second camera?");
  }
  if (yaml.Has("cam2"))
    rig.notes.push_back("the file has more than two cameras; cam0 and cam1 are used");
  return rig;
}

}  // namespace airdos
