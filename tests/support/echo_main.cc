#include "processes/node/live/process_main.h"
#include "tests/support/echo_node.h"

int main(int argc, char** argv) {
  airdos::ProcessInfo info;
  info.program = "airdos-echo";
  info.options = airdos::PagesOf<airdos::EchoOptions>();
  info.description = "Says what it received, for tests";
  info.make_node = airdos::MakeEchoNode;
  info.publishes_frame_done = true;
  return airdos::RunNodeProcess(argc, argv, info);
}
