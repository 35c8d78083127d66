#ifndef AIRDOS_COMMON_PERCEPTION_POSE_NETWORK_OPTIONS_H_
#define AIRDOS_COMMON_PERCEPTION_POSE_NETWORK_OPTIONS_H_

#include "common/perception/dnn_network.h"
#include "common/perception/network_input.h"

namespace airdos {

/// A network that finds people, whatever its outputs are like.
struct PoseNetworkOptions {
  DnnNetworkOptions network;
  NetworkInputOptions input;
  int short_side_px = 288;   ///< of the input, where it has no fixed size: see ChooseInputSize()
  double min_score = 0.2;    ///< of a person
  double max_overlap = 0.4;  ///< of the boxes of two people, who are the same one beyond it
  int max_people = 60;       ///< in one image, the most certain ones
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_POSE_NETWORK_OPTIONS_H_
