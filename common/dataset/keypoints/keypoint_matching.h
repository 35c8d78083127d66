#ifndef AIRDOS_COMMON_DATASET_KEYPOINTS_KEYPOINT_MATCHING_H_
#define AIRDOS_COMMON_DATASET_KEYPOINTS_KEYPOINT_MATCHING_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/dataset/keypoints/foreign_keypoints.h"

namespace airdos {

/// Which image of another program belongs to which of ours.
struct KeypointMatching {
  std::vector<std::optional<std::size_t>> image_of;  ///< for each of ours, its index among theirs
  std::vector<std::string> notes;
};

/// By name without folder and ending; theirs that have no such partner, by the number that counts
/// the images (leading zeros do not matter). Never by rank. `ours`: names of files, or numbers.
/// Images that are none of ours are counted in a note. Throws InputError, beginning with `path`, if
/// none matches although there are some, or two belong to the same of ours.
KeypointMatching MatchKeypoints(const std::string& path, const std::vector<ForeignImage>& theirs,
                                const std::vector<std::string>& ours);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KEYPOINTS_KEYPOINT_MATCHING_H_
