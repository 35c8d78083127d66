#ifndef AIRDOS_COMMON_CHECK_TIMES_H_
#define AIRDOS_COMMON_CHECK_TIMES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "common/check/check_findings.h"

namespace airdos {

/// Whether capture times (us) can be those of a camera: increasing, at 1 to 200 images per second,
/// without gaps (1.5 times the median interval). Times in ms, us or ns instead of s are recognised
/// by their interval.
void CheckTimes(const std::vector<std::int64_t>& utimes, const std::string& where,
                FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_TIMES_H_
