#ifndef AIRDOS_COMMON_CHECK_SHIFT_H_
#define AIRDOS_COMMON_CHECK_SHIFT_H_

#include "common/check/check_input.h"

namespace airdos {

/// Whether the right images belong to the left ones of the same number, or to those one or two
/// frames away (two recorders started apart). Left image k is matched with the right images k-2 to
/// k+2 in up to `num_places` places, evenly spread, where the camera moves: only there a wrong
/// partner shows, by rows that differ and by fewer matches. What moves along the rows alone does
/// not tell. Returns true, and an error is among the findings, where another partner fits clearly
/// better in most of the places.
bool CheckShift(const CheckedInput& input, std::size_t num_places, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_SHIFT_H_
