#include "processes/map_recorder/map_recorder_messages.h"

#include <cstddef>
#include <cstdint>

#include "processes/node/message/conversions.h"

namespace airdos {
namespace {

MapHuman ToMapHuman(const human_state_t& message) {
  MapHuman human;
  human.utime = message.utime;
  for (std::size_t i = 0; i < message.joint_id.size(); ++i) {
    MapJoint& joint = human.joints[message.joint_id[i]];
    joint.p_W = {message.x_W_m[i], message.y_W_m[i], message.z_W_m[i]};
    joint.p_W_measured = {message.x_W_measured_m[i], message.y_W_measured_m[i],
                          message.z_W_measured_m[i]};
  }
  for (std::size_t i = 0; i < message.segment_id.size(); ++i) {
    human.segment_lengths_m[message.segment_id[i]] = message.length_m[i];
  }
  for (std::size_t i = 0; i < message.part_id.size(); ++i) {
    MapPartMotion& motion = human.part_motions[message.part_id[i]];
    const auto& t = message.translation_m[i];
    const auto& q = message.rotation[i];
    motion.t_W = {t[0], t[1], t[2]};
    motion.R_W = Eigen::Quaternionf(q[0], q[1], q[2], q[3]);
  }
  return human;
}

}  // namespace

void AddTo(const map_update_t& message, MapDelta* changes) {
  for (const frame_pose_t& pose : message.frames) {
    MapFrame frame;
    frame.utime = pose.utime;
    frame.refined = ToSe3(pose.position_W_C, pose.orientation_W_C);
    changes->SetFrame({pose.seq}, frame);
  }
  for (std::size_t i = 0; i < message.landmark_id.size(); ++i) {
    MapLandmark landmark;
    landmark.p_W =
        Eigen::Vector3d(message.x_W_m[i], message.y_W_m[i], message.z_W_m[i]).cast<float>();
    landmark.sigma_m = message.sigma_m[i];
    landmark.num_observations = message.num_observations[i];
    changes->SetLandmark({message.landmark_id[i]}, landmark);
  }
  for (const std::int64_t id : message.removed_landmark_id) changes->RemoveLandmark({id});
  for (const human_state_t& human : message.humans) {
    changes->SetHuman({human.seq}, {human.track_id}, ToMapHuman(human));
  }
}

MapFrame ToMapFrame(const state_estimate_t& message) {
  MapFrame frame;
  frame.utime = message.utime;
  frame.live = ToSe3(message.position_W_C, message.orientation_W_C);
  frame.status = message.status;
  frame.is_trusted_with_people = message.trusted == state_estimate_t::TRUSTED_WITH_PEOPLE;
  return frame;
}

}  // namespace airdos
