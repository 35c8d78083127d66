#ifndef AIRDOS_PROCESSES_TOOLS_REPLAY_SETUP_H_
#define AIRDOS_PROCESSES_TOOLS_REPLAY_SETUP_H_

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "processes/node/log_source.h"
#include "processes/tools/replay.h"

namespace airdos {

/// What the options of airdos-replay say about the four processes.
struct ReplaySetup {
  std::string config_dir;              ///< folder with <process>.yaml
  std::string run_dir;                 ///< for the map recorder's files and the resolved
                                       ///< configurations; empty: as map_recorder.yaml says
  std::string people;                  ///< "off", "mask_only", "on"; empty: as configured
  std::string masks;                   ///< "off", "on"; empty: as configured or as `people` says
  std::vector<std::string> overrides;  ///< "process:section.key=value", the last word
  bool from_features = false;          ///< optimizer and map recorder alone, on a log of features
};

/// The four nodes (or the last two), each configured as its process would be. Throws InputError for
/// a wrong file, key or value; creates run_dir and writes <process>.yaml, the configuration in
/// force, into it.
std::vector<ReplayNode> MakeReplayNodes(const ReplaySetup& setup);

/// A log, or a folder with a data set, whose frames are published as airdos-stereo-player would.
/// Only frames with first <= seq <= last. `inputs` is about logs. Throws InputError.
std::unique_ptr<FrameSource> OpenFrameSource(
    const std::string& path, std::int64_t first = std::numeric_limits<std::int64_t>::min(),
    std::int64_t last = std::numeric_limits<std::int64_t>::max(),
    LogInputs inputs = LogInputs::kImages);

/// Says on stderr how far a run is: a bar on a terminal, else one line every ten per cent.
class ProgressBar {
 public:
  ProgressBar();
  void Show(double fraction_done);

 private:
  bool is_terminal_;
  int last_percent_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_REPLAY_SETUP_H_
