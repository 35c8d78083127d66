#ifndef AIRDOS_PROCESSES_STEREO_PLAYER_PLAYER_LOOP_H_
#define AIRDOS_PROCESSES_STEREO_PLAYER_PLAYER_LOOP_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "processes/node/live/lag_watch.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/process_log.h"
#include "processes/node/live/service_notifier.h"
#include "processes/node/log/log_source.h"
#include "processes/stereo_player/lockstep_gate.h"
#include "processes/stereo_player/player_options.h"

namespace airdos {

/// Opens what `options` select. `session` is the session of a data set. A log keeps its own
/// sessions unless a session or several loops are requested: then they become `session`, session +
/// 1, … Throws InputError.
std::unique_ptr<FrameSource> OpenPlayerSource(const PlayerOptions& options, std::int64_t session);

/// Writes what the player would publish as an LCM log, stamped with capture times, so that the same
/// frames give the same file.
void WriteLog(const std::string& path, FrameSource* source, const ProcessLog& log);

/// Publishes a source over LCM, as fast as the other processes keep up or at the rate of the
/// cameras.
///
/// In realtime pace, capture times that go back, or ahead by more than kMaxGap_s (a pause in the
/// recording, or damage), are reported and not waited for: the image is published together with the
/// previous one.
class PlayerLoop {
 public:
  static constexpr double kMaxGap_s = 10;  ///< of capture time

  /// Opens the source again after `num_sessions` sessions have been played; the new ones must
  /// differ from these.
  using OpenSource = std::function<std::unique_ptr<FrameSource>(int num_sessions)>;

  /// Neither transport nor log is owned. `notify_socket`: see ServiceNotifier.
  PlayerLoop(const PlayerOptions& options, OpenSource open_source, LcmTransport* transport,
             const ProcessLog* log, const std::string& notify_socket = "");

  /// Returns when the last frame is done everywhere, or on StopRequested().
  void Run();

 private:
  void PlayOnce(FrameSource* source);
  void WaitUntilMayPublish();
  void WaitForTime(const Header& header);
  void WaitUntilAllDone();
  void PublishFrame(const std::vector<Envelope>& messages, const Header& header);
  void Publish(const Envelope& message);
  void Listen(int timeout_ms);
  void TellService();
  void SayNotes(FrameSource* source);

  PlayerOptions options_;
  OpenSource open_source_;
  LcmTransport* transport_;
  const ProcessLog* log_;
  ServiceNotifier service_;
  LockstepGate gate_;
  LagWatch lag_;                         // of realtime pace; in lock-step nobody falls behind
  std::optional<Envelope> calibration_;  // the last one, for processes that start later
  // Realtime pace: when the previous frame was due on our clock, and its capture time.
  std::optional<std::pair<double, std::int64_t>> pace_;
  int num_sessions_ = 0;
  std::optional<std::int64_t> newest_session_;
  int num_jumps_ = 0;
  std::int64_t num_published_ = 0;
  std::int64_t num_not_published_ = 0;  // messages that the network did not accept
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_PLAYER_PLAYER_LOOP_H_
