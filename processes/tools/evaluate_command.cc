#include "processes/tools/evaluate_command.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "common/util/error.h"

namespace airdos {

void WriteJson(const nlohmann::json& json, const std::string& path) {
  std::ofstream file(path);
  file << json.dump(1) << "\n";
  if (!file.flush()) throw InputError(path + ": cannot be written");
}

}  // namespace airdos
