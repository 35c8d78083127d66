#include "processes/node/live/process_main.h"
#include "processes/optimizer/optimizer_node.h"

int main(int argc, char** argv) {
  airdos::ProcessInfo info;
  info.program = "airdos-optimizer";
  info.options = airdos::PagesOf<airdos::OptimizerOptions>();
  info.description = "Bundle adjustment of camera, static landmarks and people";
  info.make_node = airdos::MakeOptimizerNode;
  info.publishes_frame_done = true;
  return airdos::RunNodeProcess(argc, argv, info);
}
