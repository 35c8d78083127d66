#include "processes/optimizer/optimizer_messages.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/human/skeleton.h"
#include "processes/node/message/conversions.h"

namespace airdos {
namespace {

constexpr double kMicro = 1e-6;
constexpr int kMaxPartBytes = 110000;

std::int64_t ToUtime(double time_s) {
  return static_cast<std::int64_t>(std::llround(time_s / kMicro));
}

bool IsUsable(const Eigen::Vector3d& uvu_px, bool has_right, double sigma_px) {
  const bool is_finite = has_right ? uvu_px.allFinite() : uvu_px.head<2>().allFinite();
  return is_finite && std::isfinite(sigma_px) && sigma_px > 0;
}

void AddFeatures(const static_features_t& message, FrameInput* input) {
  const Se3 T_O_C = ToSe3(message.position_O_C, message.orientation_O_C);
  if (T_O_C.translation.allFinite() && T_O_C.rotation.coeffs().allFinite()) {
    input->T_O_C = T_O_C;
    input->odometry_start.value = message.odometry_start_seq;
    input->T_W_C = ToSe3(message.position_W_C, message.orientation_W_C);
  }
  if (message.sigma_position_m > 0 && message.sigma_orientation_rad > 0) {  // not NaN
    input->motion_sigma_position_m = message.sigma_position_m;
    input->motion_sigma_orientation_rad = message.sigma_orientation_rad;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(message.num_features); ++i) {
    StaticObservation feature;
    feature.id.value = message.landmark_id[i];
    feature.has_right = message.has_right[i] != 0;
    feature.uvu_px = {message.u_left_px[i], message.v_px[i],
                      feature.has_right ? message.u_right_px[i] : 0.0F};
    feature.sigma_px = message.sigma_px[i];
    if (IsUsable(feature.uvu_px, feature.has_right, feature.sigma_px)) {
      input->features.push_back(feature);
    }
  }
}

/// Covariance of (u_left, v, u_right) in px^2 from that of the joint in C: J S J^T. Nothing where
/// it is no covariance.
std::optional<Eigen::Matrix3d> ImageCovariance(const StereoCamera& camera,
                                               const human_observation_t& message, std::size_t i) {
  const Eigen::Matrix3d S = ToCovariance(message.covariance_C[i]);
  const Eigen::Vector3d p_C(message.x_C_m[i], message.y_C_m[i], message.z_C_m[i]);
  if (!S.allFinite() || !p_C.allFinite() || !(p_C.z() > 0)) return std::nullopt;
  const Eigen::Matrix3d J = camera.ProjectStereoJacobian(p_C);
  const Eigen::Matrix3d covariance_px2 = J * S * J.transpose();
  constexpr double kLeastVariance_px2 = 1e-4;  // single precision may have lost what is below
  const Eigen::Matrix3d safe = 0.5 * (covariance_px2 + covariance_px2.transpose()) +
                               kLeastVariance_px2 * Eigen::Matrix3d::Identity();
  if (Eigen::LLT<Eigen::Matrix3d>(safe).info() != Eigen::Success) return std::nullopt;
  return safe;
}

void AddHuman(const StereoCamera& camera, const human_observation_t& message, FrameInput* input) {
  HumanObservation human;
  human.id.value = message.track_id;
  for (std::size_t i = 0; i < static_cast<std::size_t>(message.num_joints); ++i) {
    JointObservation joint;
    joint.joint = message.joint_id[i];
    // One row for both images: the cameras are rectified.
    joint.uvu_px = {message.u_left_px[i], 0.5F * (message.v_left_px[i] + message.v_right_px[i]),
                    message.u_right_px[i]};
    const bool is_body = joint.joint >= 0 && joint.joint < kNumJoints;
    const std::optional<Eigen::Matrix3d> covariance_px2 = ImageCovariance(camera, message, i);
    if (!is_body || !joint.uvu_px.allFinite() || !covariance_px2) continue;
    joint.covariance_px2 = *covariance_px2;
    human.joints.push_back(joint);
  }
  const auto by_joint = [](const JointObservation& a, const JointObservation& b) {
    return a.joint < b.joint;
  };
  std::stable_sort(human.joints.begin(), human.joints.end(), by_joint);
  const auto same_joint = [](const JointObservation& a, const JointObservation& b) {
    return a.joint == b.joint;
  };
  human.joints.erase(std::unique(human.joints.begin(), human.joints.end(), same_joint),
                     human.joints.end());
  if (!human.joints.empty()) input->humans.push_back(human);
}

std::int8_t ToStatus(FrameEstimate::Status status) {
  switch (status) {
    case FrameEstimate::Status::kFirstFrame:
      return state_estimate_t::STATUS_FIRST_FRAME;
    case FrameEstimate::Status::kConverged:
      return state_estimate_t::STATUS_CONVERGED;
    case FrameEstimate::Status::kNotConverged:
      return state_estimate_t::STATUS_NOT_CONVERGED;
    case FrameEstimate::Status::kPredicted:
      return state_estimate_t::STATUS_PREDICTED;
  }
  return state_estimate_t::STATUS_INVALID;
}

/// Inverting a system with hardly any information may yield variances that are negative or beyond
/// what receivers accept; such a covariance is replaced by one that states that nothing is known.
Eigen::Matrix<double, 6, 6> Published(const Eigen::Matrix<double, 6, 6>& covariance) {
  constexpr double kMaxVariance = 1e12;  // as in Validate()
  constexpr double kUnknownVariance = 1e6;
  const bool is_sane = covariance.allFinite() && covariance.diagonal().minCoeff() >= 0 &&
                       covariance.cwiseAbs().maxCoeff() <= kMaxVariance;
  if (is_sane) return covariance;
  return kUnknownVariance * Eigen::Matrix<double, 6, 6>::Identity();
}

human_state_t ToHumanState(const HumanState& state) {
  human_state_t message{};
  message.track_id = state.id.value;
  message.seq = state.frame.value;
  message.utime = ToUtime(state.time_s);
  const auto add = [](double value, std::vector<float>* values) {
    values->push_back(static_cast<float>(value));
  };
  for (const HumanState::JointPosition& joint : state.joints) {
    message.joint_id.push_back(static_cast<std::int8_t>(joint.joint));
    add(joint.p_W.x(), &message.x_W_m);
    add(joint.p_W.y(), &message.y_W_m);
    add(joint.p_W.z(), &message.z_W_m);
    add(joint.p_W_measured.x(), &message.x_W_measured_m);
    add(joint.p_W_measured.y(), &message.y_W_measured_m);
    add(joint.p_W_measured.z(), &message.z_W_measured_m);
  }
  message.num_joints = static_cast<std::int32_t>(state.joints.size());
  for (const HumanState::SegmentLength& segment : state.segments) {
    message.segment_id.push_back(static_cast<std::int8_t>(segment.segment));
    add(segment.length_m, &message.length_m);
  }
  message.num_segments = static_cast<std::int32_t>(state.segments.size());
  for (const BundleProblem::PartMotion& motion : state.motions) {
    message.part_id.push_back(static_cast<std::int8_t>(motion.part));
    const Eigen::Vector3f t = motion.motion_W.translation.cast<float>();
    const Eigen::Quaternionf q = motion.motion_W.rotation.cast<float>();
    message.translation_m.push_back({t.x(), t.y(), t.z()});
    message.rotation.push_back({q.w(), q.x(), q.y(), q.z()});
  }
  message.num_motions = static_cast<std::int32_t>(state.motions.size());
  return message;
}

/// Fills one message after another, each up to the size that can travel.
class PartWriter {
 public:
  explicit PartWriter(const Header& header) : header_(header) { StartPart(); }

