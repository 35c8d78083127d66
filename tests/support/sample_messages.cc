#include "tests/support/sample_messages.h"

#include <vector>

#include "processes/node/message/header.h"

namespace airdos {
namespace {

template <class Message>
Message WithHeader() {
  return MessageOf<Message>({1000, 10, 7});
}

human_observation_t SampleHumanObservation() {
  human_observation_t human = {};
  human.track_id = 3;
  human.num_joints = 2;
  human.joint_id = {1, 13};
  human.u_left_px = {100, 120};
  human.v_left_px = {50, 60};
  human.u_right_px = {90, 110};
  human.v_right_px = {50, 60};
  human.sigma_px = {1, 2};
  human.x_C_m = {1, 2};
  human.y_C_m = {1, 2};
  human.z_C_m = {5, 6};
  human.covariance_C = {{1, 0, 0, 1, 0, 1}, {2, 0, 0, 2, 0, 2}};
  return human;
}

human_state_t SampleHumanState() {
  human_state_t human = {};
  human.track_id = 3;
  human.seq = 10;
  human.utime = 1000;
  human.num_joints = 2;
  human.joint_id = {0, 1};
  human.x_W_m = human.y_W_m = human.z_W_m = {1, 2};
  human.x_W_measured_m = human.y_W_measured_m = human.z_W_measured_m = {1, 2};
  human.num_segments = 2;
  human.segment_id = {0, 13};
  human.length_m = {0.2F, 0.3F};
  human.num_motions = 2;
  human.part_id = {0, 8};
  human.translation_m = {{0, 0, 1}, {0, 1, 0}};
  human.rotation = {{1, 0, 0, 0}, {0, 1, 0, 0}};
  return human;
}

}  // namespace

template <>
image_t Sample<image_t>() {
  auto message = WithHeader<image_t>();
  message.width = 4;
  message.height = 3;
  message.encoding = image_t::ENCODING_RAW_GRAY8;
  message.num_bytes = 12;
  message.data.assign(12, 200);
  return message;
}

template <>
stereo_calibration_t Sample<stereo_calibration_t>() {
  auto message = WithHeader<stereo_calibration_t>();
  message.width = 640;
  message.height = 480;
  message.fx_px = message.fy_px = 500;
  message.cx_px = 320;
  message.cy_px = 240;
  message.baseline_m = 0.25;
  return message;
}

template <>
person_keypoints_t Sample<person_keypoints_t>() {
  auto message = WithHeader<person_keypoints_t>();
  message.layout = person_keypoints_t::LAYOUT_COCO17;
  message.num_people = 2;
  message.num_joints = 17;
  message.u_px.assign(2, std::vector<float>(17, 100));
  message.v_px.assign(2, std::vector<float>(17, 50));
  message.confidence.assign(2, std::vector<float>(17, 0.5F));
  return message;
}

template <>
person_mask_t Sample<person_mask_t>() {
  auto message = WithHeader<person_mask_t>();
  message.width = 4;
  message.height = 3;
  message.encoding = person_mask_t::ENCODING_RAW_GRAY8;
  message.num_bytes = 12;
  message.data.assign(12, 1);
  return message;
}

template <>
static_features_t Sample<static_features_t>() {
  auto message = WithHeader<static_features_t>();
  message.tracking_state = static_features_t::STATE_TRACKING;
  message.orientation_O_C[0] = 1;
  message.orientation_W_C[0] = 1;
  message.sigma_position_m = 0.04;
  message.sigma_orientation_rad = 0.05;
  message.num_features = 2;
  message.landmark_id = {1, 2};
  message.u_left_px = {100, 200};
  message.v_px = {50, 60};
  message.u_right_px = {90, 0};
  message.has_right = {1, 0};
  message.sigma_px = {1, 1.2F};
  return message;
}

template <>
human_observations_t Sample<human_observations_t>() {
  auto message = WithHeader<human_observations_t>();
  message.num_humans = 2;
  message.humans.assign(2, SampleHumanObservation());
  return message;
}

template <>
state_estimate_t Sample<state_estimate_t>() {
  auto message = WithHeader<state_estimate_t>();
  message.status = state_estimate_t::STATUS_CONVERGED;
  message.trusted = state_estimate_t::TRUSTED_WITH_PEOPLE;
  message.orientation_W_C[0] = 1;
  message.orientation_without_people_W_C[1] = 1;
  message.orientation_with_people_W_C[2] = 1;
  for (int i = 0; i < 6; ++i) message.covariance[7 * i] = 1e-4;
  return message;
}

template <>
map_update_t Sample<map_update_t>() {
  auto message = WithHeader<map_update_t>();
  message.num_parts = 2;
  message.part = 1;
  message.num_frames = 2;
  message.frames.resize(2);
  for (frame_pose_t& frame : message.frames) {
    frame = {};
    frame.orientation_W_C[0] = 1;
  }
  message.num_landmarks = 2;
  message.landmark_id = {1, 2};
  message.x_W_m = message.y_W_m = message.z_W_m = {1, 2};
  message.sigma_m = {0.1F, 0.2F};
  message.num_observations = {3, 4};
  message.num_removed = 2;
  message.removed_landmark_id = {5, 6};
  message.num_humans = 2;
  message.humans.assign(2, SampleHumanState());
  message.num_repeated = 2;
  message.repeated_landmark_id = {7, 8};
  message.repeated_x_W_m = message.repeated_y_W_m = message.repeated_z_W_m = {3, 4};
  message.repeated_sigma_m = {0.3F, 0.4F};
  message.repeated_num_observations = {5, 6};
  return message;
}

template <>
pose_t Sample<pose_t>() {
  auto message = WithHeader<pose_t>();
  message.axes = pose_t::AXES_NED;
  message.orientation[3] = 1;
  return message;
}

template <>
frame_done_t Sample<frame_done_t>() {
  auto message = WithHeader<frame_done_t>();
  message.process = "airdos-optimizer";
  return message;
}

template <>
process_status_t Sample<process_status_t>() {
  auto message = WithHeader<process_status_t>();
  message.process = "airdos-optimizer";
  message.version = "1.2.3";
  message.types_fingerprint = "0123456789abcdef";
  message.pid = 4711;
  message.state = process_status_t::STATE_READY;
  message.waiting_for = "CAMERA_LEFT";
  message.num_warnings = 2;
  message.warnings = {"the images are not rectified", "times go back"};
  message.num_channels = 2;
  message.channels.resize(2);
  for (channel_status_t& channel : message.channels) {
    channel = {};
    channel.channel = "CAMERA_LEFT";
    channel.last_reject = "does not decode";
  }
  return message;
}

}  // namespace airdos
