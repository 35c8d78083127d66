#ifndef AIRDOS_COMMON_PERCEPTION_PERSON_POSE_H_
#define AIRDOS_COMMON_PERCEPTION_PERSON_POSE_H_

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "common/human/body_keypoints.h"

namespace airdos {

/// Joints of a detection, in the order of COCO-17: nose, eyes, ears, shoulders, elbows, wrists,
/// hips, knees, ankles, left before right.
inline constexpr int kNumPoseJoints = 17;

/// A person as a network finds one in an image. Pixels of that image; scores 0..1, and 0 for a
/// joint of which nothing is known.
struct PersonPose {
  std::array<BodyKeypoint, kNumPoseJoints> joints;
  double score = 0;
  cv::Rect2d box_px;  ///< around the person; of its joints, if the network gives none
};

/// Finds people in images. Implementations need one thread, and give the same result for the same
/// image.
class PoseNetwork {
 public:
  PoseNetwork() = default;
  virtual ~PoseNetwork() = default;
  PoseNetwork(const PoseNetwork&) = delete;
  PoseNetwork& operator=(const PoseNetwork&) = delete;

  /// The people in an image (CV_8UC3, BGR, not empty), the most certain first. Throws InputError if
  /// the network does not give what its configuration says.
  virtual std::vector<PersonPose> Process(const cv::Mat& bgr) = 0;
};

/// The joints that the body model knows; the neck is the middle of the shoulders.
BodyKeypoints ToBody(const PersonPose& pose);

/// The smallest box around the joints with at least `min_score`; empty if there is none.
cv::Rect2d BoxOfJoints(const PersonPose& pose, double min_score);

/// Sorts people by falling score and drops whoever is another one again: the boxes of a person and
/// of a better one share more than `max_overlap` (area in common / area of both).
void KeepBest(double max_overlap, std::vector<PersonPose>* people);

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_PERSON_POSE_H_
