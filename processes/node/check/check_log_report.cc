// The report of LogSurvey.
#include <algorithm>

#include "common/check/check_stereo.h"
#include "common/util/words.h"
#include "processes/node/check/check_log.h"
#include "processes/node/check/check_log_survey.h"
#include "processes/node/check/check_log_times.h"
#include "processes/node/message/channels.h"

namespace airdos {
namespace {

constexpr std::size_t kMaxSessionsListed = 5;

std::string Megabytes(std::int64_t num_bytes) { return std::to_string(num_bytes >> 20) + " MB"; }

/// "; so 12 of 50 messages", if there is more than one.
std::string AndMore(std::int64_t num, std::int64_t all) {
  return num == 1 ? "" : "; so " + std::to_string(num) + " of " + std::to_string(all) + " messages";
}

}  // namespace

void LogSurvey::Report(FindingList* findings) const {
  ReportExtent(findings);
  ReportMessages(findings);
  ReportAbsent(findings);
  for (const LogPairing::Remark& remark : pairing_.Remarks(is_cut_)) {
    std::string where = path_ + ": " + remark.channel;
    if (remark.seq) where += " " + std::to_string(*remark.seq);
    findings->Add(remark.is_error ? Severity::kError : Severity::kWarning, remark.kind, where,
                  remark.text);
  }
  ReportSessions(findings);
  sizes_.Report(path_, camera_, findings);
  if (all_channels_.num_messages(channel::kCameraLeft) == 0) return;
  CheckLogTimes(utimes_, path_ + ": CAMERA_LEFT", findings);
  ReportCalibration(findings);
}

void LogSurvey::ReportExtent(FindingList* findings) const {
  if (is_cut_) {
    findings->Note("log.extent", path_,
                   "checked the first " + Megabytes(num_bytes_read_) + " of " +
                       Megabytes(num_bytes_) + "; airdos-check checks all");
  }
  if (num_bytes_skipped_ > 0 || num_lost_ > 0) {
    findings->Fail(kLogDamagedKind, path_,
                   std::to_string(num_bytes_skipped_) + " bytes are damaged, about " +
                       std::to_string(num_lost_) + " events lost");
  }
  const std::string outputs = JoinWords(all_channels_.Outputs(), ", ");
  if (outputs.empty()) return;
  findings->Note("log.outputs", path_,
                 "contains outputs of a run as well (" + outputs +
                     "): play the inputs only into running processes, as replay_log.sh and "
                     "airdos-stereo-player do; airdos-record --inputs-only records no others");
}

void LogSurvey::ReportMessages(FindingList* findings) const {
  for (const auto& [name, channel] : channels_) {
    const std::int64_t all = channel.num_messages;
    const auto at_event = [&](const Mistake& mistake) {
      return path_ + ": event " + std::to_string(mistake.first);
    };
    if (channel.wrong_type.num > 0) {
      findings->Fail("log.type", at_event(channel.wrong_type),
                     "a message on " + name + " " + channel.wrong_type.text +
                         AndMore(channel.wrong_type.num, all));
    }
    if (channel.rejected.num > 0) {
      findings->Fail("log.rejected", at_event(channel.rejected),
                     "a message on " + name + " is rejected: " + channel.rejected.text +
                         AndMore(channel.rejected.num, all));
    }
    if (channel.num_large > 0) {
      findings->Warn("log.size", path_ + ": " + name,
                     std::to_string(channel.num_large) + " messages are larger than " +
                         std::to_string(kLargeMessageBytes >> 10) + " kB (up to " +
                         std::to_string(channel.max_bytes >> 10) +
                         " kB): receivers with default buffers lose them");
    }
    if (!pairing_.HasOneNumber(name)) ReportOrder(name, channel, findings);
  }
}

void LogSurvey::ReportOrder(const std::string& name, const Channel& channel,
                            FindingList* findings) const {
  const std::int64_t all = channel.num_messages;
  if (channel.repeated.num > 0) {
    findings->Warn("log.repeated", Where(path_, name, channel.repeated.first),
                   channel.repeated.text + AndMore(channel.repeated.num, all));
  }
  if (channel.restarted.num > 0) {
    findings->Fail(
        "log.order", Where(path_, name, channel.restarted.first),
        channel.restarted.text +
            ": its session starts again, but a session is processed only once; whatever is "
            "played or started again must take a new session (airdos-stereo-player "
            "--session)");
  }
  if (channel.backwards.num > 0) {
    findings->Fail("log.order", Where(path_, name, channel.backwards.first),
                   channel.backwards.text + AndMore(channel.backwards.num, all));
  }
  if (channel.gap.num > 0) {
    findings->Warn(
        "log.gap", Where(path_, name, channel.gap.first),
        channel.gap.text + (channel.gap.num == 1
                                ? ""
                                : "; in all " + std::to_string(channel.num_missing) + " in " +
                                      std::to_string(channel.gap.num) + " places"));
  }
}

void LogSurvey::ReportSessions(FindingList* findings) const {
  if (sessions_.size() < 2) return;
  std::string text = std::to_string(sessions_.size()) + " sessions, each a separate run:";
  for (std::size_t i = 0; i < std::min(sessions_.size(), kMaxSessionsListed); ++i) {
    const Session& session = sessions_[i];
    text += (i == 0 ? " " : ", ") + std::to_string(session.session) + " with " +
            std::to_string(session.num_images) + " images (" + std::to_string(session.first_seq) +
            " to " + std::to_string(session.last_seq) + ")";
  }
  if (sessions_.size() > kMaxSessionsListed) text += ", …";
  findings->Warn("log.sessions", path_, text + "; pictures of the first are checked");
}

void LogSurvey::ReportCalibration(FindingList* findings) const {
  if (!camera_) {
    findings->Fail("log.calibration", path_,
                   "no usable CALIBRATION: nothing can be measured; publish it once a second" +
                       (all_channels_.LookAlike(channel::kCalibration)
                            ? " (" + *all_channels_.LookAlike(channel::kCalibration) +
                                  " looks like it: channel names must be exact)"
                            : std::string()));
    return;
  }
  if (images_before_calibration_) {
    findings->Warn(
        "log.calibration", path_,
        std::to_string(*images_before_calibration_) + " images come before the first CALIBRATION");
  }
  if (calibration_changes_.num > 0) {
    findings->Warn(
        "log.calibration", Where(path_, channel::kCalibration, calibration_changes_.first),
        calibration_changes_.text +
            AndMore(calibration_changes_.num, channels_.at(channel::kCalibration).num_messages));
  }
}

void LogSurvey::ReportAbsent(FindingList* findings) const {
  const std::int64_t num_left = all_channels_.num_messages(channel::kCameraLeft);
  if (num_left == 0) {
    if (all_channels_.num_messages(channel::kStaticFeatures) > 0) {
      findings->Warn("log.images", path_,
                     "no images, only features (airdos-replay --from-features)");
    } else {
      findings->Fail("log.images", path_, all_channels_.ExplainMissing(channel::kCameraLeft));
    }
    return;
  }
  if (frames_.empty())
    findings->Fail("log.images", path_, "not one message on CAMERA_LEFT can be used");
  for (const std::string& name : InputChannels()) {
    if (name == channel::kCalibration || all_channels_.num_messages(name) > 0) continue;
    const std::optional<std::string> like = all_channels_.LookAlike(name);
    const std::string hint =
        like ? "; " + *like + " looks like it: channel names must be exact" : "";
    const std::string text = "no message, for " + std::to_string(num_left) + " of CAMERA_LEFT";
    if (name == channel::kCameraRight) {
      findings->Fail("log.count", path_ + ": " + name,
                     text + hint + (like ? "" : "; the log contains " + all_channels_.List()));
    } else if (like || name != channel::kGroundTruth) {
      findings->Warn("log.count", path_ + ": " + name, text + hint);
    }
  }
}

}  // namespace airdos
