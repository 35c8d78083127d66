#ifndef AIRDOS_COMMON_DATASET_KEYPOINTS_FOREIGN_KEYPOINTS_H_
#define AIRDOS_COMMON_DATASET_KEYPOINTS_FOREIGN_KEYPOINTS_H_

#include <optional>
#include <string>
#include <vector>

#include "common/dataset/keypoints/foreign_layouts.h"
#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// The people that another program found in one image.
struct ForeignImage {
  std::string name;  ///< as the program calls it: a file name, with or without ending, or a number
  std::vector<PersonKeypoints>
      people;  ///< COCO-18, px of that image; each has a joint that is seen
};

/// What another program found in the images of one camera.
struct ForeignKeypoints {
  std::string path;
  std::string program;  ///< "AlphaPose", "COCO results", "OpenPose", "lines of numbers"
  std::optional<ForeignLayout> layout;  ///< nothing if there is nobody
  std::vector<ForeignImage> images;     ///< each once, in the order in which they come
  std::vector<std::string> notes;       ///< for the user, one line each
};

/// Reads, by what they hold:
/// - a JSON list of people, each with `image_id` (name or number) and `keypoints` (u, v, confidence
///   of each joint): AlphaPose's results (COCO-17, Halpe-26, Halpe-136, COCO-WholeBody), COCO
///   results
/// - a folder with a JSON file an image, as OpenPose writes them (`people`, `pose_keypoints_2d`:
///   BODY_25, BODY_25B, COCO-18; empty lists are nobody), also in the layouts of the others
/// - a folder with a text file an image (keypoint_file.h)
/// - a folder with one JSON list
/// People without any joint are left out. Confidences become 0..1: where most joints have more than
/// 1 (percent, COCO's visibility of 0 to 2), all are divided by the highest; otherwise those above
/// 1 are 1; a note says so.
///
/// Throws InputError naming the file and the place: no such format, another number of joints,
/// several layouts, coordinates that are not in px, lists nested too deeply, files of more than 1
/// GB (10 MB where there is one an image).
ForeignKeypoints ReadForeignKeypoints(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KEYPOINTS_FOREIGN_KEYPOINTS_H_
