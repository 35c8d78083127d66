#include "common/util/json_file.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "common/util/error.h"

namespace airdos {

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
