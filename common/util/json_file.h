#ifndef AIRDOS_COMMON_UTIL_JSON_FILE_H_
#define AIRDOS_COMMON_UTIL_JSON_FILE_H_

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace airdos {

/// An integer from `low` to `high`, even if written as 3.0. Throws InputError if it is out of range
/// or not an integer: converting a number that does not fit is undefined behaviour.
std::int64_t WholeNumber(const nlohmann::json& value, std::int64_t low, std::int64_t high);

/// Indented JSON. Texts may come from any file: bytes that are not valid UTF-8 are replaced.
std::string JsonText(const nlohmann::json& json);

/// Writes `json` to a file. Throws InputError if that fails.
void WriteJson(const nlohmann::json& json, const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_JSON_FILE_H_
