#ifndef AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_REPORT_H_
#define AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_REPORT_H_

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace airdos {

enum class Health { kOk, kWarn, kFail };
const char* NameOf(Health health);

/// One thing that was examined.
struct Diagnosis {
  Health health = Health::kOk;
  std::string kind;  ///< "network.route": stays the same from version to version
  std::string what;  ///< in words
  std::string mend;  ///< the command that mends it; empty where there is none
};
using Diagnoses = std::vector<Diagnosis>;

bool HasFail(const Diagnoses& diagnoses);
/// "FAIL network.route: WHAT (mend: COMMAND)", a line each.
void Print(const Diagnoses& diagnoses, std::ostream* out);
nlohmann::json ToJson(const Diagnoses& diagnoses);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_REPORT_H_
