#include "common/util/json_file.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/util/error.h"

namespace airdos {

std::int64_t WholeNumber(const nlohmann::json& value, std::int64_t low, std::int64_t high) {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (number != std::floor(number) || number < static_cast<double>(low) ||
      number > static_cast<double>(high)) {
    const std::string what = value.is_number() ? value.dump() : value.type_name();
    throw InputError("'" + what + "' is not a whole number from " + std::to_string(low) + " to " +
                     std::to_string(high));
  }
  return value.is_number_integer() ? value.get<std::int64_t>() : static_cast<std::int64_t>(number);
}

std::string JsonText(const nlohmann::json& json) {
  constexpr int kIndent = 2;
  return json.dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace);
}

void WriteJson(const nlohmann::json& json, const std::string& path) {
  std::ofstream file(path);
  file << JsonText(json) << "\n";
  if (!file.flush()) throw InputError(path + ": cannot be written");
}

}  // namespace airdos