  void Add(const MapChanges::FramePose& frame) {
    frame_pose_t pose{};
    pose.seq = frame.id.value;
    pose.utime = ToUtime(frame.time_s);
    FromSe3(frame.T_W_C, pose.position_W_C, pose.orientation_W_C);
    map_update_t& part = PartWithRoom(72);
    part.frames.push_back(pose);
    ++part.num_frames;
  }
  void Add(const MapChanges::Landmark& landmark) {
    map_update_t& part = PartWithRoom(40);
    part.landmark_id.push_back(landmark.id.value);
    part.x_W_m.push_back(landmark.p_W.x());
    part.y_W_m.push_back(landmark.p_W.y());
    part.z_W_m.push_back(landmark.p_W.z());
    part.sigma_m.push_back(static_cast<float>(landmark.sigma_m));
    part.num_observations.push_back(landmark.num_observations);
    ++part.num_landmarks;
  }
  void AddRepeated(const MapChanges::Landmark& landmark) {
    map_update_t& part = PartWithRoom(40);
    part.repeated_landmark_id.push_back(landmark.id.value);
    part.repeated_x_W_m.push_back(landmark.p_W.x());
    part.repeated_y_W_m.push_back(landmark.p_W.y());
    part.repeated_z_W_m.push_back(landmark.p_W.z());
    part.repeated_sigma_m.push_back(static_cast<float>(landmark.sigma_m));
    part.repeated_num_observations.push_back(landmark.num_observations);
    ++part.num_repeated;
  }
  void Add(LandmarkId removed) {
    map_update_t& part = PartWithRoom(8);
    part.removed_landmark_id.push_back(removed.value);
    ++part.num_removed;
  }
  void Add(const human_state_t& human) {
    map_update_t& part = PartWithRoom(human.getEncodedSize());
    part.humans.push_back(human);
    ++part.num_humans;
  }

