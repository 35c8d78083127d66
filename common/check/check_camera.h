#ifndef AIRDOS_COMMON_CHECK_CAMERA_H_
#define AIRDOS_COMMON_CHECK_CAMERA_H_

#include <string>

#include "common/check/check_findings.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Whether the numbers can be those of a stereo camera in px and m for images of this size: focal
/// length 0.3 to 4 times the width, principal point near the centre, baseline 2 cm to 2 m. Common
/// mistakes are named: another resolution, cx and cy exchanged, mm, fx * baseline.
void CheckCamera(const StereoCamera& camera, const std::string& where, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_CAMERA_H_
