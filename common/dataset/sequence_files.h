#ifndef AIRDOS_COMMON_DATASET_SEQUENCE_FILES_H_
#define AIRDOS_COMMON_DATASET_SEQUENCE_FILES_H_

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/dataset/stereo_sequence.h"

namespace airdos {

// Readers for the files of data sets. Every function throws InputError naming the file and the line
// that cannot be used.

/// Reads a whole file of at most 32 MB.
std::vector<std::uint8_t> ReadBytes(const std::string& path);
/// Reads a whole JPEG or PNG file of a camera image (WhyNoPicture() in image_file.h is empty).
std::vector<std::uint8_t> ReadImageFile(const std::string& path);
/// Reads width and height in px.
std::pair<int, int> ReadImageSize(const std::string& path);

/// Converts decimal seconds ("24.359021056", "1.036e-01") to us, rounding half away from zero and
/// without floating point, so that a time since 1970 is exact to the microsecond. False if the text
/// is not a number or out of range.
bool ParseMicroseconds(const std::string& seconds, std::int64_t* utime);

/// Reads rows of 3 x 4 numbers, [R t], row-major.
std::vector<Se3> ReadKittiPoses(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_SEQUENCE_FILES_H_
