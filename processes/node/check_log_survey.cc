#include "processes/node/check_log_survey.h"

#include <algorithm>
#include <array>

#include "processes/node/channels.h"
#include "processes/node/codec.h"
#include "processes/node/conversions.h"
#include "processes/node/log_source.h"
#include "processes/node/validate.h"

namespace airdos {
namespace {

// Above it default receive buffers lose messages.
constexpr std::size_t kLargeMessageBytes = 128 << 10;

template <class Message>
std::string RejectAs(const LogEvent& event) {
  Message message;
  if (!Decode(event.payload.data(), event.payload.size(), &message)) return "does not decode";
  return Validate(message);
}

TrajectoryAxes ToAxes(int axes) {
  if (axes == pose_t::AXES_OPTICAL) return TrajectoryAxes::kOptical;
  return axes == pose_t::AXES_NED ? TrajectoryAxes::kNed : TrajectoryAxes::kUnknown;
}

}  // namespace

std::string LogSurvey::Where(const std::string& path, const std::string& channel,
                             std::int64_t seq) {
  return path + ": " + channel + " " + std::to_string(seq);
}

LogSurvey::LogSurvey(const std::string& path, FindingList* findings)
    : path_(path), findings_(findings) {
  EventLogReader reader(path);
  while (const std::optional<LogEvent> event = reader.Next()) {
    has_features_ = has_features_ || event->channel == channel::kStaticFeatures;
    if (IsInputChannel(event->channel)) Take(*event);
  }
  num_lost_ = reader.num_lost();
  num_bytes_skipped_ = reader.num_bytes_skipped();
  for (const FrameKey& frame : frames_) {
    const auto truth = truth_of_.find(frame);
    ground_truth_.push_back(truth == truth_of_.end() ? std::nullopt
                                                     : std::make_optional(truth->second));
  }
}

std::string LogSurvey::Reject(const LogEvent& event) {
  if (event.channel == channel::kCalibration) return RejectAs<stereo_calibration_t>(event);
  if (event.channel == channel::kPersonMask) return RejectAs<person_mask_t>(event);
  if (event.channel == channel::kGroundTruth) return RejectAs<pose_t>(event);
  if (event.channel == channel::kPersonKeypointsLeft ||
      event.channel == channel::kPersonKeypointsRight) {
    return RejectAs<person_keypoints_t>(event);
  }
  return RejectAs<image_t>(event);
}

void LogSurvey::Take(const LogEvent& event) {
  Channel& channel = channels_[event.channel];
  ++channel.num_messages;
  channel.max_bytes = std::max(channel.max_bytes, event.payload.size());
  channel.num_large += event.payload.size() > kLargeMessageBytes ? 1 : 0;
  const std::string reject = Reject(event);
  if (!reject.empty()) {
    findings_->Fail("log.rejected", path_ + ": event " + std::to_string(event.number),
                    "a message on " + event.channel + " is rejected: " + reject);
    return;
  }
  const Header header = *PeekHeader(event.payload.data(), event.payload.size());
  if (event.channel == channel::kCalibration) return TakeCalibration(event);
  CheckHeader(event.channel, header);
  channel.last = header;
  const FrameKey key{header.session, header.seq};
  if (event.channel == channel::kGroundTruth) return TakeTruth(event);
  if (event.channel != channel::kCameraLeft) return;
  if (!camera_) images_before_calibration_ = images_before_calibration_.value_or(0) + 1;
  const bool is_new = utime_of_.emplace(key, header.utime).second;
  if (frames_.empty() || frames_.back().first != header.session) ++num_sessions_;
  if (!is_new || (!frames_.empty() && frames_[0].first != header.session)) return;
  frames_.push_back(key);
  utimes_.push_back(header.utime);
}

void LogSurvey::CheckHeader(const std::string& name, const Header& header) {
  Channel& channel = channels_[name];
  const std::string where = Where(path_, name, header.seq);
  if (channel.last && channel.last->session == header.session) {
    const std::int64_t last = channel.last->seq;
    if (header.seq == last) {
      findings_->Warn("log.repeated", where, "comes twice");
    } else if (header.seq < last) {
      findings_->Fail("log.order", where, "comes after number " + std::to_string(last));
    } else if (header.seq > last + 1) {
      channel.num_missing += header.seq - last - 1;
      findings_->Warn("log.gap", where,
                      std::to_string(header.seq - last - 1) + " numbers are missing before it");
    }
  }
  if (name == channel::kCameraLeft || name == channel::kGroundTruth) return;
  const auto left = utime_of_.find({header.session, header.seq});
  if (left == utime_of_.end() || left->second == header.utime) return;
  findings_->Fail("log.utime", where,
                  "has another capture time (" + std::to_string(header.utime) +
                      ") than CAMERA_LEFT of this number (" + std::to_string(left->second) + ")");
}

void LogSurvey::TakeCalibration(const LogEvent& event) {
  stereo_calibration_t message;
  Decode(event.payload.data(), event.payload.size(), &message);
  const StereoCamera camera = ToStereoCamera(message);
  if (!camera_) {
    camera_ = camera;
  } else if (!(*camera_ == camera)) {
    findings_->Warn("log.calibration", Where(path_, event.channel, message.seq),
                    "differs from the first one; only the first of a session holds");
  }
}

void LogSurvey::TakeTruth(const LogEvent& event) {
  pose_t message;
  Decode(event.payload.data(), event.payload.size(), &message);
  axes_ = ToAxes(message.axes);
  truth_of_[{message.session, message.seq}] = ToSe3(message.position, message.orientation);
}

void LogSurvey::Report() const {
  if (num_bytes_skipped_ > 0 || num_lost_ > 0) {
    findings_->Fail("log.damaged", path_,
                    std::to_string(num_bytes_skipped_) + " bytes are damaged, about " +
                        std::to_string(num_lost_) + " events lost");
  }
  for (const auto& [name, channel] : channels_) {
    if (channel.num_large == 0) continue;
    findings_->Warn("log.size", path_ + ": " + name,
                    std::to_string(channel.num_large) + " messages are larger than " +
                        std::to_string(kLargeMessageBytes >> 10) + " kB (up to " +
                        std::to_string(channel.max_bytes >> 10) +
                        " kB): receivers with default buffers lose them");
  }
  if (num_sessions_ > 1) {
    findings_->Warn(
        "log.sessions", path_,
        std::to_string(num_sessions_) + " sessions; pictures of the first are looked at");
  }
  ReportCalibration();
  ReportCounts();
}

void LogSurvey::ReportCalibration() const {
  if (!camera_) {
    findings_->Fail("log.calibration", path_, "no CALIBRATION: nothing can be measured");
  } else if (images_before_calibration_) {
    findings_->Warn(
        "log.calibration", path_,
        std::to_string(*images_before_calibration_) + " images come before the first CALIBRATION");
  }
}

void LogSurvey::ReportCounts() const {
  const auto count = [&](const char* name) {
    const auto it = channels_.find(name);
    return it == channels_.end() ? 0 : it->second.num_messages;
  };
  const std::int64_t num_left = count(channel::kCameraLeft);
  for (const char* name : {channel::kCameraRight, channel::kPersonKeypointsLeft,
                           channel::kPersonKeypointsRight, channel::kPersonMask}) {
    if (count(name) == num_left) continue;
    const std::string text = std::to_string(count(name)) + " messages for " +
                             std::to_string(num_left) + " of CAMERA_LEFT";
    // Without a right image there is nothing; frames without the others wait for them in vain.
    if (name == channel::kCameraRight && count(name) == 0) {
      findings_->Fail("log.count", path_ + ": " + name, text);
    } else {
      findings_->Warn("log.count", path_ + ": " + name, text);
    }
  }
}

}  // namespace airdos
