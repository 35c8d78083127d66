#ifndef AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_TIMES_H_
#define AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_TIMES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "common/check/check_findings.h"

namespace airdos {

/// Checks whether the utimes of images, in order, can be capture times of a camera in us. Some
/// drivers store whatever their clock returns: ns, ms and s are recognised by the interval that
/// results, and a clock that stands still or goes back is reported once. Otherwise as CheckTimes().
void CheckLogTimes(const std::vector<std::int64_t>& utimes, const std::string& where,
                   FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_TIMES_H_
