#include "processes/tools/simulate/simulated_log.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "airdos/human_observations_t.hpp"
#include "airdos/pose_t.hpp"
#include "airdos/static_features_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "common/human/skeleton.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/conversions.h"
#include "processes/node/message/header.h"

namespace airdos {
namespace {

constexpr std::int64_t kSession = 1;
constexpr double kLeastSigmaPx = 0.01;

double SigmaPx(const SimulationOptions& options, const Eigen::Vector3d& p_C) {
  const double sigma_px = options.has_point_noise
                              ? options.camera.fx_px * options.point_sigma_m / p_C.z()
                              : options.pixel_sigma_px;
  return std::max(sigma_px, kLeastSigmaPx);
}

Eigen::Matrix3d PointCovariance(const SimulationOptions& options, const Eigen::Vector3d& p_C) {
  if (options.has_point_noise) {
    const double sigma_m = std::max(options.point_sigma_m, 1e-4);
    return sigma_m * sigma_m * Eigen::Matrix3d::Identity();
  }
  return options.camera.TriangulationCovariance(p_C, SigmaPx(options, p_C));
}

Envelope Calibration(const SimulationOptions& options, const Header& header) {
  auto message = MessageOf<stereo_calibration_t>(header);
  FromStereoCamera(options.camera, &message);
  return {channel::kCalibration, Encode(message)};
}

/// Error of the constant-velocity prediction per frame and axis: translation (m) and rotation
/// (rad). What a frontend would have learnt for its carrier, with a margin like ours.
struct CarrierSigma {
  double position_m = 0;
  double orientation_rad = 0;
};

CarrierSigma SigmaOfCarrier(const SimulatedSequence& sequence) {
  constexpr double kGenerosity = 3;
  double linear = 0, angular = 0;
  int num = 0;
  for (std::size_t k = 2; k < sequence.frames.size(); ++k) {
    const Se3& before = sequence.frames[k - 1].T_W_C;
    const Vector6d step = Boxminus(before, sequence.frames[k - 2].T_W_C);
    const Vector6d change = Boxminus(sequence.frames[k].T_W_C, Boxplus(before, step));
    linear += change.head<3>().squaredNorm();
    angular += change.tail<3>().squaredNorm();
    num += 3;
  }
  if (num == 0) return {};
  return {kGenerosity * std::sqrt(linear / num), kGenerosity * std::sqrt(angular / num)};
}

Envelope StaticFeatures(const SimulationOptions& options, const CarrierSigma& carrier,
                        const SimulatedFrame& frame, const Header& header) {
  auto message = MessageOf<static_features_t>(header);
  message.tracking_state =
      header.seq == 0 ? +static_features_t::STATE_INITIALIZING : +static_features_t::STATE_TRACKING;
  FromSe3(frame.T_W_C_odometry, message.position_O_C, message.orientation_O_C);
  FromSe3(frame.T_W_C_odometry, message.position_W_C, message.orientation_W_C);
  message.sigma_position_m = carrier.position_m;
  message.sigma_orientation_rad = carrier.orientation_rad;
  message.num_features = static_cast<std::int32_t>(frame.static_points.size());
  message.num_detected = message.num_matched = message.num_features;
  for (const SimulatedMeasurement& seen : frame.static_points) {
    message.landmark_id.push_back(seen.index);
    message.u_left_px.push_back(static_cast<float>(seen.uvu_px.x()));
    message.v_px.push_back(static_cast<float>(seen.uvu_px.y()));
    message.u_right_px.push_back(static_cast<float>(seen.uvu_px.z()));
    message.has_right.push_back(1);
    message.sigma_px.push_back(static_cast<float>(SigmaPx(options, seen.p_C)));
  }
  return {channel::kStaticFeatures, Encode(message)};
}

void AddJoint(const SimulationOptions& options, const SimulatedMeasurement& seen,
              human_observation_t* human) {
  const auto add = [](double value, std::vector<float>* values) {
    values->push_back(static_cast<float>(value));
  };
  human->joint_id.push_back(static_cast<std::int8_t>(seen.index));
  add(seen.uvu_px.x(), &human->u_left_px);
  add(seen.uvu_px.y(), &human->v_left_px);
  add(seen.uvu_px.z(), &human->u_right_px);
  add(seen.uvu_px.y(), &human->v_right_px);
  add(SigmaPx(options, seen.p_C), &human->sigma_px);
  add(seen.p_C.x(), &human->x_C_m);
  add(seen.p_C.y(), &human->y_C_m);
  add(seen.p_C.z(), &human->z_C_m);
  human->covariance_C.push_back(FromCovariance(PointCovariance(options, seen.p_C)));
  ++human->num_joints;
}

Envelope HumanObservations(const SimulatedSequence& sequence, const SimulatedFrame& frame,
                           const Header& header) {
  std::map<int, human_observation_t> humans;  // by object
  for (const SimulatedMeasurement& seen : frame.object_points) {
    const MovingObject& object = sequence.objects[static_cast<std::size_t>(seen.object)];
    if (!object.is_person || seen.index >= kNumJoints) continue;
    human_observation_t& human = humans[seen.object];
    human.track_id = seen.object + 1;
    AddJoint(sequence.options, seen, &human);
  }
  auto message = MessageOf<human_observations_t>(header);
  for (const auto& [object, human] : humans) message.humans.push_back(human);
  message.num_humans = static_cast<std::int32_t>(humans.size());
  message.num_detected_left = message.num_detected_right = message.num_humans;
  return {channel::kHumanObservations, Encode(message)};
}

Envelope GroundTruth(const SimulatedFrame& frame, const Header& header) {
  auto message = MessageOf<pose_t>(header);
  message.axes = pose_t::AXES_OPTICAL;
  FromSe3(frame.T_W_C, message.position, message.orientation);
  return {channel::kGroundTruth, Encode(message)};
}

}  // namespace

std::vector<std::vector<Envelope>> SimulatedMessages(const SimulatedSequence& sequence,
                                                     std::int64_t session) {
  constexpr std::int64_t kCalibrationPeriod_us = 1000000;
  std::vector<std::vector<Envelope>> frames;
  std::int64_t next_calibration_us = 0;
  const CarrierSigma carrier = SigmaOfCarrier(sequence);
  for (const SimulatedFrame& frame : sequence.frames) {
    const Header header{static_cast<std::int64_t>(std::llround(frame.time_s * 1e6)),
                        static_cast<std::int64_t>(frames.size()), session};
    std::vector<Envelope> messages;
    if (header.utime >= next_calibration_us) {
      messages.push_back(Calibration(sequence.options, header));
      next_calibration_us = header.utime + kCalibrationPeriod_us;
    }
    messages.push_back(StaticFeatures(sequence.options, carrier, frame, header));
    messages.push_back(HumanObservations(sequence, frame, header));
    messages.push_back(GroundTruth(frame, header));
    frames.push_back(std::move(messages));
  }
  return frames;
}

void WriteSimulatedLog(const SimulatedSequence& sequence, const std::string& path) {
  EventLogWriter log(path);
  std::size_t frame = 0;
  for (const std::vector<Envelope>& messages : SimulatedMessages(sequence, kSession)) {
    const auto utime =
        static_cast<std::int64_t>(std::llround(sequence.frames[frame++].time_s * 1e6));
    for (const Envelope& message : messages) {
      log.Append(utime, message.channel, message.payload.data(), message.payload.size());
    }
  }
  log.Sync();
}

}  // namespace airdos
