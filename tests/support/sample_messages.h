#ifndef AIRDOS_TESTS_SUPPORT_SAMPLE_MESSAGES_H_
#define AIRDOS_TESTS_SUPPORT_SAMPLE_MESSAGES_H_

#include "processes/node/message/validate.h"

namespace airdos {

/// A message that passes Validate() and has at least two elements in every list.
template <class Message>
Message Sample();

template <>
image_t Sample<image_t>();
template <>
stereo_calibration_t Sample<stereo_calibration_t>();
template <>
person_keypoints_t Sample<person_keypoints_t>();
template <>
person_mask_t Sample<person_mask_t>();
template <>
static_features_t Sample<static_features_t>();
template <>
human_observations_t Sample<human_observations_t>();
template <>
state_estimate_t Sample<state_estimate_t>();
template <>
map_update_t Sample<map_update_t>();
template <>
pose_t Sample<pose_t>();
template <>
frame_done_t Sample<frame_done_t>();
template <>
process_status_t Sample<process_status_t>();

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_SAMPLE_MESSAGES_H_
