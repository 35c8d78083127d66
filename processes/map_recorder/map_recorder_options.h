#ifndef AIRDOS_PROCESSES_MAP_RECORDER_MAP_RECORDER_OPTIONS_H_
#define AIRDOS_PROCESSES_MAP_RECORDER_MAP_RECORDER_OPTIONS_H_

#include <cstddef>
#include <functional>
#include <string>

#include "common/config/config_reader.h"
#include "common/config/option_table.h"
#include "common/util/output_folder.h"

namespace airdos {

/// Settings of the MapRecorderNode.
struct MapRecorderOptions {
  std::string directory;      ///< made if it is not there; must be named
  int chunk_frames = 10;      ///< a kill loses at most one chunk
  bool export_at_end = true;  ///< also write the exports of common/map/map_export.h
  // Not in the configuration.
  std::size_t max_ground_truth = 1000000;  ///< poses in memory; further ones are rejected
  OutputRules rules;                       ///< what may be replaced
  /// Takes lines for the user; by default they go to stderr as "map_recorder: ...".
  std::function<void(const std::string&)> say = SayOnStderr;

  static void SayOnStderr(const std::string& line);
};

/// launch_scripts/config/map_recorder.yaml
OptionTable TableOf(MapRecorderOptions* options);

/// Throws InputError naming key and value. Leaves Finish() to the caller.
MapRecorderOptions ReadMapRecorderOptions(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_MAP_RECORDER_MAP_RECORDER_OPTIONS_H_
