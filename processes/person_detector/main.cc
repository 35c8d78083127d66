#include "processes/node/live/process_main.h"
#include "processes/person_detector/person_detector_node.h"

int main(int argc, char** argv) {
  airdos::ProcessInfo info;
  info.program = "airdos-person-detector";
  info.options = airdos::PagesOf<airdos::PersonDetectorOptions>();
  info.description = "Finds people in stereo images: their joints and masks";
  info.make_node = airdos::MakePersonDetectorNode;
  info.publishes_frame_done = false;
  return airdos::RunNodeProcess(argc, argv, info);
}
