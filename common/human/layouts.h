#ifndef AIRDOS_COMMON_HUMAN_LAYOUTS_H_
#define AIRDOS_COMMON_HUMAN_LAYOUTS_H_

#include <optional>
#include <vector>

#include "common/human/body_keypoints.h"

namespace airdos {

/// The joint orders that detectors use.
enum class KeypointLayout { kCoco18, kCoco17, kHalpe26 };

/// Number of keypoints per detection in this layout.
int NumKeypoints(KeypointLayout layout);

/// The 14 body joints of one detection. COCO-17 has no neck: it is set to the middle of the
/// shoulders, with the lower of their confidences, if both are seen. Joints that are not finite or
/// whose confidence is not positive count as not seen; confidences above 1 are set to 1. Nothing if
/// the number of keypoints is not the layout's.
std::optional<BodyKeypoints> MapToBody(KeypointLayout layout,
                                       const std::vector<BodyKeypoint>& detection);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_LAYOUTS_H_
