#ifndef AIRDOS_COMMON_CHECK_SHIFT_H_
#define AIRDOS_COMMON_CHECK_SHIFT_H_

#include "common/check/check_input.h"

namespace airdos {

/// Whether the right images belong to the left ones with the same number, or to those one or two
/// frames away (two recorders started separately). Matches left image k with right images k-2 to
/// k+2 at up to `num_places` evenly spread places where the camera moves. Only there does a wrong
/// partner show, through differing rows and fewer matches; motion purely along the rows does not
/// reveal it. Returns true, and adds an error to the findings, if another partner fits clearly
/// better at most of the places.
bool CheckShift(const CheckedInput& input, std::size_t num_places, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_SHIFT_H_
