#ifndef AIRDOS_COMMON_DATASET_RECORDING_RECORDING_TIMES_H_
#define AIRDOS_COMMON_DATASET_RECORDING_RECORDING_TIMES_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/dataset/image_names.h"
#include "common/util/text_file.h"

namespace airdos {

/// The words of a line between blanks, commas and semicolons.
std::vector<std::string> ColumnsOf(const TextLine& line);

/// A file with the times of images, as cameras and other programs write them.
struct RecordingTimes {
  std::string path;
  std::vector<std::int64_t> utimes;  ///< us, increasing
  /// The file names beside the times, without folder and extension; empty if there are none.
  std::vector<std::string> stems;
  std::string unit;  ///< of the file: "s", "ms", "us", "ns" or "dates"
};

/// Reads a time per line, with or without a file name beside it, separated by blanks, commas or
/// semicolons: times.txt, EuRoC's data.csv, associations of TUM RGB-D; or KITTI's dates
/// ("2011-09-26 13:02:25.964389445"). A first line without numbers is a heading. The unit is that
/// in which the times are plausible for a camera. Throws InputError naming file, line and text.
RecordingTimes ReadRecordingTimes(const std::string& path);

/// The times (us) of images, by the names in the file, or else by row (RowsOfImages(), which throws
/// InputError). Nothing for images that are not among the names; a note says so.
std::vector<std::optional<std::int64_t>> TimesOfImages(const RecordingTimes& times,
                                                       const ImageNames& images,
                                                       std::vector<std::string>* notes);

/// Times (us) of `count` images that follow each other at a rate. Throws InputError unless the rate
/// is positive.
std::vector<std::int64_t> TimesAtRate(std::size_t count, double rate_hz);
std::int64_t TimeAtRate(std::size_t index, double rate_hz);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_RECORDING_RECORDING_TIMES_H_
