#ifndef AIRDOS_PROCESSES_STEREO_PLAYER_PLAYER_OPTIONS_H_
#define AIRDOS_PROCESSES_STEREO_PLAYER_PLAYER_OPTIONS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/config/option_table.h"
#include "processes/node/check/input_check.h"
#include "processes/node/live/process_cli.h"
#include "processes/node/live/recording_cli.h"
#include "processes/stereo_player/image_packer.h"
#include "processes/stereo_player/lockstep_gate.h"

namespace airdos {

/// When the next frame is published: as soon as the processes have room for it (see LockstepGate),
/// or at its capture time, like a camera.
enum class PlayerPace { kLockstep, kRealtime };

/// What the player is asked to do.
struct PlayerOptions {
  std::string data;  ///< folder of a data set, or LCM log; empty if there is a recording
  RecordingArguments recording;
  std::int64_t first = 0;
  std::optional<std::int64_t> last;     ///< included; without: the last one there is
  std::optional<std::int64_t> session;  ///< without: the wall clock, us
  int num_loops = 1;                    ///< 0: until stopped; each loop is a session of its own
  bool is_one_session = false;          ///< or not: capture times and image numbers go on
  std::int64_t say_every = 0;           ///< frames; 0: never
  PlayerPace pace = PlayerPace::kLockstep;
  double speed = 1;                  ///< realtime: capture time that passes in a second
  std::vector<std::string> without;  ///< "keypoints", "masks": a detector publishes these
  std::string write_log;             ///< file to write instead of publishing
  LockstepGateOptions gate{{"airdos-optimizer", "airdos-map-recorder"}};
  ImagePackerOptions image;
  InputCheckOptions check;
};

/// launch_scripts/config/stereo_player.yaml: those that are not only on the command line.
OptionTable TableOf(PlayerOptions* options);

/// The command line, and where it says nothing the configuration file.
class PlayerArguments {
 public:
  explicit PlayerArguments(CommandLine* app);
  /// After parsing. Throws InputError.
  PlayerOptions Resolve() const;
  const CommonArguments& common() const { return common_; }

 private:
  InputOptions input_;
  CommonArguments common_;
  PlayerOptions options_;
  std::string pace_ = "lockstep";
  std::string encoding_ = "auto";
  std::optional<std::string> wait_for_;
  std::string without_;
  std::optional<int> frames_in_flight_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_PLAYER_PLAYER_OPTIONS_H_
