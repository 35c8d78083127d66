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

/// `odometry_start_seq` is the number of the first image of O.
static_features_t ToStaticFeatures(const Header& header, std::int64_t odometry_start_seq,
                                   const OdometryFrame& frame);

/// Of a frame that has no pose, and in which nothing was looked at.
static_features_t UnknownStaticFeatures(const Header& header, std::int64_t odometry_start_seq);

/// Everybody of the message; joints that are not finite, or whose covariance is none, are left out.
std::vector<PersonMeasurement> ToPersonMeasurements(const human_observations_t& message);

/// Adds what one part of a MAP_UPDATE says to the rest; `newest` is the caller's.
void AddTo(const map_update_t& part, MapCorrection* correction);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_FRONTEND_FRONTEND_MESSAGES_H_
