#include "processes/node/validate.h"

namespace airdos {

std::string Validate(const image_t&) { return ""; }
std::string Validate(const stereo_calibration_t&) { return ""; }
std::string Validate(const person_keypoints_t&) { return ""; }
std::string Validate(const person_mask_t&) { return ""; }
std::string Validate(const static_features_t&) { return ""; }
std::string Validate(const human_observations_t&) { return ""; }
std::string Validate(const state_estimate_t&) { return ""; }
std::string Validate(const map_update_t&) { return ""; }
std::string Validate(const pose_t&) { return ""; }
std::string Validate(const frame_done_t&) { return ""; }
std::string Validate(const process_status_t&) { return ""; }

}  // namespace airdos
