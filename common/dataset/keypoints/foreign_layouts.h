#ifndef AIRDOS_COMMON_DATASET_KEYPOINTS_FOREIGN_LAYOUTS_H_
#define AIRDOS_COMMON_DATASET_KEYPOINTS_FOREIGN_LAYOUTS_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// The joint orders of other programs. COCO-WholeBody and BODY_25B begin like COCO-17, Halpe-136
/// like Halpe-26.
enum class ForeignLayout {
  kCoco17,
  kCoco18,
  kBody25,
  kBody25B,
  kHalpe26,
  kWholeBody133,
  kHalpe136
};

/// "COCO-17", for messages.
std::string NameOf(ForeignLayout layout);
int NumJoints(ForeignLayout layout);

/// The layout among `possible` that has `count` numbers a person: u, v (px) and confidence of each
/// joint. Nothing if there is none.
std::optional<ForeignLayout> LayoutOfCount(std::size_t count,
                                           const std::vector<ForeignLayout>& possible);

/// Whether people of 25 joints are in BODY_25B rather than BODY_25, which have as many: most have
/// joints 1 to 4 (eyes and ears there; neck and right arm here) nearer to the nose than 15 to 18
/// (eyes and ears here). Those who show too little of both do not count.
bool AreInBody25B(const std::vector<std::vector<float>>& people);

/// The same person in COCO-18. `numbers`: u, v (px) and confidence of each joint of the layout. A
/// joint that is not finite or whose confidence is not positive is not seen, 0 0 0; a neck that the
/// layout lacks is the middle of the shoulders, with the lower confidence, where both are seen.
/// Confidences stay as they are.
PersonKeypoints ToCoco18(ForeignLayout layout, const std::vector<float>& numbers);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KEYPOINTS_FOREIGN_LAYOUTS_H_
