#include "processes/node/message/validate.h"

#include <cmath>
#include <cstdint>
#include <sstream>

#include "common/human/skeleton.h"
#include "common/util/image_header.h"
#include "processes/node/message/conversions.h"

namespace airdos {
namespace {

// Far above anything sensible, far below anything harmful.
constexpr double kMaxSeq = 1099511627776.0;          // 2^40
constexpr double kMaxInt64 = 4611686018427387904.0;  // 2^62
constexpr int kMaxImageSize_px = 8192;
constexpr int kMaxPeople = 200;
constexpr int kMaxFeatures = 5000;  // the maximum that frontend.yaml allows
constexpr int kMaxLandmarks = 20000;
constexpr int kMaxParts = 64;
constexpr int kMaxFrames = 1000;
constexpr int kMaxChannels = 100;
constexpr int kMaxWarnings = 100;
constexpr std::size_t kMaxTextBytes = 1000;
constexpr double kMaxPixel = 1e5;
constexpr double kMinSigma_px = 1e-4;  // its inverse square must not dwarf all other weights
constexpr double kMaxLength_m = 1e7;
constexpr double kMaxVariance_m2 = 1e12;
constexpr double kQuaternionTolerance = 1e-3;

/// Records the first reason why a message is invalid.
class Checker {
 public:
  template <class Message>
  explicit Checker(const Message& message) {
    Range("seq", message.seq, 0, kMaxSeq);
    Range("utime", message.utime, 0, kMaxInt64);
  }

  template <class Number>
  void Range(const char* field, Number value, double min, double max) {
    // Negated so that NaN fails.
    if (!(static_cast<double>(value) >= min && static_cast<double>(value) <= max)) {
      Fail(field, value, min, max);
    }
  }
  void Count(const char* field, std::int64_t value, double max) { Range(field, value, 0, max); }
  template <class Numbers>
  void Ranges(const char* field, const Numbers& values, double min, double max) {
    for (const auto value : values) Range(field, value, min, max);
  }
  template <class Numbers>
  void Positive(const char* field, const Numbers& values) {
    for (const auto value : values) {
      if (!(value > 0) || !std::isfinite(value)) Fail(field, value, "must be above 0");
    }
  }
  template <class Rows>
  void Table(const char* field, const Rows& rows, double min, double max) {
    for (const auto& row : rows) Ranges(field, row, min, max);
  }
  template <class Row>
  void Quaternion(const char* field, const Row& wxyz) {
    double squared_norm = 0;
    for (int i = 0; i < 4; ++i) {
      squared_norm += static_cast<double>(wxyz[i]) * static_cast<double>(wxyz[i]);
    }
    const double norm = std::sqrt(squared_norm);
    if (!(std::abs(norm - 1) <= kQuaternionTolerance)) {
      Fail(field, norm, "is its norm and must be 1");
    }
  }
  void Position(const char* field, const double (&position)[3]) {
    for (const double value : position) Range(field, value, -kMaxLength_m, kMaxLength_m);
  }
  /// Ids are in [0, end) and unique.
  template <class Numbers>
  void Ids(const char* field, const Numbers& values, int end) {
    std::uint64_t seen = 0;
    for (const auto value : values) {
      if (value < 0 || value >= end) {
        Fail(field, static_cast<int>(value), 0, end - 1);
        return;
      }
      const std::uint64_t bit = std::uint64_t{1} << static_cast<unsigned>(value);
      if ((seen & bit) != 0) Fail(field, static_cast<int>(value), "comes twice");
      seen |= bit;
    }
  }
  /// A zero byte would end the text early in C, where LCM encodes it.
  void Text(const char* field, const std::string& text) {
    if (text.size() > kMaxTextBytes) Fail(field, text.size(), "letters are too many");
    if (text.find('\0') != std::string::npos) Fail(field, text.size(), "letters with a zero in it");
  }
  void Bytes(std::int64_t num_bytes, std::int64_t expected) {
    if (num_bytes != expected) {
      Fail("num_bytes", num_bytes, "must be " + std::to_string(expected));
    }
  }
  template <class Value>
  void Fail(const char* field, Value value, const std::string& why) {
    if (!reason_.empty()) return;
    std::ostringstream text;
    text << field << " " << +value << " " << why;
    reason_ = text.str();
  }
  const std::string& reason() const { return reason_; }

 private:
  template <class Value>
  void Fail(const char* field, Value value, double min, double max) {
    if (!reason_.empty()) return;
    std::ostringstream why;
    why << "must be between " << min << " and " << max;
    Fail(field, value, why.str());
  }

