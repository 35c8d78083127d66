#ifndef AIRDOS_COMMON_PERCEPTION_SIMCC_POSE_H_
#define AIRDOS_COMMON_PERCEPTION_SIMCC_POSE_H_

#include <memory>
#include <vector>

#include "common/perception/person_pose.h"
#include "common/perception/pose_network_options.h"

namespace airdos {

/// Networks that look at one person at a time and say of each joint how likely each column and each
/// row is (SimCC, as RTMPose has it). Another network finds the boxes of the people. Each box,
/// widened to the input's shape and by a quarter, becomes the input; the outputs are two lists,
/// 1 x joints x (columns * ratio) and 1 x joints x (rows * ratio), with COCO-17 as the first
/// joints. A joint is where both are largest, with the lower of these two values as its score.
class SimccPose : public PoseNetwork {
 public:
  /// Throws InputError if the file cannot be used, or if the input has no size.
  SimccPose(const PoseNetworkOptions& options, std::unique_ptr<PoseNetwork> boxes);

  std::vector<PersonPose> Process(const cv::Mat& bgr) override;

 private:
  /// Sets the joints of a person by his box.
  void FindJoints(const cv::Mat& bgr, PersonPose* person);

  PoseNetworkOptions options_;
  DnnNetwork net_;
  std::unique_ptr<PoseNetwork> boxes_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_SIMCC_POSE_H_
