#ifndef AIRDOS_COMMON_CALIBRATION_CAMERA_CAUSES_H_
#define AIRDOS_COMMON_CALIBRATION_CAMERA_CAUSES_H_

#include <optional>
#include <string>

#include "common/geometry/stereo_camera.h"

namespace airdos {

// What lies behind the numbers of a camera that do not fit: what users write by mistake.

/// How many times as large as the camera's the images were that it was calibrated for, where the
/// principal point says so: off the middle by one factor in both directions, by at least a tenth.
/// Nothing where the directions differ.
std::optional<double> ResolutionFactor(const StereoCamera& camera);

/// Whether cx fits the height and cy the width, but not the other way round.
bool IsPrincipalPointSwapped(const StereoCamera& camera);

/// "half as large", "twice as large", "1.5 times as large".
std::string TimesAsLarge(double factor);

/// What a baseline that is too long for m would be in mm or cm, or if it were fx * baseline:
/// "; ...", or empty.
std::string ExplainBaseline(const StereoCamera& camera);

/// Why IsValid() is false, in words; empty where it is true.
std::string WhyNoCamera(const StereoCamera& camera);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_CAMERA_CAUSES_H_
