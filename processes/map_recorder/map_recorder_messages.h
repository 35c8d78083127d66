#ifndef AIRDOS_PROCESSES_MAP_RECORDER_MAP_RECORDER_MESSAGES_H_
#define AIRDOS_PROCESSES_MAP_RECORDER_MAP_RECORDER_MESSAGES_H_

#include "airdos/map_update_t.hpp"
#include "airdos/state_estimate_t.hpp"
#include "common/map/four_d_map.h"

namespace airdos {

// Between the map recorder's messages and the types of common/map.

/// The live pose of a frame; its status must not be STATUS_INVALID.
MapFrame ToMapFrame(const state_estimate_t& message);

/// Adds one part of a MAP_UPDATE: refined poses, landmarks, people. Repeated landmarks are left
/// out, because they are already in the map.
void AddTo(const map_update_t& message, MapDelta* changes);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_MAP_RECORDER_MAP_RECORDER_MESSAGES_H_
