#ifndef AIRDOS_COMMON_CHECK_IMAGES_H_
#define AIRDOS_COMMON_CHECK_IMAGES_H_

#include <vector>

#include "common/check/check_findings.h"
#include "common/dataset/image_file.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Checks the headers of all images (SurveyImages()): files that are unusable or truncated, sizes
/// that differ from the camera's, formats that differ from file to file, and EXIF orientations, bit
/// depths and channels that are interpreted in a way that the user should know. `range` is that of
/// 16-bit images.
void CheckImageFiles(const std::vector<SurveyedImage>& images, const StereoCamera& camera,
                     const std::optional<SixteenBitRange>& range, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_IMAGES_H_
