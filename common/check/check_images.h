#ifndef AIRDOS_COMMON_CHECK_IMAGES_H_
#define AIRDOS_COMMON_CHECK_IMAGES_H_

#include <vector>

#include "common/check/check_findings.h"
#include "common/dataset/image_file.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// What the headers of all images say (SurveyImages()): files that cannot be used or are cut short,
/// sizes that are not the camera's, kinds that differ from file to file; EXIF's wishes, bits and
/// channels that are read in a way that should be known. `range`: of 16-bit images.
void CheckImageFiles(const std::vector<SurveyedImage>& images, const StereoCamera& camera,
                     const std::optional<SixteenBitRange>& range, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_IMAGES_H_
