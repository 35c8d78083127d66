#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_VALIDATE_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_VALIDATE_H_

#include <string>

#include "airdos/frame_done_t.hpp"
#include "airdos/human_observations_t.hpp"
#include "airdos/image_t.hpp"
#include "airdos/map_update_t.hpp"
#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/pose_t.hpp"
#include "airdos/process_status_t.hpp"
#include "airdos/state_estimate_t.hpp"
#include "airdos/static_features_t.hpp"
#include "airdos/stereo_calibration_t.hpp"

namespace airdos {

/// Why a decoded message is invalid (sizes, ranges, NaN, ids), or an empty text. Two out of five
/// messages with a flipped bit still decode, so every message is checked here before a node sees
/// it.
std::string Validate(const image_t& message);
std::string Validate(const stereo_calibration_t& message);
std::string Validate(const person_keypoints_t& message);
std::string Validate(const person_mask_t& message);
std::string Validate(const static_features_t& message);
std::string Validate(const human_observations_t& message);
std::string Validate(const state_estimate_t& message);
std::string Validate(const map_update_t& message);
std::string Validate(const pose_t& message);
std::string Validate(const frame_done_t& message);
std::string Validate(const process_status_t& message);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_VALIDATE_H_
