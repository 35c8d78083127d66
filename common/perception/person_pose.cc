#include "common/perception/person_pose.h"

#include <algorithm>

#include "common/human/layouts.h"

namespace airdos {

BodyKeypoints ToBody(const PersonPose& pose) {
  const std::vector<BodyKeypoint> joints(pose.joints.begin(), pose.joints.end());
  return MapToBody(KeypointLayout::kCoco17, joints).value_or(BodyKeypoints());
}

cv::Rect2d BoxOfJoints(const PersonPose& pose, double min_score) {
  cv::Rect2d box;
  for (const BodyKeypoint& joint : pose.joints) {
    if (joint.confidence < min_score || joint.confidence <= 0) continue;
    // An empty rectangle counts for nothing in a union.
    box |= cv::Rect2d(joint.u_px, joint.v_px, 1e-6, 1e-6);
  }
  return box;
}

void KeepBest(double max_overlap, std::vector<PersonPose>* people) {
  std::stable_sort(people->begin(), people->end(),
                   [](const PersonPose& a, const PersonPose& b) { return a.score > b.score; });
  std::vector<PersonPose> kept;
  for (PersonPose& person : *people) {
    const bool is_again = std::any_of(kept.begin(), kept.end(), [&](const PersonPose& better) {
      const double common = (person.box_px & better.box_px).area();
      const double all = person.box_px.area() + better.box_px.area() - common;
      return common > max_overlap * all;
    });
    if (!is_again) kept.push_back(person);
  }
  *people = std::move(kept);
}

}  // namespace airdos
