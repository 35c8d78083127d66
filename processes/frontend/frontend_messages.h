#ifndef AIRDOS_PROCESSES_FRONTEND_FRONTEND_MESSAGES_H_
#define AIRDOS_PROCESSES_FRONTEND_FRONTEND_MESSAGES_H_

#include <cstdint>
#include <vector>

#include "airdos/human_observations_t.hpp"
#include "airdos/map_update_t.hpp"
#include "airdos/static_features_t.hpp"
#include "common/features/local_map.h"
#include "common/features/visual_odometry.h"
#include "common/human/people_filter.h"
#include "processes/node/message/header.h"

namespace airdos {

// Between the frontend's messages and the types of common/features.

/// `odometry_start_seq` is the image number of the first frame of O.
static_features_t ToStaticFeatures(const Header& header, std::int64_t odometry_start_seq,
                                   const OdometryFrame& frame);

/// For a frame without a pose, in which nothing was observed.
static_features_t UnknownStaticFeatures(const Header& header, std::int64_t odometry_start_seq);

/// All people of the message. Joints that are not finite or have no valid covariance are left out.
std::vector<HumanMeasurement> ToHumanMeasurements(const human_observations_t& message);

/// Adds one part of a MAP_UPDATE; `newest` is left to the caller.
void AddTo(const map_update_t& part, MapCorrection* correction);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_FRONTEND_FRONTEND_MESSAGES_H_