  std::vector<map_update_t> Finish() {
    for (map_update_t& part : parts_) part.num_parts = static_cast<std::int32_t>(parts_.size());
    return std::move(parts_);
  }

 private:
  void StartPart() {
    auto part = MessageOf<map_update_t>(header_);
    part.part = static_cast<std::int32_t>(parts_.size());
    parts_.push_back(part);
    num_bytes_ = 0;
  }
  map_update_t& PartWithRoom(int num_bytes) {
    if (num_bytes_ + num_bytes > kMaxPartBytes) StartPart();
    num_bytes_ += num_bytes;
    return parts_.back();
  }

  Header header_;
  std::vector<map_update_t> parts_;
  int num_bytes_ = 0;
};

}  // namespace

FrameInput ToFrameInput(const Header& header, const StereoCamera& camera,
                        const static_features_t* features, const human_observations_t* humans) {
  FrameInput input;
  input.id.value = header.seq;
  input.time_s = static_cast<double>(header.utime) * kMicro;
  if (features != nullptr) AddFeatures(*features, &input);
  if (humans != nullptr) {
    for (const human_observation_t& human : humans->humans) AddHuman(camera, human, &input);
    const auto by_id = [](const HumanObservation& a, const HumanObservation& b) {
      return a.id < b.id;
    };
    std::stable_sort(input.humans.begin(), input.humans.end(), by_id);
    const auto same_id = [](const HumanObservation& a, const HumanObservation& b) {
      return a.id == b.id;
    };
    input.humans.erase(std::unique(input.humans.begin(), input.humans.end(), same_id),
                       input.humans.end());
  }
  return input;
}

state_estimate_t ToStateEstimate(const Header& header, const FrameEstimate& estimate) {
  auto message = MessageOf<state_estimate_t>(header);
  message.status = ToStatus(estimate.status);
  FromSe3(estimate.T_W_C, message.position_W_C, message.orientation_W_C);
  const auto covariance = Published(estimate.covariance);
  for (int i = 0; i < 36; ++i) message.covariance[i] = covariance(i / 6, i % 6);
  message.trusted = estimate.trusts_people ? state_estimate_t::TRUSTED_WITH_PEOPLE
                                           : state_estimate_t::TRUSTED_WITHOUT_PEOPLE;
  FromSe3(estimate.T_W_C_without_people, message.position_without_people_W_C,
          message.orientation_without_people_W_C);
  FromSe3(estimate.T_W_C_with_people, message.position_with_people_W_C,
          message.orientation_with_people_W_C);
  message.num_window_frames = estimate.num_window_frames;
  message.num_static_landmarks = estimate.num_static_landmarks;
  message.num_static_observations = estimate.num_static_observations;
  const BundleSummary& summary = estimate.summary;
  message.num_people = summary.num_people;
  message.num_rigidity_factors = summary.num_rigidity;
  message.num_motion_factors = summary.num_motion;
  message.num_rigidity_eliminated = summary.num_rigidity_rejected;
  message.num_motion_eliminated = summary.num_motion_rejected;
  message.num_reprojection_eliminated = summary.num_reprojection_rejected;
  message.num_iterations = summary.num_iterations;
  message.initial_cost = summary.initial_cost;
  message.final_cost = summary.final_cost;
  return message;
}

state_estimate_t UnknownStateEstimate(const Header& header) {
  FrameEstimate nothing;
  nothing.covariance = kUnobservedSigma * kUnobservedSigma * Matrix6d::Identity();
  state_estimate_t message = ToStateEstimate(header, nothing);
  message.status = state_estimate_t::STATUS_INVALID;
  return message;
}

std::vector<map_update_t> ToMapUpdates(const Header& header, const MapChanges& changes,
                                       const std::vector<MapChanges::Landmark>& repeated) {
  PartWriter writer(header);
  for (const MapChanges::FramePose& frame : changes.frames) writer.Add(frame);
  for (const MapChanges::Landmark& landmark : changes.landmarks) writer.Add(landmark);
  for (const LandmarkId id : changes.removed) writer.Add(id);
  for (const HumanState& human : changes.humans) writer.Add(ToHumanState(human));
  for (const MapChanges::Landmark& landmark : repeated) writer.AddRepeated(landmark);
  return writer.Finish();
}

}  // namespace airdos
