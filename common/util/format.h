#ifndef AIRDOS_COMMON_UTIL_FORMAT_H_
#define AIRDOS_COMMON_UTIL_FORMAT_H_

#include <string>

namespace airdos {

/// Text of any length by a format of printf, which the compiler compares with its arguments. It
/// does not compare one that it cannot see; hand over such a format with doubles only.
///
/// printf rather than {fmt}: the tables need its columns and digits exactly, C++17 checks the
/// formats of {fmt} only through a macro, and std::format comes with GCC 13. Throws
/// std::runtime_error on a format that printf itself refuses.
[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_FORMAT_H_
