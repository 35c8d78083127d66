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

/// Names (without folder) of the .png, .jpg and .jpeg files of a folder, in order of the number
/// that they start with, then of the name.
std::vector<std::string> ListImages(const std::string& folder);

/// Decimal seconds ("24.359021056", "1.036e-01") in us, rounded half away from zero, without a
/// detour over floating point: a time since 1970 keeps every microsecond. False where the text is
/// no number or does not fit.
bool ParseMicroseconds(const std::string& seconds, std::int64_t* utime);
/// One time (us) a line, strictly increasing.
std::vector<std::int64_t> ReadTimes(const std::string& path);

/// People of one image: rows of 54 numbers. No file: nobody. Confidences are clamped to [0, 1].
std::vector<PersonKeypoints> ReadKeypoints(const std::string& path);
/// The same with the confidences as they stand there.
std::vector<PersonKeypoints> ReadRawKeypoints(const std::string& path);

/// Rows of 3 x 4 numbers, [R t] row major.
std::vector<Se3> ReadKittiPoses(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_SEQUENCE_FILES_H_
