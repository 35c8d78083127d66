#include "common/calibration/stereo_rig.h"

#include <algorithm>
#include <tuple>

namespace airdos {

double BaselineOf(const StereoRig& rig) { return rig.T_L_R.translation.norm(); }

StereoRig Swapped(const StereoRig& rig) {
  StereoRig swapped = rig;
  std::swap(swapped.left, swapped.right);
  swapped.T_L_R = rig.T_L_R.inverse();
  swapped.rectified.reset();
  return swapped;
}

CameraIntrinsics Resized(const CameraIntrinsics& camera, std::pair<int, int> size) {
  const double by_width = static_cast<double>(size.first) / camera.width;
  const double by_height = static_cast<double>(size.second) / camera.height;
  CameraIntrinsics resized = camera;
  std::tie(resized.width, resized.height) = size;
  resized.fx_px *= by_width;
  resized.fy_px *= by_height;
  resized.cx_px = (camera.cx_px + 0.5) * by_width - 0.5;
  resized.cy_px = (camera.cy_px + 0.5) * by_height - 0.5;
  return resized;
}

Se3 RelativePose(const Eigen::Matrix3d& R_rect_L, const Eigen::Matrix3d& R_rect_R,
                 double baseline_m) {
  Se3 T_L_R;
  T_L_R.rotation = Eigen::Quaterniond(R_rect_L.transpose() * R_rect_R).normalized();
  T_L_R.translation = R_rect_L.transpose() * Eigen::Vector3d(baseline_m, 0, 0);
  return T_L_R;
}

bool IsDistortionCount(LensModel lens, std::size_t count) {
  switch (lens) {
    case LensModel::kNone:
      return count == 0;
    case LensModel::kFisheye:
      return count == 4;
    case LensModel::kRadialTangential:
      break;
  }
  return count == 4 || count == 5 || count == 8 || count == 12 || count == 14;
}

std::string LensText(const CameraIntrinsics& camera) {
  switch (camera.lens) {
    case LensModel::kNone:
      return "no distortion";
    case LensModel::kFisheye:
      return "fisheye (equidistant, 4 coefficients)";
    case LensModel::kRadialTangential:
      break;
  }
  return "radial-tangential (" + std::to_string(camera.distortion.size()) + " coefficients)";
}

}  // namespace airdos
