#ifndef AIRDOS_COMMON_PERCEPTION_YOLO_POSE_H_
#define AIRDOS_COMMON_PERCEPTION_YOLO_POSE_H_

#include <vector>

#include "common/perception/person_pose.h"
#include "common/perception/pose_network_options.h"

namespace airdos {

/// Networks of the YOLO family, with or without joints. Their one output is a list of candidates,
/// as 1 x columns x candidates or 1 x candidates x columns, in pixels of the input:
///
/// | columns | what stands in one |
/// |---|---|
/// | 56 | middle u, v, width, height, score, 17 times u, v, score of a joint |
/// | 57 | the same with two scores, to be multiplied (object, person) |
/// | 5, 84 | box as above, scores of the classes, of which the first is a person |
/// | 6, 85 | box, score of an object, scores of the classes |
///
/// From lists without joints come people with a box only, for networks that look at one person.
class YoloPose : public PoseNetwork {
 public:
  /// Throws InputError if the file cannot be used.
  explicit YoloPose(const PoseNetworkOptions& options) : options_(options), net_(options.network) {}

  std::vector<PersonPose> Process(const cv::Mat& bgr) override;

 private:
  PoseNetworkOptions options_;
  DnnNetwork net_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_YOLO_POSE_H_
