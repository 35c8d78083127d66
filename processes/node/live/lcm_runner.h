#ifndef AIRDOS_PROCESSES_NODE_LIVE_LCM_RUNNER_H_
#define AIRDOS_PROCESSES_NODE_LIVE_LCM_RUNNER_H_

#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <string>

#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/own_output.h"
#include "processes/node/live/process_log.h"
#include "processes/node/live/process_usage.h"
#include "processes/node/live/service_notifier.h"
#include "processes/node/node.h"

namespace airdos {

/// How a process runs its node, whatever the node computes.
struct LcmRunnerOptions {
  /// What a process does that cannot keep up with its source.
  enum class Pace {
    kLockstep,  ///< every frame is worked on; the source waits for FRAME_DONE
    kRealtime,  ///< whoever falls behind goes on with the newest complete frame
  };
  std::string process;  ///< name in STATUS and FRAME_DONE
  Pace pace = Pace::kLockstep;
  /// A frame that lacks inputs for longer is completed without. The frames after it that lack
  /// nothing else do not wait for what comes from outside (a camera, a detector), and a tenth as
  /// long for other processes, which have work to do; until one of those channels speaks again.
  /// While this process stands still, stopped or on a machine that is, no time passes.
  double deadline_s = 5;
  bool publishes_frame_done = false;  ///< says FRAME_DONE after each frame
  std::string notify_socket;          ///< see ServiceNotifier
};

/// Runs one node behind LCM until SIGINT, SIGTERM or SIGHUP: hands in what arrives, publishes what
/// comes out, says STATUS once a second and what the node warns of at once. All knowledge of clocks
/// and of the network is here.
///
/// Each channel has one publisher. Where somebody else speaks on a channel of the node, whoever
/// hears both gets results of two minds: it says so, and after kMaxForeign messages refuses to go
/// on.
class LcmRunner {
 public:
  /// Messages that are taken in at once, in realtime pace, before the next frame is worked on.
  static constexpr int kMaxDrained = 1000;
  /// Messages of somebody else on the node's output channels that end the run.
  static constexpr int kMaxForeign = 3;

  /// None of the pointers is owned.
  LcmRunner(Node* node, LcmTransport* transport, const LcmRunnerOptions& options,
            const ProcessLog* log);

  /// Subscribes; from its return on every message is heard. Throws as LcmTransport does.
  void Start();
  /// Works until StopRequested(), or until it refuses to go on.
  void Run();
  bool has_refused() const { return num_foreign_ >= kMaxForeign; }

 private:
  void Receive(int timeout_ms);
  bool Poll(int timeout_ms);
  bool WorkOnFrames();
  bool WorkOnOne();
  void CompleteAfterDeadline();
  /// How long the oldest frame may wait.
  double Patience_s();
  void NoteSilent(const std::string& channels);
  void PublishOutput();
  void SayFrame(double latency_ms);
  void PublishFrameDone();
  void PublishStatus(std::int8_t state);
  void PublishStatusWhenDue();
  void TellService(std::int8_t state);
  /// Warns, in the log and in STATUS.
  void SayWarning(const std::string& warning);
  void SayWarnings();
  void HearOwnChannel(const std::string& channel, const void* data, std::size_t size);
  /// Another process of the same name?
  void HearStatus(const void* data, std::size_t size);
  bool MustStop() const;
  void SayError(const std::string& error);
  /// Says which channel has rejected a message for the first time, and why.
  void SayFirstRejects();
  void SayCounters();
  template <class Message>
  void Publish(const std::string& channel, const Message& message);
  void PublishBytes(const std::string& channel, const std::vector<std::uint8_t>& bytes);

  Node* node_;
  LcmTransport* transport_;
  LcmRunnerOptions options_;
  const ProcessLog* log_;
  ServiceNotifier service_;

  std::int64_t last_receive_utime_ = 0;
  // When a frame was finished last or none waited; later by how long this process stood still.
  double progress_s_ = 0;
  double next_status_s_ = 0;
  std::set<std::string> silent_said_;   // waiting_for() texts that were said already
  std::set<std::string> rejects_said_;  // channels; later rejects are counted in STATUS only
  std::map<std::string, std::int64_t> silent_;  // channels, and how much had come on them by then
  std::set<std::string> errors_said_;
  int num_warnings_said_ = 0;
  std::deque<std::string> own_warnings_;  // of this runner; the node keeps its own
  OwnOutput own_output_;
  int num_foreign_ = 0;
  std::map<std::int64_t, int> namesakes_;  // how often each was heard, by pid
  bool is_stalled_ = false;
  bool publish_failure_said_ = false;
  std::string last_error_;
  RecentValues latency_ms_{100};         // for STATUS
  RecentValues long_latency_ms_{20000};  // for the last word
  double cpu_at_start_ms_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_LCM_RUNNER_H_
