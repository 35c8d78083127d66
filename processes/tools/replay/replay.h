#ifndef AIRDOS_PROCESSES_TOOLS_REPLAY_REPLAY_H_
#define AIRDOS_PROCESSES_TOOLS_REPLAY_REPLAY_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "processes/node/log/channel_digests.h"
#include "processes/node/log/log_source.h"
#include "processes/node/node.h"
#include "processes/node/run_tally.h"

namespace airdos {

/// A node and the channels that it publishes.
struct ReplayNode {
  std::unique_ptr<Node> node;
  std::vector<std::string> publishes;  ///< its output channels
};

/// What Replay() writes, and how it runs.
struct ReplayOptions {
  std::string out_path;                     ///< log of what the nodes publish; empty for none
  bool writes_inputs = false;               ///< whether it includes the inputs
  bool is_parallel = false;                 ///< one thread per node; results are the same
  std::function<void(double)> on_progress;  ///< called after each frame with 0..1; may be empty
  /// Called with what the source notes and the nodes warn of ("frontend: warning: …") while it is
  /// not too late to stop; always by the calling thread; may be empty. ReplayResult::remarks has
  /// these as well.
  std::function<void(const std::string&)> on_remark;
};

/// The time that one node took for each of its frames, including the time spent on receiving; CPU
/// time is that of its thread.
struct NodeTiming {
  std::vector<double> wall_ms;
  std::vector<double> cpu_ms;
};

/// The result of a replay.
struct ReplayResult {
  std::int64_t num_frames = 0;  ///< images in the source: distinct (session, seq)
  std::int64_t num_posed = 0;   ///< of these, those whose STATE_ESTIMATE has a pose
  RunTally::Counts tally;       ///< where the poses came from
  std::int64_t num_events = 0;  ///< in the output log
  double wall_s = 0;            ///< from the first frame to the last, including Finish()
  std::string log_sha256;       ///< of the output log, as printed by sha256sum; empty if none
  std::map<std::string, ChannelDigests::Entry> digests;  ///< of each output channel
  std::map<std::string, NodeTiming> timing;              ///< by name of the node
  std::vector<std::string> remarks;  ///< anything rejected, incomplete or damaged
};

/// Runs all nodes in this process on the frames of `source`, as fast as the machine allows. Event
/// numbers and timestamps (the utime of the frame that a message belongs to) depend on the input
/// alone, so two runs write the same bytes, with one thread or several. Throws WriteError, and
/// InputError if the source does; the output log then contains what had been published by then.
ReplayResult Replay(FrameSource* source, const std::vector<ReplayNode>& nodes,
                    const ReplayOptions& options);

/// Digests of the output channels of any log.
std::map<std::string, ChannelDigests::Entry> DigestLog(const std::string& path);

/// One line per channel: name, number of messages, digest.
std::string FormatDigests(const std::map<std::string, ChannelDigests::Entry>& digests);
/// Frames, ms per frame of each process, digests and remarks, as text.
std::string FormatSummary(const ReplayResult& result);
/// Writes the times per process, and the peak memory of this process, as JSON. Throws InputError if
/// the file cannot be written.
void WriteTiming(const ReplayResult& result, const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_REPLAY_REPLAY_H_
