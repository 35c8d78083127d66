#ifndef AIRDOS_PROCESSES_TOOLS_REPLAY_REPLAY_SETUP_H_
#define AIRDOS_PROCESSES_TOOLS_REPLAY_REPLAY_SETUP_H_

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/util/output_files.h"
#include "processes/node/live/recording_cli.h"
#include "processes/node/log/log_source.h"
#include "processes/tools/replay/replay.h"

namespace airdos {

/// What the options of airdos-replay specify for the four processes.
struct ReplaySetup {
  std::string config_dir;   ///< folder with <process>.yaml
  std::string config_file;  ///< one process' file by its name, <process>.yaml; may be empty
  std::string run_dir;      ///< for the map recorder's files and the resolved configurations;
                            ///< empty: no map is recorded (unless `overrides` names a folder)
  std::string people;       ///< "off", "mask_only", "on"; empty: as configured
  std::string masks;        ///< "off", "on"; empty: as configured or as `people` says
  /// Overrides, applied last: "process:section.key=value", or without process if only one has
  /// the key.
  std::vector<std::string> overrides;
  bool detects = false;        ///< the person detector runs, too; the source must not speak for it
  bool from_features = false;  ///< only optimizer and map recorder, on a log of features
  /// What is read besides the configurations, and what may be replaced.
  OutputRules rules;
  /// Other files that will be written; those in the recorder's folder belong to its results.
  std::vector<std::string> outputs;
};

/// Applies --config: a folder with <process>.yaml, or the file of one process, recognised by its
/// name (the others then come from `config_dir`). Throws InputError.
void SetConfig(const std::string& path, ReplaySetup* setup);

/// The nodes of a replay, each configured like its process: all four, or the last two; the map
/// recorder only if a folder for its results is given. They must not be used after this object is
/// gone.
struct ReplayNodes {
  std::vector<ReplayNode> nodes;
  std::unique_ptr<OutputFiles> outputs;  ///< those of the setup outside the recorder's folder
};

/// Throws InputError for a wrong file, key or value, and if something must not be written; nothing
/// has been written then. Creates run_dir and writes the resolved configuration to it, as
/// <process>.yaml.
ReplayNodes PrepareReplay(const ReplaySetup& setup);

/// Only the nodes.
std::vector<ReplayNode> MakeReplayNodes(const ReplaySetup& setup);

/// Opens a log, or a folder with a data set, whose frames are published as by airdos-stereo-player.
/// Only frames with first <= seq <= last. `inputs` applies to logs, `calibration` to folders
/// (SequenceOptions). Throws InputError.
std::unique_ptr<FrameSource> OpenFrameSource(
    const std::string& path, std::int64_t first = std::numeric_limits<std::int64_t>::min(),
    std::int64_t last = std::numeric_limits<std::int64_t>::max(),
    LogInputs inputs = LogInputs::kImages, const std::string& calibration = "");
/// The same of a recording.
std::unique_ptr<FrameSource> OpenRecordingSource(const RecordingArguments& recording,
                                                 std::int64_t first, std::int64_t last);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_REPLAY_REPLAY_SETUP_H_
