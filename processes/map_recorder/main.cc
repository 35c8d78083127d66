#include "processes/map_recorder/map_recorder_node.h"
#include "processes/node/process_main.h"

int main(int argc, char** argv) {
  airdos::ProcessInfo info;
  info.program = "airdos-map-recorder";
  info.config_name = "map_recorder";
  info.description = "Records trajectory, people and map into a crash-safe file";
  info.make_node = airdos::MakeMapRecorderNode;
  info.publishes_frame_done = true;
  return airdos::RunNodeProcess(argc, argv, info);
}
