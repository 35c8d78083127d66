#ifndef AIRDOS_COMMON_DATASET_TIMES_FILE_H_
#define AIRDOS_COMMON_DATASET_TIMES_FILE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "common/util/text_file.h"

namespace airdos {

/// One time (s) a line, strictly increasing; in us. Throws InputError naming the file, the line and
/// what it looks like: times in ms, us or ns, dates, lines of EuRoC's data.csv, several columns,
/// times that repeat or go back.
std::vector<std::int64_t> ReadTimes(const std::string& path);

/// "ms", "us" or "ns" where the first of several times and the step between them (0: not known)
/// cannot be s, but would be a camera's in that unit. Else empty.
std::string OtherTimeUnit(double first, double median_step);

/// ": the times are in ns (...), wanted in s; ..." with a command that converts them.
std::string WrongTimeUnit(const std::string& unit, const std::string& shown);

/// What else than numbers with blanks between them a line is, and the remedy: "; ..." or empty.
std::string ExplainSeparators(const TextLine& line);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_TIMES_FILE_H_
