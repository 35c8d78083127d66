#ifndef AIRDOS_COMMON_DATASET_KEYPOINT_FILE_H_
#define AIRDOS_COMMON_DATASET_KEYPOINT_FILE_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"
#include "common/human/layouts.h"

namespace airdos {

/// The people in one image.
struct KeypointFile {
  std::optional<KeypointLayout> layout;  ///< nothing if there is nobody
  std::vector<PersonKeypoints> people;
};

/// Reads rows of `u v confidence` for each joint of a person: 54 numbers (COCO-18), 51 (COCO-17) or
/// 78 (Halpe-26), with the same layout in all rows. A missing file, or "", means nobody. Throws
/// InputError naming file and line; for other counts of numbers the message says what they look
/// like. Confidences are clamped to [0, 1].
KeypointFile ReadKeypoints(const std::string& path);
/// The same, with the confidences as they are in the file.
KeypointFile ReadRawKeypoints(const std::string& path);

/// The layout shared by the rows of all files; nothing if there are no rows, or none with a known
/// layout (which ReadKeypoints() refuses). Looks only at the first row of each file. Throws
/// InputError naming two files whose layouts differ.
std::optional<KeypointLayout> FindLayout(const std::vector<std::string>& paths);

/// The layout's name, such as "COCO-18".
std::string NameOf(KeypointLayout layout);

/// What people with this many numbers each look like: ": this looks like ...", or empty.
std::string ExplainKeypointCount(std::size_t count);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KEYPOINT_FILE_H_
