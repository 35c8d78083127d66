#ifndef AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_TIMES_H_
#define AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_TIMES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "common/check/check_findings.h"

namespace airdos {

/// Whether the utime of images, in their order, can be capture times of a camera in us. Drivers
/// fill in what their clock gives: ns, ms or s are told by the interval they would make, a clock
/// that stands still or goes back is said once. Else as CheckTimes().
void CheckLogTimes(const std::vector<std::int64_t>& utimes, const std::string& where,
                   FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_TIMES_H_
