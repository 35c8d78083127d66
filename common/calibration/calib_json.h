#ifndef AIRDOS_COMMON_CALIBRATION_CALIB_JSON_H_
#define AIRDOS_COMMON_CALIBRATION_CALIB_JSON_H_

#include <string>
#include <utility>

#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Reads calib.json: fx fy cx cy (px), baseline_m, and optionally width and height (px), for images
/// of `size` (width, height in px). Throws InputError naming file, line and column where it is no
/// JSON, or the key, and the likely cause where the numbers are no camera.
StereoCamera ReadCalibJson(const std::string& path, std::pair<int, int> size);

/// How a calib.json is written, for messages.
inline constexpr char kCalibJsonForm[] =
    R"({"fx": .., "fy": .., "cx": .., "cy": .., "baseline_m": ..} (px, m))";

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_CALIB_JSON_H_
