#ifndef AIRDOS_COMMON_UTIL_ERROR_H_
#define AIRDOS_COMMON_UTIL_ERROR_H_

#include <stdexcept>
#include <string>

namespace airdos {

/// A file, configuration value or argument that cannot be used. The text is one line naming the
/// file, the key and the value; main() prints it and exits with kExitBadInput.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr int kExitBadInput = 2;

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_ERROR_H_
