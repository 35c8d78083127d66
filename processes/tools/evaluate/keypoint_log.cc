#include "processes/tools/evaluate/keypoint_log.h"

#include "airdos/person_keypoints_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "common/util/error.h"
#include "processes/node/log/event_log.h"
#include "processes/node/log/log_channels.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/conversions.h"
#include "processes/node/message/keypoint_messages.h"
#include "processes/node/message/validate.h"

namespace airdos {
namespace {

template <class Message>
std::optional<Message> DecodeValid(const LogEvent& event) {
  Message message;
  const bool decodes = Decode(event.payload.data(), event.payload.size(), &message);
  if (!decodes || !Validate(message).empty()) return std::nullopt;
  return message;
}

void Take(const LogEvent& event, ImageSide side, KeypointLog* log) {
  const auto message = DecodeValid<person_keypoints_t>(event);
  if (!message) {
    ++log->num_invalid;
    return;
  }
  KeypointLog::Frame& frame = log->frames[{message->session, message->seq}];
  frame.utime = message->utime;
  if (frame.people[side]) {
    ++log->num_again;
  } else {
    frame.people[side] = ToPeople(*message);
  }
}

}  // namespace

KeypointLog ReadKeypointLog(const std::string& path) {
  EventLogReader reader(path);
  LogChannels channels;
  KeypointLog log;
  while (const std::optional<LogEvent> event = reader.Next()) {
    channels.Add(event->channel, event->payload.data(), event->payload.size());
    if (event->channel == channel::kPersonKeypointsLeft) {
      Take(*event, kLeftImage, &log);
    } else if (event->channel == channel::kPersonKeypointsRight) {
      Take(*event, kRightImage, &log);
    } else if (event->channel == channel::kCalibration && !log.camera) {
      const auto message = DecodeValid<stereo_calibration_t>(*event);
      if (message) log.camera = ToStereoCamera(*message);
    }
  }
  log.num_lost = reader.num_lost();
  if (channels.num_messages(channel::kPersonKeypointsLeft) == 0) {
    throw InputError(path + ": " + channels.ExplainMissing(channel::kPersonKeypointsLeft));
  }
  if (log.frames.empty()) throw InputError(path + ": none of its keypoints can be used");
  return log;
}

}  // namespace airdos
