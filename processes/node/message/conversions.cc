#include "processes/node/message/conversions.h"

#include "common/util/check.h"

namespace airdos {

StereoCamera ToStereoCamera(const stereo_calibration_t& message) {
  return {message.width, message.height, message.fx_px,     message.fy_px,
          message.cx_px, message.cy_px,  message.baseline_m};
}

void FromStereoCamera(const StereoCamera& camera, stereo_calibration_t* message) {
  message->width = camera.width;
  message->height = camera.height;
  message->fx_px = camera.fx_px;
  message->fy_px = camera.fy_px;
  message->cx_px = camera.cx_px;
  message->cy_px = camera.cy_px;
  message->baseline_m = camera.baseline_m;
}

std::vector<float> FromCovariance(const Eigen::Matrix3d& S) {
  std::vector<float> upper;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      upper.push_back(static_cast<float>(S(row, column)));
    }
  }
  return upper;
}

Eigen::Matrix3d ToCovariance(const std::vector<float>& upper) {
  AIRDOS_CHECK(upper.size() == 6);
  const std::vector<float>& s = upper;
  Eigen::Matrix3d S;
  S << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  return S;
}

}  // namespace airdos
