#ifndef AIRDOS_PROCESSES_OPTIMIZER_OPTIMIZER_MESSAGES_H_
#define AIRDOS_PROCESSES_OPTIMIZER_OPTIMIZER_MESSAGES_H_

#include <vector>

#include "airdos/human_observations_t.hpp"
#include "airdos/map_update_t.hpp"
#include "airdos/state_estimate_t.hpp"
#include "airdos/static_features_t.hpp"
#include "common/optimization/window/sliding_window.h"
#include "processes/node/frame_joiner.h"

namespace airdos {

// Between the optimizer's messages and the types of common/optimization.

/// Either message may be null: it never came. Observations that are not finite are left out, and so
/// are joints beyond the body model and those whose covariance is none.
FrameInput ToFrameInput(const Header& header, const StereoCamera& camera,
                        const static_features_t* features, const human_observations_t* humans);

state_estimate_t ToStateEstimate(const Header& header, const FrameEstimate& estimate);

/// Of a frame for which there is no pose, since the front end has not been heard yet.
state_estimate_t UnknownStateEstimate(const Header& header);

/// At least one part; each encodes to less than 120 kB (README of lcmtypes: why). `repeated` are
/// landmarks of earlier frames that are told again.
std::vector<map_update_t> ToMapUpdates(const Header& header, const MapChanges& changes,
                                       const std::vector<MapChanges::Landmark>& repeated = {});

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_OPTIMIZER_OPTIMIZER_MESSAGES_H_