  std::string reason_;
};

void CheckImageSize(int width, int height, Checker* check) {
  check->Range("width", width, 1, kMaxImageSize_px);
  check->Range("height", height, 1, kMaxImageSize_px);
  check->Range("number of pixels", std::int64_t{width} * height, 1, kMaxImagePixels);
}

void CheckHuman(const human_observation_t& human, Checker* check) {
  check->Count("track_id", human.track_id, kMaxInt64);
  check->Count("num_joints", human.num_joints, kNumJoints);
  check->Ids("joint_id", human.joint_id, kNumJoints);
  for (const auto* pixels :
       {&human.u_left_px, &human.v_left_px, &human.u_right_px, &human.v_right_px}) {
    check->Ranges("joint's pixel", *pixels, -kMaxPixel, kMaxPixel);
  }
  check->Ranges("sigma_px", human.sigma_px, kMinSigma_px, kMaxPixel);
  for (const auto* coordinates : {&human.x_C_m, &human.y_C_m, &human.z_C_m}) {
    check->Ranges("joint's coordinate", *coordinates, -kMaxLength_m, kMaxLength_m);
  }
  for (const auto& row : human.covariance_C) {
    check->Ranges("covariance_C", row, -kMaxVariance_m2, kMaxVariance_m2);
    for (const std::size_t diagonal : {0u, 3u, 5u}) {
      check->Range("covariance_C's diagonal", row[diagonal], 0, kMaxVariance_m2);
    }
  }
}

void CheckHuman(const human_state_t& human, Checker* check) {
  check->Count("track_id", human.track_id, kMaxInt64);
  check->Count("a person's seq", human.seq, kMaxSeq);
  check->Count("a person's utime", human.utime, kMaxInt64);
  check->Count("num_joints", human.num_joints, kNumJoints);
  check->Ids("joint_id", human.joint_id, kNumJoints);
  for (const auto* coordinates : {&human.x_W_m, &human.y_W_m, &human.z_W_m, &human.x_W_measured_m,
                                  &human.y_W_measured_m, &human.z_W_measured_m}) {
    check->Ranges("joint's coordinate", *coordinates, -kMaxLength_m, kMaxLength_m);
  }
  check->Count("num_segments", human.num_segments, kNumSegments);
  check->Ids("segment_id", human.segment_id, kNumSegments);
  check->Positive("length_m", human.length_m);
  check->Count("num_motions", human.num_motions, kNumParts);
  check->Ids("part_id", human.part_id, kNumParts);
  check->Table("translation_m", human.translation_m, -kMaxLength_m, kMaxLength_m);
  for (const auto& rotation : human.rotation) check->Quaternion("rotation", rotation);
}

}  // namespace

std::string Validate(const image_t& message) {
  Checker check(message);
  CheckImageSize(message.width, message.height, &check);
  check.Range("encoding", message.encoding, image_t::ENCODING_JPEG, image_t::ENCODING_RAW_BGR8);
  if (!check.reason().empty()) return check.reason();  // the size in bytes would be undefined
  const std::int64_t num_pixels = std::int64_t{message.width} * message.height;
  if (message.encoding == image_t::ENCODING_RAW_GRAY8) check.Bytes(message.num_bytes, num_pixels);
  if (message.encoding == image_t::ENCODING_RAW_BGR8) {
    check.Bytes(message.num_bytes, 3 * num_pixels);
  }
  check.Range("num_bytes", message.num_bytes, 1, INT32_MAX);
  return check.reason();
}

std::string Validate(const stereo_calibration_t& message) {
  Checker check(message);
  CheckImageSize(message.width, message.height, &check);
  for (const double size_px : {message.fx_px, message.fy_px, message.cx_px, message.cy_px}) {
    check.Range("focal length or principal point", size_px, 0, kMaxPixel);
  }
  check.Range("baseline_m", message.baseline_m, 0, 1000);
  if (!ToStereoCamera(message).IsValid()) {
    check.Fail(
        "fx_px", message.fx_px,
        "and the other numbers are not a camera: all must be above 0 and the principal point "
        "in the image");
  }
  // A field of view of more than 178 degrees, or a baseline of less than a millimetre, is an error.
  check.Range("fx_px", message.fx_px, 0.01 * message.width, kMaxPixel);
  check.Range("fy_px", message.fy_px, 0.01 * message.height, kMaxPixel);
  check.Range("baseline_m", message.baseline_m, 1e-3, 1000);
  return check.reason();
}

std::string Validate(const person_keypoints_t& message) {
  Checker check(message);
  check.Range("layout", message.layout, person_keypoints_t::LAYOUT_COCO18,
              person_keypoints_t::LAYOUT_HALPE26);
  check.Count("num_people", message.num_people, kMaxPeople);
  constexpr int kJointsOfLayout[] = {0, 18, 17, 26};
  // If there are no people, the number of joints means nothing.
  if (check.reason().empty() && message.num_people > 0 &&
      message.num_joints != kJointsOfLayout[message.layout]) {
    check.Fail("num_joints", message.num_joints, "does not agree with the layout");
  }
  check.Table("u_px", message.u_px, -kMaxPixel, kMaxPixel);
  check.Table("v_px", message.v_px, -kMaxPixel, kMaxPixel);
  check.Table("confidence", message.confidence, 0, 1);
  return check.reason();
}

std::string Validate(const person_mask_t& message) {
  Checker check(message);
  check.Range("encoding", message.encoding, person_mask_t::ENCODING_PNG,
              person_mask_t::ENCODING_NONE);
  if (message.encoding == person_mask_t::ENCODING_NONE) {
    check.Bytes(message.num_bytes, 0);
    return check.reason();
  }
  CheckImageSize(message.width, message.height, &check);
  if (message.encoding == person_mask_t::ENCODING_RAW_GRAY8) {
    check.Bytes(message.num_bytes, std::int64_t{message.width} * message.height);
  }
  check.Range("num_bytes", message.num_bytes, 1, INT32_MAX);
  return check.reason();
}

std::string Validate(const static_features_t& message) {
  Checker check(message);
  check.Range("tracking_state", message.tracking_state, static_features_t::STATE_INVALID,
              static_features_t::STATE_COASTING);
  check.Position("position_O_C", message.position_O_C);
  check.Quaternion("orientation_O_C", message.orientation_O_C);
  check.Range("odometry_start_seq", message.odometry_start_seq, 0,
              static_cast<double>(message.seq));
  check.Position("position_W_C", message.position_W_C);
  check.Quaternion("orientation_W_C", message.orientation_W_C);
  check.Range("sigma_position_m", message.sigma_position_m, 0, kMaxLength_m);
  check.Range("sigma_orientation_rad", message.sigma_orientation_rad, 0, 1e3);
  check.Count("num_detected", message.num_detected, INT32_MAX);
  check.Count("num_masked", message.num_masked, INT32_MAX);
  check.Count("num_matched", message.num_matched, INT32_MAX);
  check.Count("num_features", message.num_features, kMaxFeatures);
  if (message.tracking_state == static_features_t::STATE_INVALID && message.num_features > 0) {
    check.Fail("num_features", message.num_features, "must be 0 where nothing was tracked");
  }
  check.Ranges("landmark_id", message.landmark_id, 0, kMaxInt64);
  check.Ranges("u_left_px", message.u_left_px, -kMaxPixel, kMaxPixel);
  check.Ranges("v_px", message.v_px, -kMaxPixel, kMaxPixel);
  for (std::size_t i = 0; i < message.u_right_px.size(); ++i) {
    if (message.has_right[i] == 0) continue;  // then u_right means nothing
    check.Range("u_right_px", message.u_right_px[i], -kMaxPixel, kMaxPixel);
  }
  check.Ranges("has_right", message.has_right, 0, 1);
  check.Ranges("sigma_px", message.sigma_px, kMinSigma_px, kMaxPixel);
  return check.reason();
}

std::string Validate(const human_observations_t& message) {
  Checker check(message);
  check.Count("num_detected_left", message.num_detected_left, INT32_MAX);
  check.Count("num_detected_right", message.num_detected_right, INT32_MAX);
  check.Count("num_rejected", message.num_rejected, INT32_MAX);
  check.Count("num_humans", message.num_humans, kMaxPeople);
  for (const human_observation_t& human : message.humans) CheckHuman(human, &check);
  return check.reason();
}

std::string Validate(const state_estimate_t& message) {
  Checker check(message);
  check.Range("status", message.status, state_estimate_t::STATUS_INVALID,
              state_estimate_t::STATUS_PREDICTED);
  check.Range("trusted", message.trusted, state_estimate_t::TRUSTED_WITHOUT_PEOPLE,
              state_estimate_t::TRUSTED_WITH_PEOPLE);
  check.Position("position_W_C", message.position_W_C);
  check.Position("position_without_people_W_C", message.position_without_people_W_C);
  check.Position("position_with_people_W_C", message.position_with_people_W_C);
  check.Quaternion("orientation_W_C", message.orientation_W_C);
  check.Quaternion("orientation_without_people_W_C", message.orientation_without_people_W_C);
  check.Quaternion("orientation_with_people_W_C", message.orientation_with_people_W_C);
  check.Ranges("covariance", message.covariance, -kMaxVariance_m2, kMaxVariance_m2);
  for (int i = 0; i < 6; ++i) {
    check.Range("covariance's diagonal", message.covariance[7 * i], 0, kMaxVariance_m2);
  }
  for (const int count :
       {message.num_window_frames, message.num_static_landmarks, message.num_static_observations,
        message.num_people, message.num_rigidity_factors, message.num_motion_factors,
        message.num_rigidity_eliminated, message.num_motion_eliminated,
        message.num_reprojection_eliminated, message.num_iterations}) {
    check.Count("a count", count, INT32_MAX);
  }
  check.Range("initial_cost", message.initial_cost, 0, 1e300);
  check.Range("final_cost", message.final_cost, 0, 1e300);
  return check.reason();
}

std::string Validate(const map_update_t& message) {
  Checker check(message);
  check.Range("num_parts", message.num_parts, 1, kMaxParts);
  check.Range("part", message.part, 0, static_cast<double>(message.num_parts) - 1);
  check.Count("num_frames", message.num_frames, kMaxFrames);
  for (const frame_pose_t& frame : message.frames) {
    check.Count("a frame's seq", frame.seq, kMaxSeq);
    check.Count("a frame's utime", frame.utime, kMaxInt64);
    check.Position("a frame's position_W_C", frame.position_W_C);
    check.Quaternion("a frame's orientation_W_C", frame.orientation_W_C);
  }
  check.Count("num_landmarks", message.num_landmarks, kMaxLandmarks);
  check.Ranges("landmark_id", message.landmark_id, 0, kMaxInt64);
  for (const auto* coordinates : {&message.x_W_m, &message.y_W_m, &message.z_W_m}) {
    check.Ranges("landmark's coordinate", *coordinates, -kMaxLength_m, kMaxLength_m);
  }
  check.Positive("sigma_m", message.sigma_m);
  check.Ranges("num_observations", message.num_observations, 0, INT32_MAX);
  check.Count("num_removed", message.num_removed, kMaxLandmarks);
  check.Ranges("removed_landmark_id", message.removed_landmark_id, 0, kMaxInt64);
  check.Count("num_humans", message.num_humans, kMaxPeople);
  for (const human_state_t& human : message.humans) CheckHuman(human, &check);
  check.Count("num_repeated", message.num_repeated, kMaxLandmarks);
  check.Ranges("repeated_landmark_id", message.repeated_landmark_id, 0, kMaxInt64);
  for (const auto* coordinates :
       {&message.repeated_x_W_m, &message.repeated_y_W_m, &message.repeated_z_W_m}) {
    check.Ranges("repeated landmark's coordinate", *coordinates, -kMaxLength_m, kMaxLength_m);
  }
  check.Positive("repeated_sigma_m", message.repeated_sigma_m);
  check.Ranges("repeated_num_observations", message.repeated_num_observations, 0, INT32_MAX);
  return check.reason();
}

std::string Validate(const pose_t& message) {
  Checker check(message);
  check.Range("axes", message.axes, pose_t::AXES_OPTICAL, pose_t::AXES_UNKNOWN);
  check.Position("position", message.position);
  check.Quaternion("orientation", message.orientation);
  return check.reason();
}

std::string Validate(const frame_done_t& message) {
  Checker check(message);
  if (message.process.empty()) check.Fail("process", 0, "letters: it must have a name");
  check.Text("process", message.process);
  return check.reason();
}

std::string Validate(const process_status_t& message) {
  Checker check(message);
  if (message.process.empty()) check.Fail("process", 0, "letters: it must have a name");
  for (const std::string* text : {&message.process, &message.version, &message.types_fingerprint,
                                  &message.waiting_for, &message.last_error}) {
    check.Text("a text", *text);
  }
  check.Range("state", message.state, process_status_t::STATE_STARTING,
              process_status_t::STATE_STOPPING);
  check.Count("pid", message.pid, INT32_MAX);
  for (const std::int64_t count :
       {message.num_frames_done, message.num_frames_incomplete, message.num_frames_skipped}) {
    check.Count("a frame counter", count, kMaxInt64);
  }
  for (const double figure : {message.latency_p50_ms, message.latency_p99_ms,
                              message.cpu_ms_per_frame, message.memory_mb}) {
    check.Range("a latency, load or memory", figure, 0, 1e15);
  }
  check.Count("num_warnings", message.num_warnings, kMaxWarnings);
  for (const std::string& warning : message.warnings) check.Text("a warning", warning);
  check.Count("num_channels", message.num_channels, kMaxChannels);
  for (const channel_status_t& channel : message.channels) {
    check.Text("a channel", channel.channel);
    check.Text("last_reject", channel.last_reject);
    for (const std::int64_t count :
         {channel.num_received, channel.num_missing, channel.num_duplicate, channel.num_rejected}) {
      check.Count("a channel counter", count, kMaxInt64);
    }
  }
  return check.reason();
}

}  // namespace airdos
