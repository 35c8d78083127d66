#ifndef AIRDOS_COMMON_DATASET_KEYPOINT_FILE_H_
#define AIRDOS_COMMON_DATASET_KEYPOINT_FILE_H_

#include <optional>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"
#include "common/human/layouts.h"

namespace airdos {

/// The people of one image.
struct KeypointFile {
  std::optional<KeypointLayout> layout;  ///< nothing where there is nobody
  std::vector<PersonKeypoints> people;
};

/// Rows of `u v confidence` of each joint of a person: 54 numbers (COCO-18), 51 (COCO-17) or 78
/// (Halpe-26), all rows of one layout. No file, or "": nobody. Throws InputError naming file and
/// line; other numbers of numbers are named by what they look like. Confidences are clamped to
/// [0, 1].
KeypointFile ReadKeypoints(const std::string& path);
/// The same with the confidences as they stand there.
KeypointFile ReadRawKeypoints(const std::string& path);

/// The layout that the rows of all files have; nothing where there are none, or none with a layout
/// that is known (which ReadKeypoints() refuses). Looks at the first row of each file. Throws
/// InputError naming both files where two layouts are mixed.
std::optional<KeypointLayout> FindLayout(const std::vector<std::string>& paths);

/// "COCO-18".
std::string NameOf(KeypointLayout layout);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KEYPOINT_FILE_H_
