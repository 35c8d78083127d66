#ifndef AIRDOS_COMMON_HUMAN_LAYOUTS_H_
#define AIRDOS_COMMON_HUMAN_LAYOUTS_H_

#include <optional>
#include <vector>

#include "common/human/body_keypoints.h"

namespace airdos {

/// The orders in which detectors give the joints of a person.
enum class KeypointLayout { kCoco18, kCoco17, kHalpe26 };

/// Joints in one detection of this layout.
int NumKeypoints(KeypointLayout layout);

/// The 14 body joints of one detection. COCO-17 has no neck: it becomes the middle of the
/// shoulders, with the lower of their confidences, where both are seen. Joints that are not finite
/// or whose confidence is not positive count as not seen; confidences above 1 become 1. Nothing
/// where the number of keypoints is not the layout's.
std::optional<BodyKeypoints> MapToBody(KeypointLayout layout,
                                       const std::vector<BodyKeypoint>& detection);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_LAYOUTS_H_
