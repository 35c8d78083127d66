#include "processes/map_recorder/map_recorder_options.h"

namespace airdos {

OptionTable TableOf(MapRecorderOptions* options) {
  OptionTable table("map_recorder", "airdos-map-recorder: what it keeps, and where.");
  table.AddSection("output");
  table.Add("output.directory", &options->directory,
            "folder of the map, its exports and this configuration as it was in force; made if it "
            "is not there. Whoever starts the recorder names it (--run-dir); without a folder "
            "airdos-replay records no map");
  table.Add("output.chunk_frames", &options->chunk_frames, {1, 1000}, "frames",
            "length of a chunk; a kill -9 loses at most the last one");
  table.Add("output.export_at_end", &options->export_at_end,
            "at the end also write trajectories, map.ply and people from the map (airdos-map "
            "export does it later)");
  return table;
}

MapRecorderOptions ReadMapRecorderOptions(ConfigReader* config) {
  return ReadOptions<MapRecorderOptions>(config);
}

}  // namespace airdos
