#ifndef AIRDOS_PROCESSES_NODE_CHECK_LOG_SURVEY_H_
#define AIRDOS_PROCESSES_NODE_CHECK_LOG_SURVEY_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/check/check_findings.h"
#include "common/dataset/stereo_sequence.h"
#include "common/geometry/stereo_camera.h"
#include "processes/node/event_log.h"
#include "processes/node/header.h"

namespace airdos {

/// What one reading of a log says of its input channels, message by message: the images themselves
/// are not decoded. Findings are made on the way and by Report().
class LogSurvey {
 public:
  using FrameKey = std::pair<std::int64_t, std::int64_t>;  ///< session, seq

  /// A name for a message in findings: "LOG: CAMERA_LEFT 17".
  static std::string Where(const std::string& path, const std::string& channel, std::int64_t seq);

  LogSurvey(const std::string& path, FindingList* findings);
  /// Counts, gaps, sizes, calibration.
  void Report() const;

  const std::optional<StereoCamera>& camera() const { return camera_; }
  /// Of CAMERA_LEFT, first session.
  const std::vector<FrameKey>& frames() const { return frames_; }
  const std::vector<std::int64_t>& utimes() const { return utimes_; }
  const std::vector<std::optional<Se3>>& ground_truth() const { return ground_truth_; }
  TrajectoryAxes ground_truth_axes() const { return axes_; }
  bool has_features() const { return has_features_; }

 private:
  struct Channel {
    std::int64_t num_messages = 0;
    std::int64_t num_missing = 0;  // numbers left out
    std::int64_t num_large = 0;
    std::size_t max_bytes = 0;
    std::optional<Header> last;
  };

  void Take(const LogEvent& event);
  void CheckHeader(const std::string& channel, const Header& header);
  void TakeCalibration(const LogEvent& event);
  void TakeTruth(const LogEvent& event);
  /// Why it does not decode or makes no sense; empty if it is sound.
  static std::string Reject(const LogEvent& event);
  void ReportCalibration() const;
  void ReportCounts() const;

  std::string path_;
  FindingList* findings_;
  std::map<std::string, Channel> channels_;
  std::map<FrameKey, std::int64_t> utime_of_;  // of CAMERA_LEFT
  std::vector<FrameKey> frames_;
  std::vector<std::int64_t> utimes_;
  std::map<FrameKey, Se3> truth_of_;
  std::vector<std::optional<Se3>> ground_truth_;
  TrajectoryAxes axes_ = TrajectoryAxes::kUnknown;
  std::optional<StereoCamera> camera_;
  std::optional<std::int64_t> images_before_calibration_;
  std::int64_t num_lost_ = 0;
  std::int64_t num_bytes_skipped_ = 0;
  int num_sessions_ = 0;
  bool has_features_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CHECK_LOG_SURVEY_H_
