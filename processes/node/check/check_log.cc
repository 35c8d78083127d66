#include "processes/node/check/check_log.h"

#include <limits>
#include <map>
#include <type_traits>
#include <utility>

#include "common/check/check_camera.h"
#include "common/check/check_jpeg.h"
#include "common/check/check_people.h"
#include "common/util/image_header.h"
#include "processes/node/check/check_log_survey.h"
#include "processes/node/log/event_log.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/image_codec.h"
#include "processes/node/message/keypoint_messages.h"
#include "processes/node/message/validate.h"

namespace airdos {
namespace {

// Read before a run starts: takes a second on a slow disk and covers minutes of most recordings.
constexpr std::int64_t kQuickBytes = std::int64_t{200} << 20;

/// The message, if it is valid and of this type; if not, LogSurvey has reported why.
template <class Message>
std::optional<Message> DecodeSound(const LogEvent& event) {
  Message message;
  const bool decodes = Decode(event.payload.data(), event.payload.size(), &message);
  if (!decodes || !Validate(message).empty()) return std::nullopt;
  return message;
}

/// Whether the embedded file has a size other than the message states, or none: LogSizes has
/// reported it.
template <class Message>
bool ContradictsItself(const Message& message) {
  if constexpr (std::is_same_v<Message, image_t>) {
    if (message.encoding != image_t::ENCODING_JPEG && message.encoding != image_t::ENCODING_PNG)
      return false;
  } else {
    if (message.encoding != person_mask_t::ENCODING_PNG) return false;
  }
  const auto header = ReadImageHeader(message.data.data(), message.data.size());
  return !header || header->width != message.width || header->height != message.height;
}

CheckedPeople ToCheckedPeople(const std::string& path, const LogEvent& event,
                              const person_keypoints_t& message) {
  CheckedPeople people;
  people.where = LogSurvey::Where(path, event.channel, message.seq);
  people.layout = LayoutOf(message.layout).value_or(KeypointLayout::kCoco18);
  people.people = ToDetections(message);
  return people;
}

class LogInput : public CheckedInput {
 public:
  LogInput(std::string path, const LogSurvey* survey)
      : path_(std::move(path)), survey_(survey), camera_(*survey->camera()) {}

  std::string name() const override { return path_; }
  const StereoCamera& camera() const override { return camera_; }
  std::string where_camera() const override { return path_ + ": CALIBRATION"; }
  const std::vector<std::int64_t>& utimes() const override { return survey_->utimes(); }
  std::string where_times() const override { return path_ + ": CAMERA_LEFT"; }
  void ReportTimes(FindingList*) const override {}  // done by LogSurvey: utime may have any origin
  const std::vector<std::optional<Se3>>& ground_truth() const override {
    return survey_->ground_truth();
  }
  TrajectoryAxes ground_truth_axes() const override { return survey_->ground_truth_axes(); }
  std::string where_ground_truth() const override { return path_ + ": GROUND_TRUTH"; }

  std::vector<CheckedPictures> Load(const std::vector<std::size_t>& frames,
                                    FindingList* findings) const override {
    std::map<LogSurvey::FrameKey, CheckedPictures> wanted;
    for (const std::size_t frame : frames) wanted[survey_->frames()[frame]];
    EventLogReader reader(path_);
    while (const std::optional<LogEvent> event = reader.Next()) {
      if (!IsInputChannel(event->channel)) continue;
      const auto header = PeekHeader(event->payload.data(), event->payload.size());
      const auto pictures = header ? wanted.find({header->session, header->seq}) : wanted.end();
      if (pictures != wanted.end()) Take(*event, &pictures->second, findings);
    }
    std::vector<CheckedPictures> result;
    for (const std::size_t frame : frames) result.push_back(wanted[survey_->frames()[frame]]);
    return result;
  }

