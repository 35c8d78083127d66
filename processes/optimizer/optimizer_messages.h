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

// Conversions between the optimizer's messages and the types of common/optimization.

/// Either message may be null if it never arrived. Observations that are not finite are left out,
/// and so are joints outside the body model and those without a valid covariance.
FrameInput ToFrameInput(const Header& header, const StereoCamera& camera,
                        const static_features_t* features, const human_observations_t* humans);

state_estimate_t ToStateEstimate(const Header& header, const FrameEstimate& estimate);

/// For a frame without a pose, because the frontend has not been heard yet.
state_estimate_t UnknownStateEstimate(const Header& header);

/// At least one part, each of which encodes to less than 120 kB (lcmtypes/README.md explains why).
/// `repeated` are landmarks of earlier frames that are published again.
std::vector<map_update_t> ToMapUpdates(const Header& header, const MapChanges& changes,
                                       const std::vector<MapChanges::Landmark>& repeated = {});

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_OPTIMIZER_OPTIMIZER_MESSAGES_H_
