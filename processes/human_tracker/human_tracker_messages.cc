#include "processes/human_tracker/human_tracker_messages.h"

#include <cstddef>
#include <cstdint>
#include <optional>

#include "processes/node/message/conversions.h"
#include "processes/node/message/header.h"

namespace airdos {
namespace {

human_observation_t ToMessage(const TrackedHuman& human) {
  human_observation_t message{};
  message.track_id = human.id.value;
  for (std::size_t joint = 0; joint < human.joints.size(); ++joint) {
    const std::optional<TriangulatedJoint>& seen = human.joints[joint];
    if (!seen) continue;
    const auto as_float = [](double value) { return static_cast<float>(value); };
    message.joint_id.push_back(static_cast<int8_t>(joint));
    message.u_left_px.push_back(as_float(seen->u_left_px));
    message.v_left_px.push_back(as_float(seen->v_px));
    message.u_right_px.push_back(as_float(seen->u_right_px));
    message.v_right_px.push_back(as_float(seen->v_px));
    message.sigma_px.push_back(as_float(seen->sigma_px));
    message.x_C_m.push_back(as_float(seen->p_C.x()));
    message.y_C_m.push_back(as_float(seen->p_C.y()));
    message.z_C_m.push_back(as_float(seen->p_C.z()));
    message.covariance_C.push_back(FromCovariance(seen->covariance_C));
  }
  message.num_joints = static_cast<int32_t>(message.joint_id.size());
  return message;
}

}  // namespace

human_observations_t ToHumanObservations(const Header& header, const PeopleFrame& frame,
                                         const TrackedFrame& tracked) {
  auto message = MessageOf<human_observations_t>(header);
  message.num_detected_left = static_cast<int32_t>(frame.left.size());
  message.num_detected_right = static_cast<int32_t>(frame.right.size());
  message.num_rejected = static_cast<int32_t>(tracked.num_rejected);
  for (const TrackedHuman& human : tracked.humans) message.humans.push_back(ToMessage(human));
  message.num_humans = static_cast<int32_t>(message.humans.size());
  return message;
}

}  // namespace airdos
