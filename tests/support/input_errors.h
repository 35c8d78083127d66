#ifndef AIRDOS_TESTS_SUPPORT_INPUT_ERRORS_H_
#define AIRDOS_TESTS_SUPPORT_INPUT_ERRORS_H_

#include <string>

#include "common/util/error.h"

namespace airdos {

/// The text of the InputError that `act` throws; empty where it throws none.
template <class Act>
std::string ErrorOf(const Act& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline bool Holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_INPUT_ERRORS_H_
