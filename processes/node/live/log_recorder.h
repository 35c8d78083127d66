#ifndef AIRDOS_PROCESSES_NODE_LIVE_LOG_RECORDER_H_
#define AIRDOS_PROCESSES_NODE_LIVE_LOG_RECORDER_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <ostream>
#include <regex>
#include <string>

#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/process_log.h"
#include "processes/node/live/service_notifier.h"
#include "processes/node/log/event_log.h"
#include "processes/node/node.h"

namespace airdos {

/// What is recorded, and where.
struct LogRecorderOptions {
  std::string path;
  std::string channels = ".*";  ///< regular expression (ECMAScript) of whole names
  bool inputs_only = false;     ///< of these, only what comes from outside (IsInputChannel)
  double flush_s = 1;           ///< how often what came is forced to disk
  bool replaces_file = false;   ///< otherwise a file that exists already is bad input
};

/// Writes arriving messages to an event log and counts them. Knows neither network nor clock.
class LogRecorder {
 public:
  /// Number of channels that are counted under their own names; further ones are counted together
  /// as kOtherChannels. STATUS has no room for more.
  static constexpr std::size_t kMaxChannels = 90;
  static constexpr char kOtherChannels[] = "(others)";

  /// Throws InputError if the file cannot be created (or already exists), or if the regular
  /// expression is invalid.
  explicit LogRecorder(const LogRecorderOptions& options);

  /// Throws WriteError, including when the disk is nearly full. Skips LCM's own LCM_SELF_TEST and
  /// whatever a log cannot hold.
  void Take(const std::string& channel, const void* data, std::size_t size,
            std::int64_t receive_utime);
  void Sync() { writer_.Sync(); }

  /// What was recorded, by channel. num_missing counts gaps of `seq` within a session on channels
  /// that carry every image; numbers more than FrameJoiner::kMaxAhead ahead are considered invalid.
  const std::map<std::string, ChannelCounters>& channels() const { return channels_; }
  std::int64_t num_events() const { return writer_.num_events(); }
  /// One line per channel and one for the total.
  std::string Summary() const;

 private:
  ChannelCounters& CountersOf(const std::string& channel);
  void CheckDisk(std::size_t num_bytes);
  void CountGap(const std::string& channel, const void* data, std::size_t size);

  LogRecorderOptions options_;
  std::regex pattern_;
  EventLogWriter writer_;
  std::map<std::string, ChannelCounters> channels_;
  std::map<std::string, Header> newest_;
  std::int64_t num_rejected_ = 0;
  std::size_t num_bytes_unchecked_ = 0;  // since the free disk space was last checked
};

/// Records until StopRequested() and publishes STATUS once a second, so that a source can wait for
/// the recorder. `out` receives the line that says READY, and the summary at the end. Returns the
/// exit code: 1 if the log could not be written completely (reported once in `log`).
int RunLogRecorder(LcmTransport* transport, const LogRecorderOptions& options, std::ostream* out,
                   const ProcessLog& log, ServiceNotifier* service);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_LOG_RECORDER_H_
