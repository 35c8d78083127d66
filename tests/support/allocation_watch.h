#ifndef AIRDOS_TESTS_SUPPORT_ALLOCATION_WATCH_H_
#define AIRDOS_TESTS_SUPPORT_ALLOCATION_WATCH_H_

#include <cstddef>

namespace airdos {

/// A program that links this has its operator new watched. One thread only.
void ResetLargestAllocation();
std::size_t LargestAllocation();

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_ALLOCATION_WATCH_H_
