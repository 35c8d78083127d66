#ifndef AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_REPORT_H_
#define AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_REPORT_H_

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace airdos {

/// Result of one test.
enum class Health { kOk, kWarn, kFail };
const char* NameOf(Health health);

/// One thing that was tested.
struct Diagnosis {
  Health health = Health::kOk;
  std::string kind;  ///< such as "network.route"; stable across versions
  std::string what;  ///< the result, in words
  std::string mend;  ///< the command that fixes it; empty if there is none
};
/// In the order in which the tests were made.
using Diagnoses = std::vector<Diagnosis>;

bool HasFail(const Diagnoses& diagnoses);
/// Prints "FAIL network.route: WHAT (mend: COMMAND)", one line each.
void Print(const Diagnoses& diagnoses, std::ostream* out);
nlohmann::json ToJson(const Diagnoses& diagnoses);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_REPORT_H_
