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

struct LogRecorderOptions {
  std::string path;
  std::string channels = ".*";  ///< regular expression (ECMAScript) of whole names
  bool inputs_only = false;     ///< of these, only what comes from outside (IsInputChannel)
  double flush_s = 1;           ///< the disk is told to keep what came once in this time
  bool replaces_file = false;   ///< otherwise a file that exists already is bad input
};

/// Writes what arrives into an event log and counts it. Knows no network and no clock.
class LogRecorder {
 public:
  /// Channels that are counted, each by its name; further ones together, as kOtherChannels. STATUS
  /// holds no more.
  static constexpr std::size_t kMaxChannels = 90;
  static constexpr char kOtherChannels[] = "(others)";

  /// Throws InputError if the file cannot be created (or is there already), or for a wrong regular
  /// expression.
  explicit LogRecorder(const LogRecorderOptions& options);

  /// Throws WriteError, also where the disk has hardly any room left. LCM's own LCM_SELF_TEST is
  /// left out, and so is what no log can hold.
  void Take(const std::string& channel, const void* data, std::size_t size,
            std::int64_t receive_utime);
  void Sync() { writer_.Sync(); }

  /// What was taken of each channel. num_missing counts gaps of `seq` within a session, on channels
  /// that carry every image; numbers more than FrameJoiner::kMaxAhead ahead are nonsense.
  const std::map<std::string, ChannelCounters>& channels() const { return channels_; }
  std::int64_t num_events() const { return writer_.num_events(); }
  /// One line a channel and one for all.
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
  std::size_t num_bytes_unchecked_ = 0;  // since the disk was asked how much room it has
};

/// Records until StopRequested(), and says STATUS once a second, so that a source can wait for the
/// recorder. `out` takes the line that says READY, and what came at the end. Returns the exit code:
/// 1 if the log could not be written to its end (said once in `log`).
int RunLogRecorder(LcmTransport* transport, const LogRecorderOptions& options, std::ostream* out,
                   const ProcessLog& log, ServiceNotifier* service);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_LOG_RECORDER_H_
