#include "processes/node/check/check_log_survey.h"

#include <algorithm>

#include "common/util/format.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/conversions.h"
#include "processes/node/message/validate.h"

namespace airdos {
namespace {

TrajectoryAxes ToAxes(int axes) {
  if (axes == pose_t::AXES_OPTICAL) return TrajectoryAxes::kOptical;
  return axes == pose_t::AXES_NED ? TrajectoryAxes::kNed : TrajectoryAxes::kUnknown;
}

std::string Hex(std::int64_t fingerprint) {
  return Format("0x%016llx", static_cast<unsigned long long>(fingerprint));
}

template <class Message>
std::string WrongType(std::int64_t fingerprint) {
  const std::string ours = TypeOfFingerprint(fingerprint);
  return "has type " + (ours.empty() ? "fingerprint " + Hex(fingerprint) : ours + " ") +
         (ours.empty() ? "" : "(fingerprint " + Hex(fingerprint) + ")") + ", this build wants " +
         Message::getTypeName() + " (" + Hex(Message::getHash()) + "): " +
         (ours.empty() ? "another type, or another version of it: publish it with the types of "
                         "this build (lcmtypes)"
                       : "publish the right type");
}

}  // namespace

std::string LogSurvey::Where(const std::string& path, const std::string& channel,
                             std::int64_t seq) {
  return path + ": " + channel + " " + std::to_string(seq);
}

void LogSurvey::Mistake::Add(std::int64_t where, const std::string& what) {
  if (num++ > 0) return;
  first = where;
  text = what;
}

LogSurvey::LogSurvey(const std::string& path, std::int64_t max_bytes) : path_(path) {
  EventLogReader reader(path);
  while (const std::optional<LogEvent> event = reader.Next()) {
    all_channels_.Add(event->channel, event->payload.data(), event->payload.size());
    if (IsInputChannel(event->channel)) Take(*event);
    is_cut_ = reader.position_bytes() >= max_bytes && reader.position_bytes() < reader.num_bytes();
    if (is_cut_) break;
  }
  num_bytes_ = reader.num_bytes();
  num_bytes_read_ = reader.position_bytes();
  num_lost_ = reader.num_lost();
  num_bytes_skipped_ = reader.num_bytes_skipped();
  for (const FrameKey& frame : frames_) {
    const auto truth = truth_of_.find(frame);
    ground_truth_.push_back(truth == truth_of_.end() ? std::nullopt
                                                     : std::make_optional(truth->second));
  }
}

template <class Message>
std::optional<Message> LogSurvey::Sound(const LogEvent& event, Channel* channel) {
  const std::uint8_t* data = event.payload.data();
  const std::size_t size = event.payload.size();
  const std::optional<std::int64_t> fingerprint = PeekFingerprint(data, size);
  if (fingerprint && *fingerprint != Message::getHash()) {
    channel->wrong_type.Add(event.number, WrongType<Message>(*fingerprint));
    return std::nullopt;
  }
  Message message;
  std::string reason = "does not decode (" + std::to_string(size) + " bytes)";
  if (Decode(data, size, &message)) reason = Validate(message);
  if (reason.empty()) return message;
  channel->rejected.Add(event.number, reason);
  return std::nullopt;
}

void LogSurvey::Take(const LogEvent& event) {
  const std::string& name = event.channel;
  Channel& channel = channels_[name];
  ++channel.num_messages;
  channel.max_bytes = std::max(channel.max_bytes, event.payload.size());
  channel.num_large += event.payload.size() > kLargeMessageBytes ? 1 : 0;
  if (name == channel::kCalibration) {
    const auto message = Sound<stereo_calibration_t>(event, &channel);
    if (message) TakeCalibration(*message);
  } else if (name == channel::kPersonMask) {
    const auto message = Sound<person_mask_t>(event, &channel);
    if (!message) return;
    TakeHeader(name, HeaderOf(*message), &channel);
    sizes_.Add(name, *message);
  } else if (name == channel::kGroundTruth) {
    const auto message = Sound<pose_t>(event, &channel);
    if (!message) return;
    TakeHeader(name, HeaderOf(*message), &channel);
    TakeTruth(*message);
  } else if (name == channel::kPersonKeypointsLeft || name == channel::kPersonKeypointsRight) {
    const auto message = Sound<person_keypoints_t>(event, &channel);
    if (message) TakeHeader(name, HeaderOf(*message), &channel);
  } else {
    const auto message = Sound<image_t>(event, &channel);
    if (!message) return;
    TakeHeader(name, HeaderOf(*message), &channel);
    if (name == channel::kCameraLeft) TakeLeft(HeaderOf(*message));
    sizes_.Add(name, *message);
  }
}

void LogSurvey::TakeHeader(const std::string& name, const Header& header, Channel* channel) {
  pairing_.Add(name, header);
  if (channel->last && channel->last->session == header.session) {
    const std::int64_t last = channel->last->seq;
    if (header.seq == last) {
      channel->repeated.Add(header.seq, "comes twice");
    } else if (header.seq <= channel->first->seq) {
      channel->restarted.Add(header.seq, "comes after number " + std::to_string(last));
    } else if (header.seq < last) {
      channel->backwards.Add(header.seq, "comes after number " + std::to_string(last));
    } else if (header.seq > last + 1) {
      channel->num_missing += header.seq - last - 1;
      channel->gap.Add(header.seq,
                       std::to_string(header.seq - last - 1) + " numbers are missing before it");
    }
  }
  if (!channel->last || channel->last->session != header.session) channel->first = header;
  channel->last = header;
}

void LogSurvey::TakeLeft(const Header& header) {
  if (!camera_) images_before_calibration_ = images_before_calibration_.value_or(0) + 1;
  const auto is_same = [&](const Session& known) { return known.session == header.session; };
  auto session = std::find_if(sessions_.rbegin(), sessions_.rend(), is_same);
  if (session == sessions_.rend()) {
    sessions_.push_back({header.session, header.seq, header.seq, 0});
    session = sessions_.rbegin();
  }
  session->first_seq = std::min(session->first_seq, header.seq);
  session->last_seq = std::max(session->last_seq, header.seq);
  ++session->num_images;
  const FrameKey key{header.session, header.seq};
  const bool is_new = utime_of_.emplace(key, header.utime).second;
  if (!is_new || sessions_[0].session != header.session) return;
  frames_.push_back(key);
  utimes_.push_back(header.utime);
}

void LogSurvey::TakeCalibration(const stereo_calibration_t& message) {
  const StereoCamera camera = ToStereoCamera(message);
  if (!camera_) {
    camera_ = camera;
  } else if (!(*camera_ == camera)) {
    calibration_changes_.Add(message.seq,
                             "differs from the first one; only the first of a session applies");
  }
}

void LogSurvey::TakeTruth(const pose_t& message) {
  axes_ = ToAxes(message.axes);
  truth_of_[{message.session, message.seq}] = ToSe3(message.position, message.orientation);
}

}  // namespace airdos
