#ifndef AIRDOS_COMMON_CALIBRATION_CALIB_JSON_H_
#define AIRDOS_COMMON_CALIBRATION_CALIB_JSON_H_

#include <string>
#include <utility>

#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Reads calib.json: fx fy cx cy (px), baseline_m and, optionally, width and height (px), for
/// images of `size` (width, height in px). Throws InputError naming file, line and column if it is
/// not JSON, or the key and the likely cause if the numbers are not those of a camera.
StereoCamera ReadCalibJson(const std::string& path, std::pair<int, int> size);

/// The size (width, height in px) that a calib.json says, or {0, 0} if it says none. Throws as
/// ReadCalibJson() does.
std::pair<int, int> ReadCalibJsonSize(const std::string& path);

/// The format of a calib.json, for messages.
inline constexpr char kCalibJsonForm[] =
    R"({"fx": .., "fy": .., "cx": .., "cy": .., "baseline_m": ..} (px, m))";

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_CALIB_JSON_H_
