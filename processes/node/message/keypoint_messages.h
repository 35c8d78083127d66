#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_KEYPOINT_MESSAGES_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_KEYPOINT_MESSAGES_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "airdos/person_keypoints_t.hpp"
#include "common/human/body_keypoints.h"
#include "common/human/layouts.h"

namespace airdos {

/// The layout in person_keypoints_t::layout; nothing if it is unknown.
std::optional<KeypointLayout> LayoutOf(int layout);
/// The inverse.
std::int8_t ToMessageLayout(KeypointLayout layout);

/// The people in a message that has passed Validate(), with the keypoints as detected.
std::vector<std::vector<BodyKeypoint>> ToDetections(const person_keypoints_t& message);

/// The people in a message that has passed Validate(), with the joints of our body model. Nobody if
/// the layout is unknown.
std::vector<BodyKeypoints> ToPeople(const person_keypoints_t& message);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_KEYPOINT_MESSAGES_H_
