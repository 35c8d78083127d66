#include "common/dataset/kitti_calibration.h"

#include <cmath>
#include <tuple>

#include "common/calibration/camera_causes.h"
#include "common/util/error.h"

namespace airdos {

KittiProjection ParseProjection(const std::string& path, const TextLine& line,
                                std::size_t first_word) {
  KittiProjection projection = {line.number, ParseNumbers(path, line, first_word)};
  if (projection.p.size() != 12) {
    throw InputError(path + ":" + std::to_string(line.number) +
                     ": must hold 12 numbers (3 x 4 projection), holds " +
                     std::to_string(projection.p.size()));
  }
  return projection;
}

StereoCamera MakeStereoCamera(const std::string& path, const KittiProjection& left,
                              const KittiProjection& right, std::pair<int, int> size) {
  const std::string where = path + ":" + std::to_string(right.line);
  for (const std::size_t i : {0U, 2U, 5U, 6U}) {
    if (std::abs(left.p[i] - right.p[i]) > 1e-6 * std::abs(left.p[i])) {
      throw InputError(where + ": number " + std::to_string(i + 1) + " differs from " +
                       std::to_string(left.p[i]) + " of the left camera: not a rectified pair");
    }
  }
  StereoCamera camera;
  std::tie(camera.width, camera.height) = size;
  camera.fx_px = left.p[0];
  camera.cx_px = left.p[2];
  camera.fy_px = left.p[5];
  camera.cy_px = left.p[6];
  camera.baseline_m = (left.p[3] - right.p[3]) / left.p[0];
  if (!camera.IsValid()) {
    throw InputError(where + ": not a pinhole stereo camera for images of " +
                     std::to_string(camera.width) + " x " + std::to_string(camera.height) +
                     " px (focal length " + std::to_string(camera.fx_px) + " px, baseline " +
                     std::to_string(camera.baseline_m) + " m): " + WhyNoCamera(camera));
  }
  return camera;
}

}  // namespace airdos
