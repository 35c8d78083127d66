#ifndef AIRDOS_COMMON_DATASET_TIMES_FILE_H_
#define AIRDOS_COMMON_DATASET_TIMES_FILE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "common/util/text_file.h"

namespace airdos {

/// Reads one time (s) per line, strictly increasing; returns us. Throws InputError naming the file,
/// the line and what it looks like: times in ms, us or ns, dates, lines of EuRoC's data.csv,
/// several columns, times that repeat or go back.
std::vector<std::int64_t> ReadTimes(const std::string& path);

/// "ms", "us" or "ns" if the first of several times and their median step (0 if unknown) are
/// implausible in s but plausible for a camera in that unit; otherwise empty.
std::string OtherTimeUnit(double first, double median_step);

/// ": the times are in ns (...), wanted in s; ..." with a command that converts them.
std::string WrongTimeUnit(const std::string& unit, const std::string& shown);

/// What a line is, and the remedy, if it is not numbers separated by blanks: "; ...", or empty.
std::string ExplainSeparators(const TextLine& line);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_TIMES_FILE_H_
