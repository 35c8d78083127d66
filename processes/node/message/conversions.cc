#include "processes/node/message/conversions.h"

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

}  // namespace airdos
