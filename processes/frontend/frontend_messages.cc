#include "processes/frontend/frontend_messages.h"

#include <Eigen/Cholesky>
#include <cstddef>
#include <utility>

#include "processes/node/message/conversions.h"
#include "processes/node/message/header.h"

namespace airdos {
namespace {

std::int8_t ToMessage(TrackingState state) {
  switch (state) {
    case TrackingState::kInitializing:
      return static_features_t::STATE_INITIALIZING;
    case TrackingState::kTracking:
      return static_features_t::STATE_TRACKING;
    case TrackingState::kWeak:
      return static_features_t::STATE_WEAK;
    case TrackingState::kCoasting:
      return static_features_t::STATE_COASTING;
  }
  return static_features_t::STATE_INVALID;
}

}  // namespace

static_features_t ToStaticFeatures(const Header& header, std::int64_t odometry_start_seq,
                                   const OdometryFrame& frame) {
  auto message = MessageOf<static_features_t>(header);
  message.tracking_state = ToMessage(frame.state);
  FromSe3(frame.T_O_C, message.position_O_C, message.orientation_O_C);
  message.odometry_start_seq = odometry_start_seq;
  FromSe3(frame.T_W_C, message.position_W_C, message.orientation_W_C);
  message.sigma_position_m = frame.prior_sigma_position_m;
  message.sigma_orientation_rad = frame.prior_sigma_orientation_rad;
  message.num_detected = frame.num_detected;
  message.num_masked = frame.num_masked;
  message.num_matched = frame.num_matched;
  message.num_features = static_cast<std::int32_t>(frame.sightings.size());
  for (const LandmarkSighting& sighting : frame.sightings) {
    message.landmark_id.push_back(sighting.id.value);
    message.u_left_px.push_back(static_cast<float>(sighting.uvu_px.x()));
    message.v_px.push_back(static_cast<float>(sighting.uvu_px.y()));
    message.u_right_px.push_back(static_cast<float>(sighting.uvu_px.z()));
    message.has_right.push_back(sighting.has_right);
    message.sigma_px.push_back(static_cast<float>(sighting.sigma_px));
  }
  return message;
}

static_features_t UnknownStaticFeatures(const Header& header, std::int64_t odometry_start_seq) {
  static_features_t message = ToStaticFeatures(header, odometry_start_seq, OdometryFrame());
  message.tracking_state = static_features_t::STATE_INVALID;
  return message;
}

std::vector<HumanMeasurement> ToHumanMeasurements(const human_observations_t& message) {
  std::vector<HumanMeasurement> people;
  for (const human_observation_t& human : message.humans) {
    HumanMeasurement person{HumanId{human.track_id}, {}};
    for (std::size_t i = 0; i < human.joint_id.size(); ++i) {
      HumanMeasurement::Joint joint;
      joint.joint = human.joint_id[i];
      joint.p_C = {human.x_C_m[i], human.y_C_m[i], human.z_C_m[i]};
      joint.covariance_C = ToCovariance(human.covariance_C[i]);
      const bool is_covariance =
          Eigen::LLT<Eigen::Matrix3d>(joint.covariance_C).info() == Eigen::Success;
      if (joint.p_C.allFinite() && joint.covariance_C.allFinite() && is_covariance) {
        person.joints.push_back(joint);
      }
    }
    people.push_back(std::move(person));
  }
  return people;
}

void AddTo(const map_update_t& part, MapCorrection* correction) {
  for (const frame_pose_t& frame : part.frames) {
    correction->frames.emplace_back(FrameId{frame.seq},
                                    ToSe3(frame.position_W_C, frame.orientation_W_C));
  }
  for (std::size_t i = 0; i < part.landmark_id.size(); ++i) {
    correction->landmarks_W_m.emplace_back(
        LandmarkId{part.landmark_id[i]},
        Eigen::Vector3d(part.x_W_m[i], part.y_W_m[i], part.z_W_m[i]));
  }
  for (const std::int64_t id : part.removed_landmark_id)
    correction->removed.push_back(LandmarkId{id});
}

}  // namespace airdos
