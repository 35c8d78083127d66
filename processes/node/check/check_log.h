#ifndef AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_H_
#define AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_H_

#include <string>

#include "common/check/check_input.h"

namespace airdos {

/// Kind of the finding that bytes of a log are damaged.
inline constexpr char kLogDamagedKind[] = "log.damaged";

/// Checks the input channels of an event log: that every message decodes and makes sense, is small
/// enough to travel, comes in order and without gaps, that each image has its partners (LogPairing)
/// and a calibration before it, that sizes and capture times are possible, and then what it shows
/// as CheckFolder() does. The quick look is one reading of at most the first 200 MB that decodes no
/// image. Throws InputError where the file is no log.
void CheckLog(const std::string& path, const CheckOptions& options, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_H_
