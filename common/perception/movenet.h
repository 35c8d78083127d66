#ifndef AIRDOS_COMMON_PERCEPTION_MOVENET_H_
#define AIRDOS_COMMON_PERCEPTION_MOVENET_H_

#include <vector>

#include "common/perception/person_pose.h"
#include "common/perception/pose_network_options.h"

namespace airdos {

/// Networks with the heads of MoveNet MultiPose. On a grid with cells of 4 px of the input, there
/// are, as outputs in this order, each as 1 x channels x rows x columns (or the channels at last):
///
/// 1. centre, 1 channel: the logit c of a person whose middle is here
/// 2. heatmaps, 17 channels: the logit h_j of joint j being here
/// 3. regression, 34 channels: (rows, columns) from a person's middle to joint j
/// 4. offsets, 34 channels: (rows, columns) from a cell to the joint j in it
///
/// A person is a cell p that has the largest c within 5 x 5 cells, with sigmoid(c(p)) as the
/// score. His joint j is in the cell
///
// clang-format off
///   q = argmax sigmoid(h_j(q)) exp(-|q - p - regression_j(p)|^2 / (0.3 min(rows, columns))),
// clang-format on
///
/// at q + offset_j(q), with the score sigmoid(h_j(q)).
class MoveNet : public PoseNetwork {
 public:
  /// Throws InputError if the file cannot be used, or if four outputs are not named.
  explicit MoveNet(const PoseNetworkOptions& options);

  std::vector<PersonPose> Process(const cv::Mat& bgr) override;

 private:
  PoseNetworkOptions options_;
  DnnNetwork net_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_MOVENET_H_
