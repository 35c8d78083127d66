#ifndef AIRDOS_COMMON_DATASET_SEQUENCE_FILES_H_
#define AIRDOS_COMMON_DATASET_SEQUENCE_FILES_H_

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/dataset/stereo_sequence.h"

namespace airdos {

// The files that data set layouts are made of. Every function throws InputError naming the file and
// the line that cannot be used.

/// A whole file of at most 32 MB.
std::vector<std::uint8_t> ReadBytes(const std::string& path);
/// A whole JPEG or PNG file of a camera's picture (WhyNoPicture() in image_file.h is empty).
std::vector<std::uint8_t> ReadImageFile(const std::string& path);
/// Width and height in px.
std::pair<int, int> ReadImageSize(const std::string& path);

/// Decimal seconds ("24.359021056", "1.036e-01") in us, rounded half away from zero, without a
/// detour over floating point: a time since 1970 keeps every microsecond. False where the text is
/// no number or does not fit.
bool ParseMicroseconds(const std::string& seconds, std::int64_t* utime);

/// Rows of 3 x 4 numbers, [R t] row major.
std::vector<Se3> ReadKittiPoses(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_SEQUENCE_FILES_H_
