#ifndef AIRDOS_COMMON_UTIL_CHECK_H_
#define AIRDOS_COMMON_UTIL_CHECK_H_

#include <cstdio>
#include <cstdlib>

/// Terminates the process with file and line if `condition` does not hold, in every build type. For
/// programmer errors only: bad input throws InputError or is counted.
#define AIRDOS_CHECK(condition)                                                          \
  do {                                                                                   \
    if (!(condition)) {                                                                  \
      std::fprintf(stderr, "%s:%d: check failed: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                      \
    }                                                                                    \
  } while (false)

#endif  // AIRDOS_COMMON_UTIL_CHECK_H_
