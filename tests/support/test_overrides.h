#ifndef AIRDOS_TESTS_SUPPORT_TEST_OVERRIDES_H_
#define AIRDOS_TESTS_SUPPORT_TEST_OVERRIDES_H_

#include <cstdlib>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace airdos {

/// The overrides in `AIRDOS_TEST_SET`, if set, as for airdos-replay --set
/// (process:section.key=value), separated by spaces. For exploring how sensitive the figures of a
/// test on data are.
inline std::vector<std::string> TestOverrides() {
  const char* const text = std::getenv("AIRDOS_TEST_SET");
  std::istringstream words(text != nullptr ? text : "");
  return {std::istream_iterator<std::string>(words), {}};
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_TEST_OVERRIDES_H_
