#ifndef AIRDOS_TESTS_SUPPORT_TEST_OVERRIDES_H_
#define AIRDOS_TESTS_SUPPORT_TEST_OVERRIDES_H_

#include <cstdlib>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace airdos {

/// What `AIRDOS_TEST_SET` says, if it is set: overrides as of airdos-replay --set
/// (process:section.key=value), separated by spaces. To see how far the figures of a test on data
/// go when little is changed.
inline std::vector<std::string> TestOverrides() {
  const char* const text = std::getenv("AIRDOS_TEST_SET");
  std::istringstream words(text != nullptr ? text : "");
  return {std::istream_iterator<std::string>(words), {}};
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_TEST_OVERRIDES_H_
