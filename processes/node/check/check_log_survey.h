#ifndef AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_SURVEY_H_
#define AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_SURVEY_H_

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/check/check_findings.h"
#include "common/dataset/stereo_sequence.h"
#include "common/geometry/stereo_camera.h"
#include "processes/node/check/check_log_sizes.h"
#include "processes/node/log/event_log.h"
#include "processes/node/log/log_channels.h"
#include "processes/node/log/log_pairing.h"
#include "processes/node/message/header.h"
#include "processes/node/node.h"

namespace airdos {

/// Surveys the channels of a log in a single pass, message by message, without decoding the images.
/// Report() reports each kind of mistake once per channel, with a count, rather than for each
/// message.
class LogSurvey {
 public:
  using FrameKey = std::pair<std::int64_t, std::int64_t>;  ///< session, seq

  /// A name for a message in findings, such as "LOG: CAMERA_LEFT 17".
  static std::string Where(const std::string& path, const std::string& channel, std::int64_t seq);

  /// Reads the log up to `max_bytes`. Throws InputError if the file is not a log.
  explicit LogSurvey(const std::string& path,
                     std::int64_t max_bytes = std::numeric_limits<std::int64_t>::max());
  /// Reports on types, counts, gaps, partners, sessions, sizes, times and calibration.
  void Report(FindingList* findings) const;

  const std::optional<StereoCamera>& camera() const { return camera_; }
  /// Those of CAMERA_LEFT in the first session.
  const std::vector<FrameKey>& frames() const { return frames_; }
  const std::vector<std::int64_t>& utimes() const { return utimes_; }
  const std::vector<std::optional<Se3>>& ground_truth() const { return ground_truth_; }
  TrajectoryAxes ground_truth_axes() const { return axes_; }

 private:
  /// Larger messages are lost with default receive buffers.
  static constexpr std::size_t kLargeMessageBytes = 128 << 10;

  /// The messages of a channel that share a mistake.
  struct Mistake {
    std::int64_t num = 0;
    std::int64_t first = 0;  // number of the event or image
    std::string text;        // about the first one
    void Add(std::int64_t where, const std::string& what);
  };
  /// What was found on one channel.
  struct Channel {
    std::int64_t num_messages = 0;
    std::int64_t num_large = 0;
    std::size_t max_bytes = 0;
    Mistake rejected;
    Mistake wrong_type;
    std::int64_t num_missing = 0;  // missing numbers
    Mistake gap;
    Mistake repeated;
    Mistake backwards;
    Mistake restarted;            // messages that return to the session's first number
    std::optional<Header> first;  // first header in the last message's session
    std::optional<Header> last;
  };
  /// One session of the log.
  struct Session {
    std::int64_t session = 0;
    std::int64_t first_seq = 0;
    std::int64_t last_seq = 0;
    std::int64_t num_images = 0;
  };

  void Take(const LogEvent& event);
  /// The message if it is valid; otherwise records why it is not.
  template <class Message>
  std::optional<Message> Sound(const LogEvent& event, Channel* channel);
  void TakeHeader(const std::string& name, const Header& header, Channel* channel);
  void TakeLeft(const Header& header);
  void TakeCalibration(const stereo_calibration_t& message);
  void TakeTruth(const pose_t& message);

  void ReportExtent(FindingList* findings) const;
  void ReportMessages(FindingList* findings) const;
  void ReportOrder(const std::string& name, const Channel& channel, FindingList* findings) const;
  void ReportSessions(FindingList* findings) const;
  void ReportCalibration(FindingList* findings) const;
  void ReportAbsent(FindingList* findings) const;

  std::string path_;
  bool is_cut_ = false;
  std::int64_t num_bytes_ = 0;
  std::int64_t num_bytes_read_ = 0;
  LogChannels all_channels_;
  std::map<std::string, Channel> channels_;  // input channels
  LogPairing pairing_;
  LogSizes sizes_;
  std::map<FrameKey, std::int64_t> utime_of_;  // on CAMERA_LEFT
  std::vector<Session> sessions_;              // in order of appearance
  std::vector<FrameKey> frames_;
  std::vector<std::int64_t> utimes_;
  std::map<FrameKey, Se3> truth_of_;
  std::vector<std::optional<Se3>> ground_truth_;
  TrajectoryAxes axes_ = TrajectoryAxes::kUnknown;
  std::optional<StereoCamera> camera_;
  Mistake calibration_changes_;
  std::optional<std::int64_t> images_before_calibration_;
  std::int64_t num_lost_ = 0;
  std::int64_t num_bytes_skipped_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_SURVEY_H_
