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

// The whole chain as real processes, fed with an excerpt of the sample log that a test may spoil,
// and what a test hears of it. Deadlines are for machines under load: no result depends on them.

/// Messages of the sample log's images `first` to `last`, in its order; the calibration of image 0
/// comes first. As a test may change them: see SetHeader() and Erase().
std::vector<LogEvent> SampleEvents(std::int64_t first, std::int64_t last);
void WriteEvents(const std::vector<LogEvent>& events, const std::string& path);
/// Where the sample's camera truly was: T_W_C, W being the camera of image 0.
std::map<std::int64_t, Se3> SampleTruth();

std::int64_t SeqOf(const LogEvent& event);
std::int64_t UtimeOf(const LogEvent& event);
void SetUtime(std::int64_t utime, LogEvent* event);
void SetSession(std::int64_t session, LogEvent* event);

/// Everything that is said on one LCM URL.
class BusListener {
 public:
  using FrameKey = std::pair<std::int64_t, std::int64_t>;  ///< session, seq

  explicit BusListener(const std::string& url);

  /// Listens until the condition holds; false if it does not after `deadline_s`.
  bool HearUntil(const std::function<bool()>& condition, double deadline_s);
  /// Takes in what has been said up to now.
  void Hear();

  /// STATE_ESTIMATE of each frame but those without a pose.
  const std::map<FrameKey, state_estimate_t>& states() const { return states_; }
  std::int64_t num_without_pose() const { return num_without_pose_; }
  /// Newest STATUS of each process, by name.
  const std::map<std::string, process_status_t>& statuses() const { return statuses_; }
  bool IsDone(const std::string& process, const FrameKey& frame) const;
  std::int64_t num_messages(const std::string& channel) const;
  /// Newest image that was published.
  std::int64_t newest_image() const { return newest_image_; }
  /// Most estimates of other images that were heard between an image and its own estimate: how many
  /// frames wait in the chain, whatever time they take.
  std::size_t max_estimates_behind() const { return max_estimates_behind_; }
  /// Of the output channels, one line each: as FormatDigests() of a log.
  std::string digests() const;
  /// People in a frame's HUMAN_OBSERVATIONS; -1 if it was not heard.
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

  /// Results and what the processes say go to `folder`, which must end with a slash and exist.
  LiveChain(std::string folder, std::string url);

  /// Arguments that every program gets when it is started from now on.
  void SetNodeArguments(std::vector<std::string> arguments) {
    node_arguments_ = std::move(arguments);
  }
  /// Runs what is started from now on through this command, such as nsenter of another namespace.
  void SetLauncher(std::vector<std::string> launcher) { launcher_ = std::move(launcher); }

  static const std::vector<std::string>& NodePrograms();
  ChildProcess* Start(const std::string& program, const std::vector<std::string>& arguments);
  /// `frontend`, say, as airdos-frontend; until it is READY. Fails the test if it never is.
  void StartNode(const std::string& node, const std::vector<std::string>& arguments = {});
  void StartNodes();
  ChildProcess* StartPlayer(const std::string& data,
                            const std::vector<std::string>& arguments = {});
  /// Ends the nodes in order, the recorder last; each must end with code 0.
  void StopNodes();
  /// No frame will get a pose that means anything, and the optimizer says so by its exit code.
  void ExpectInVain() { is_in_vain_ = true; }

  ChildProcess* process(const std::string& program) { return processes_.at(program).get(); }
  /// What a process has said since it was started last.
  std::string Errors(const std::string& program) const { return processes_.at(program)->Errors(); }
  std::string AllErrors() const;
  /// How many messages of a channel a process has missed, as it said when it stopped.
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

/// FormatDigests() of what airdos-replay makes of a log.
std::string ReplayDigests(const std::string& log, const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_LIVE_CHAIN_H_
