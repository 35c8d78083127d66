#include "processes/stereo_player/stereo_player.h"

#include <algorithm>
#include <cmath>

#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/pose_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "common/util/error.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/conversions.h"
#include "processes/node/message/header.h"
#include "processes/node/message/keypoint_messages.h"

namespace airdos {
namespace {

constexpr std::int64_t kCalibrationPeriod_us = 1000000;

/// Throws if a receiver would reject the message: the data set is at fault, not the network. `file`
/// is what the message was made from, or empty.
template <class Message>
Envelope Pack(const std::string& channel, const Message& message, const std::string& file) {
  const std::string reason = Validate(message);
  if (!reason.empty()) {
    const std::string frame = "frame " + std::to_string(message.seq) + " for " + channel;
    throw InputError((file.empty() ? frame : file + ": " + frame) + ": " + reason);
  }
  return {channel, Encode(message)};
}

Envelope PackKeypoints(const std::string& channel, const Header& header, KeypointLayout layout,
                       const std::vector<PersonKeypoints>& people, const std::string& file) {
  auto message = MessageOf<person_keypoints_t>(header);
  message.layout = ToMessageLayout(layout);
  message.num_people = static_cast<std::int32_t>(people.size());
  message.num_joints = NumKeypoints(layout);
  for (const PersonKeypoints& person : people) {
    std::vector<float> u_px, v_px, confidence;
    for (const Keypoint& keypoint : person) {
      u_px.push_back(keypoint.u_px);
      v_px.push_back(keypoint.v_px);
      // Some detectors give scores slightly above 1.
      confidence.push_back(std::min(1.0F, std::max(0.0F, keypoint.confidence)));
    }
    message.u_px.push_back(u_px);
    message.v_px.push_back(v_px);
    message.confidence.push_back(confidence);
  }
  return Pack(channel, message, file);
}

Envelope PackMask(const Header& header, const StereoCamera& camera, std::vector<std::uint8_t> file,
                  const std::string& name) {
  auto message = MessageOf<person_mask_t>(header);
  message.encoding = file.empty() ? person_mask_t::ENCODING_NONE : person_mask_t::ENCODING_PNG;
  message.width = camera.width;
  message.height = camera.height;
  message.num_bytes = static_cast<std::int32_t>(file.size());
  message.data = std::move(file);
  return Pack(channel::kPersonMask, message, name);
}

Envelope PackGroundTruth(const Header& header, const Se3& pose, TrajectoryAxes axes) {
  auto message = MessageOf<pose_t>(header);
  message.axes = axes == TrajectoryAxes::kOptical ? pose_t::AXES_OPTICAL
                 : axes == TrajectoryAxes::kNed   ? pose_t::AXES_NED
                                                  : pose_t::AXES_UNKNOWN;
  FromSe3(pose, message.position, message.orientation);
  return Pack(channel::kGroundTruth, message, "");
}

}  // namespace

StereoPlayer::StereoPlayer(const StereoSequence* sequence, std::int64_t session,
                           const ImagePackerOptions& options)
    : sequence_(sequence), session_(session), packer_(options) {}

std::vector<std::string> StereoPlayer::TakeNotes() {
  std::vector<std::string> notes = sequence_->TakeLateNotes();
  for (std::string& note : packer_.TakeNotes()) notes.push_back(std::move(note));
  return notes;
}

bool StereoPlayer::IsCalibrationDue(std::int64_t utime) {
  if (calibration_utime_ && utime >= *calibration_utime_ &&
      utime - *calibration_utime_ < kCalibrationPeriod_us) {
    return false;
  }
  calibration_utime_ = utime;
  return true;
}

void StereoPlayer::SetRangeFor(const std::vector<std::uint8_t>& file) {
  if (is_range_known_) return;
  const std::optional<ImageHeader> header = ReadImageHeader(file.data(), file.size());
  if (!header || header->bits != 16) return;
  packer_.SetSixteenBitRange(FindSixteenBitRange(*sequence_).value_or(SixteenBitRange()));
  is_range_known_ = true;
}

Envelope StereoPlayer::Calibration(const Header& header) const {
  auto message = MessageOf<stereo_calibration_t>(header);
  FromStereoCamera(sequence_->camera(), &message);
  return Pack(channel::kCalibration, message, "");
}

StereoPlayer::Frame StereoPlayer::Load(std::size_t index) {
  std::optional<SequenceFrame> loaded = sequence_->TryLoad(index);
  if (!loaded) return {};
  SequenceFrame& data = *loaded;
  Frame frame;
  frame.header = {data.utime, static_cast<std::int64_t>(index), session_};
  std::vector<Envelope>& messages = frame.messages;
  if (IsCalibrationDue(data.utime)) messages.push_back(Calibration(frame.header));

  const FrameFiles files = sequence_->files(index);
  const auto pack_image = [&](const char* channel, const std::vector<std::uint8_t>& file,
                              const cv::Mat& pixels, const std::string& name) {
    auto message = MessageOf<image_t>(frame.header);
    const std::string where =
        name.empty() ? "frame " + std::to_string(index) + " for " + channel : name;
    if (file.empty() && !pixels.empty()) {
      packer_.Pack(pixels, where, &message);
    } else {
      SetRangeFor(file);
      packer_.Pack(file, where, &message);
    }
    messages.push_back(Pack(channel, message, name));
  };
  pack_image(channel::kCameraLeft, data.left_image_file, data.left_pixels, files.left_image);
  pack_image(channel::kCameraRight, data.right_image_file, data.right_pixels, files.right_image);
  messages.push_back(PackKeypoints(channel::kPersonKeypointsLeft, frame.header,
                                   data.keypoint_layout, data.keypoints_left,
                                   files.keypoints_left));
  messages.push_back(PackKeypoints(channel::kPersonKeypointsRight, frame.header,
                                   data.keypoint_layout, data.keypoints_right,
                                   files.keypoints_right));
  messages.push_back(PackMask(frame.header, sequence_->camera(), std::move(data.person_mask_file),
                              files.person_mask));
  if (data.ground_truth) {
    messages.push_back(
        PackGroundTruth(frame.header, *data.ground_truth, sequence_->ground_truth_axes()));
  }
  return frame;
}

}  // namespace airdos
