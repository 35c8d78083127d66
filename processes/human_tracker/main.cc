#include "processes/human_tracker/human_tracker_node.h"
#include "processes/node/live/process_main.h"

int main(int argc, char** argv) {
  airdos::ProcessInfo info;
  info.program = "airdos-human-tracker";
  info.options = airdos::PagesOf<airdos::HumanTrackerOptions>();
  info.description = "Pairs, triangulates and tracks the people in stereo images";
  info.make_node = airdos::MakeHumanTrackerNode;
  info.publishes_frame_done = false;
  return airdos::RunNodeProcess(argc, argv, info);
}
