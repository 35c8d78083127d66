#ifndef AIRDOS_TESTS_SUPPORT_LIVE_CHAIN_H_
#define AIRDOS_TESTS_SUPPORT_LIVE_CHAIN_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "airdos/process_status_t.hpp"
#include "airdos/state_estimate_t.hpp"
#include "common/geometry/se3.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/log/channel_digests.h"
#include "processes/node/log/event_log.h"
#include "tests/support/child_process.h"

namespace airdos {

// The whole chain as real processes, fed with an excerpt of the sample log that a test may corrupt,
// and what a test receives from it. Deadlines allow for machines under load; no result depends on
// them.

/// Messages of the sample log's images `first` to `last`, in its order, preceded by the calibration
/// of image 0. A test may change them: see SetHeader() and Erase().
std::vector<LogEvent> SampleEvents(std::int64_t first, std::int64_t last);
void WriteEvents(const std::vector<LogEvent>& events, const std::string& path);
/// The sample's true camera poses: T_W_C, where W is the camera of image 0.
std::map<std::int64_t, Se3> SampleTruth();

std::int64_t SeqOf(const LogEvent& event);
std::int64_t UtimeOf(const LogEvent& event);
void SetUtime(std::int64_t utime, LogEvent* event);
void SetSession(std::int64_t session, LogEvent* event);

/// Receives everything that is published on one LCM URL.
class BusListener {
 public:
  using FrameKey = std::pair<std::int64_t, std::int64_t>;  ///< (session, seq)

  explicit BusListener(const std::string& url);

  /// Listens until the condition holds; false if it does not within `deadline_s`.
  bool HearUntil(const std::function<bool()>& condition, double deadline_s);
  /// Receives what has been published so far.
  void Hear();

  /// STATE_ESTIMATE of each frame, except those without a pose.
  const std::map<FrameKey, state_estimate_t>& states() const { return states_; }
  std::int64_t num_without_pose() const { return num_without_pose_; }
  /// Newest STATUS of each process, by name.
  const std::map<std::string, process_status_t>& statuses() const { return statuses_; }
  bool IsDone(const std::string& process, const FrameKey& frame) const;
  std::int64_t num_messages(const std::string& channel) const;
  /// Newest image published.
  std::int64_t newest_image() const { return newest_image_; }
  /// Largest number of estimates for other images received between an image and its own estimate:
  /// how many frames wait in the chain, however long they take.
  std::size_t max_estimates_behind() const { return max_estimates_behind_; }
  /// Digests of the output channels, one line each, like FormatDigests() of a log.
  std::string digests() const;
  /// Number of people in a frame's HUMAN_OBSERVATIONS; -1 if it was not received.
  std::int64_t num_people(const FrameKey& frame) const;

 private:
  void OnMessage(const std::string& channel, const void* data, std::size_t size);

  LcmTransport transport_;
  std::map<FrameKey, state_estimate_t> states_;
  std::map<FrameKey, std::int64_t> num_people_;
  std::int64_t num_without_pose_ = 0;
  std::map<std::string, process_status_t> statuses_;
  std::map<std::string, std::set<FrameKey>> done_;
  std::map<std::string, std::int64_t> num_messages_;
  std::int64_t newest_image_ = -1;
  std::map<FrameKey, std::size_t> num_states_at_image_;
  std::size_t max_estimates_behind_ = 0;
  ChannelDigests digests_;
};

/// The processes of a run, in whatever network the test is in. Killed when this goes out of scope.
class LiveChain {
 public:
  static constexpr double kStart_s = 60;
  static constexpr double kRun_s = 300;

  /// Results and output of the processes go to `folder`, which must exist and end with a slash.
  LiveChain(std::string folder, std::string url);

  /// Arguments for every program started from now on.
  void SetNodeArguments(std::vector<std::string> arguments) {
    node_arguments_ = std::move(arguments);
  }
  /// Prefixes programs started from now on with this command, such as nsenter for another
  /// namespace.
  void SetLauncher(std::vector<std::string> launcher) { launcher_ = std::move(launcher); }

  static const std::vector<std::string>& NodePrograms();
  ChildProcess* Start(const std::string& program, const std::vector<std::string>& arguments);
  /// Starts a node, such as `frontend` for airdos-frontend, and waits until it is READY. Fails the
  /// test if it never is.
  void StartNode(const std::string& node, const std::vector<std::string>& arguments = {});
  void StartNodes();
  ChildProcess* StartPlayer(const std::string& data,
                            const std::vector<std::string>& arguments = {});
  /// Stops the nodes in order, the recorder last; each must end with code 0.
  void StopNodes();
  /// No frame will get a meaningful pose, which the optimizer reports by its exit code.
  void ExpectInVain() { is_in_vain_ = true; }

  ChildProcess* process(const std::string& program) { return processes_.at(program).get(); }
  /// The errors that a process has printed since it was last started.
  std::string Errors(const std::string& program) const { return processes_.at(program)->Errors(); }
  std::string AllErrors() const;
  /// Number of messages on a channel that a process has missed, as reported when it stopped.
  std::int64_t NumMissing(const std::string& program, const std::string& channel) const;
  std::string map_path() const { return folder_ + "map/map.airdos"; }
  const std::string& folder() const { return folder_; }

 private:
  bool is_in_vain_ = false;
  std::string folder_;
  std::string url_;
  std::vector<std::string> node_arguments_;
  std::vector<std::string> launcher_;
  std::map<std::string, std::unique_ptr<ChildProcess>> processes_;
};

/// FormatDigests() of airdos-replay's output for a log.
std::string ReplayDigests(const std::string& log, const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_LIVE_CHAIN_H_
