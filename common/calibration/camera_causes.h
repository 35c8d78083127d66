#ifndef AIRDOS_COMMON_CALIBRATION_CAMERA_CAUSES_H_
#define AIRDOS_COMMON_CALIBRATION_CAMERA_CAUSES_H_

#include <optional>
#include <string>

#include "common/geometry/stereo_camera.h"

namespace airdos {

// Finds the likely user error behind camera parameters that do not fit.

/// Ratio of the resolution that the camera was calibrated at to that of its images, judged by the
/// principal point: off centre by the same factor in both directions, and by at least 10 %. Nothing
/// if the factors differ.
std::optional<double> ResolutionFactor(const StereoCamera& camera);

/// Whether cx suits the height and cy the width, but not the other way round.
bool IsPrincipalPointSwapped(const StereoCamera& camera);

/// "half as large", "twice as large", "1.5 times as large".
std::string TimesAsLarge(double factor);

/// What a baseline that is too long in m would be in mm or cm, or if it were fx * baseline: ";
/// ...", or empty.
std::string ExplainBaseline(const StereoCamera& camera);

/// Why IsValid() is false, in words; empty if it is true.
std::string WhyNoCamera(const StereoCamera& camera);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_CAMERA_CAUSES_H_
