#ifndef AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_MESSAGES_H_
#define AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_MESSAGES_H_

#include "airdos/human_observations_t.hpp"
#include "common/human/human_tracker.h"
#include "processes/node/message/header.h"

namespace airdos {

// Between the human tracker's messages and the types of common/human. Keypoints are converted by
// processes/node/message/keypoint_messages.h.

/// What was found in `frame`. A joint has the same row in both images: that of both detections
/// together.
human_observations_t ToHumanObservations(const Header& header, const PeopleFrame& frame,
                                         const TrackedFrame& tracked);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_MESSAGES_H_
