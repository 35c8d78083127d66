#ifndef AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_H_
#define AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_H_

#include <string>

#include "common/check/check_input.h"

namespace airdos {

/// Kind of the finding for damaged bytes in a log.
inline constexpr char kLogDamagedKind[] = "log.damaged";

/// Checks the input channels of an event log: that every message decodes and is valid, is small
/// enough to travel, and is in order and without gaps; that each image has its partners
/// (LogPairing) and is preceded by a calibration; that sizes and capture times are plausible; and
/// then the contents, like CheckFolder(). The quick check reads at most the first 200 MB, once, and
/// decodes no images. Throws InputError if the file is not a log.
void CheckLog(const std::string& path, const CheckOptions& options, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_H_
