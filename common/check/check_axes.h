#ifndef AIRDOS_COMMON_CHECK_AXES_H_
#define AIRDOS_COMMON_CHECK_AXES_H_

#include "common/check/check_input.h"

namespace airdos {

/// Compares the ground truth with short visual odometry over the `num_frames` consecutive frames
/// with the most motion: whether its axes are those of the layout, whether they are right- or
/// left-handed, and whether the lengths agree.
void CheckGroundTruth(const CheckedInput& input, std::size_t num_frames, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_AXES_H_