  std::vector<StereoPeople> LoadPeople(const std::vector<std::size_t>& frames) const override {
    std::map<LogSurvey::FrameKey, StereoPeople> wanted;
    for (const std::size_t frame : frames) wanted[survey_->frames()[frame]];
    EventLogReader reader(path_);
    while (const std::optional<LogEvent> event = reader.Next()) {
      const bool is_left = event->channel == channel::kPersonKeypointsLeft;
      if (!is_left && event->channel != channel::kPersonKeypointsRight) continue;
      const auto message = DecodeSound<person_keypoints_t>(*event);
      const auto people = message ? wanted.find({message->session, message->seq}) : wanted.end();
      if (people == wanted.end()) continue;
      (is_left ? people->second.left : people->second.right) =
          ToCheckedPeople(path_, *event, *message);
    }
    std::vector<StereoPeople> result;
    for (const std::size_t frame : frames) result.push_back(wanted[survey_->frames()[frame]]);
    return result;
  }

 private:
  void Take(const LogEvent& event, CheckedPictures* pictures, FindingList* findings) const {
    if (event.channel == channel::kCameraLeft || event.channel == channel::kCameraRight) {
      const auto message = DecodeSound<image_t>(event);
      if (!message || ContradictsItself(*message)) return;
      const bool is_left = event.channel == channel::kCameraLeft;
      const std::string where = LogSurvey::Where(path_, event.channel, message->seq);
      (is_left ? pictures->where_left : pictures->where_right) = where;
      std::string reason;
      const std::optional<cv::Mat> picture = DecodeGray(*message, &reason);
      if (!picture) {
        findings->Fail("images.file", where, reason);
      } else if (HasCameraSize(*picture)) {
        (is_left ? pictures->left : pictures->right) = *picture;
      }
    } else if (event.channel == channel::kPersonMask) {
      const auto message = DecodeSound<person_mask_t>(event);
      if (!message || message->encoding == person_mask_t::ENCODING_NONE) return;
      if (ContradictsItself(*message)) return;
      pictures->where_mask = LogSurvey::Where(path_, event.channel, message->seq);
      std::string reason;
      const std::optional<PersonMask> mask = DecodeMaskMessage(*message, &reason);
      if (!mask) {
        findings->Fail("masks.file", pictures->where_mask, reason);
      } else if (HasCameraSize(mask->pixels)) {
        pictures->mask = *mask;
      }
    } else if (event.channel == channel::kPersonKeypointsLeft) {
      const auto message = DecodeSound<person_keypoints_t>(event);
      if (message) pictures->people_left = ToCheckedPeople(path_, event, *message);
    }
  }

  // If not, LogSizes has reported it.
  bool HasCameraSize(const cv::Mat& picture) const {
    return picture.cols == camera_.width && picture.rows == camera_.height;
  }

  std::string path_;
  const LogSurvey* survey_;
  StereoCamera camera_;
};

/// Checks the keypoints of all images, and how strongly the images were compressed.
void CheckContents(const std::string& path, const StereoCamera& camera, FindingList* findings) {
  std::map<std::string, KeypointCheck> keypoints;
  std::map<std::string, JpegCheck> images;
  EventLogReader reader(path);
  while (const std::optional<LogEvent> event = reader.Next()) {
    const std::string& channel = event->channel;
    if (channel == channel::kPersonKeypointsLeft || channel == channel::kPersonKeypointsRight) {
      const auto message = DecodeSound<person_keypoints_t>(*event);
      if (!message) continue;
      keypoints.try_emplace(channel, camera)
          .first->second.Add(ToCheckedPeople(path, *event, *message), findings);
    } else if (channel == channel::kCameraLeft || channel == channel::kCameraRight) {
      const auto message = DecodeSound<image_t>(*event);
      if (message && message->encoding == image_t::ENCODING_JPEG)
        images[channel].Add(message->data);
    }
  }
  for (const auto& [channel, check] : keypoints) check.Report(path + ": " + channel, findings);
  for (const auto& [channel, check] : images) check.Report(path + ": " + channel, findings);
}

}  // namespace

void CheckLog(const std::string& path, const CheckOptions& options, FindingList* findings) {
  const bool is_quick = options.depth == CheckOptions::Depth::kQuick;
  const LogSurvey survey(path, is_quick ? kQuickBytes : std::numeric_limits<std::int64_t>::max());
  survey.Report(findings);
  if (!survey.camera() || survey.frames().empty()) return;
  if (is_quick) {
    CheckCamera(*survey.camera(), path + ": CALIBRATION", findings);
    return;
  }
  CheckContents(path, *survey.camera(), findings);
  CheckFrames(LogInput(path, &survey), options, findings);
}

}  // namespace airdos
