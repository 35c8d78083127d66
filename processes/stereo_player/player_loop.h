#ifndef AIRDOS_PROCESSES_STEREO_PLAYER_PLAYER_LOOP_H_
#define AIRDOS_PROCESSES_STEREO_PLAYER_PLAYER_LOOP_H_

#include <cstdint>
#include <ostream>
#include <string>

#include "common/dataset/stereo_sequence.h"
#include "processes/node/lcm_transport.h"
#include "processes/stereo_player/lockstep_gate.h"
#include "processes/stereo_player/player_options.h"
#include "processes/stereo_player/stereo_player.h"

namespace airdos {

/// Which frames of the sequence are asked for. Throws InputError where there are none.
struct FrameRange {
  std::size_t first = 0;
  std::size_t last = 0;  ///< included
};
FrameRange RangeOf(const PlayerOptions& options, const StereoSequence& sequence);

/// Writes what the player would publish as an LCM log; the times in it are capture times, so that
/// the same frames give the same file.
void WriteLog(const PlayerOptions& options, const StereoSequence& sequence, std::int64_t session,
              std::ostream* log);

/// Publishes a sequence over LCM, as fast as the other processes are done or as cameras would.
class PlayerLoop {
 public:
  /// Nothing is owned. `log` takes what people are to read, one line each.
  PlayerLoop(const PlayerOptions& options, const StereoSequence* sequence, std::int64_t session,
             LcmTransport* transport, std::ostream* log);

  /// Returns after the last frame is done everywhere, or when StopRequested().
  void Run();

 private:
  void PlayOnce(std::int64_t session);
  void WaitUntilMayPublish();
  void WaitForTime(double due_s);
  void WaitUntilAllDone();
  void PublishFrame(const StereoPlayer::Frame& frame);
  void Publish(const Envelope& message);
  void Listen(int timeout_ms);
  void Say(const std::string& line);
  void SayNotes(StereoPlayer* player);

  PlayerOptions options_;
  const StereoSequence* sequence_;
  std::int64_t session_;
  LcmTransport* transport_;
  std::ostream* log_;
  LockstepGate gate_;
  std::int64_t num_published_ = 0;
  std::int64_t num_not_published_ = 0;  // messages that the network did not take
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_PLAYER_PLAYER_LOOP_H_
