#include "processes/frontend/frontend_node.h"
#include "processes/node/live/process_main.h"

int main(int argc, char** argv) {
  airdos::ProcessInfo info;
  info.program = "airdos-frontend";
  info.options = airdos::PagesOf<airdos::FrontendOptions>();
  info.description = "Tracks static landmarks in stereo images, without those on people";
  info.make_node = airdos::MakeFrontendNode;
  info.publishes_frame_done = false;
  return airdos::RunNodeProcess(argc, argv, info);
}
