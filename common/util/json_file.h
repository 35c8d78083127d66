#ifndef AIRDOS_COMMON_UTIL_JSON_FILE_H_
#define AIRDOS_COMMON_UTIL_JSON_FILE_H_

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace airdos {

/// A whole number from `low` to `high`, also where it is written as 3.0. Throws InputError where it
/// is another one or none: to convert a number that does not fit is undefined.
std::int64_t WholeNumber(const nlohmann::json& value, std::int64_t low, std::int64_t high);

/// Indented JSON. Texts may come from anybody's files: what is no UTF-8 in them is replaced.
std::string JsonText(const nlohmann::json& json);

/// Writes it to a file. Throws InputError where that cannot be written.
void WriteJson(const nlohmann::json& json, const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_JSON_FILE_H_
