#ifndef AIRDOS_TESTS_SUPPORT_ALLOCATION_WATCH_H_
#define AIRDOS_TESTS_SUPPORT_ALLOCATION_WATCH_H_

#include <cstddef>

namespace airdos {

/// Linking this instruments operator new of a program. Single-threaded programs only.
void ResetLargestAllocation();
std::size_t LargestAllocation();

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_ALLOCATION_WATCH_H_
