#ifndef AIRDOS_PROCESSES_NODE_KEYPOINT_MESSAGES_H_
#define AIRDOS_PROCESSES_NODE_KEYPOINT_MESSAGES_H_

#include <vector>

#include "airdos/person_keypoints_t.hpp"
#include "common/human/body_keypoints.h"

namespace airdos {

/// The people of a message that has passed Validate(), with the joints of our body model. Nobody
/// where the layout is unknown.
std::vector<BodyKeypoints> ToPeople(const person_keypoints_t& message);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_KEYPOINT_MESSAGES_H_
