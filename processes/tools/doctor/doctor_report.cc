#include "processes/tools/doctor/doctor_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace airdos {

const char* NameOf(Health health) {
  switch (health) {
    case Health::kOk:
      return "OK";
    case Health::kWarn:
      return "WARN";
    case Health::kFail:
      break;
  }
  return "FAIL";
}

bool HasFail(const Diagnoses& diagnoses) {
  return std::any_of(diagnoses.begin(), diagnoses.end(),
                     [](const Diagnosis& d) { return d.health == Health::kFail; });
}

void Print(const Diagnoses& diagnoses, std::ostream* out) {
  for (const Diagnosis& diagnosis : diagnoses) {
    *out << NameOf(diagnosis.health) << (diagnosis.health == Health::kOk ? "   " : " ")
         << diagnosis.kind << ": " << diagnosis.what;
    if (!diagnosis.mend.empty()) *out << " (mend: " << diagnosis.mend << ")";
    *out << "\n";
  }
}

nlohmann::json ToJson(const Diagnoses& diagnoses) {
  nlohmann::json json = nlohmann::json::array();
  for (const Diagnosis& diagnosis : diagnoses) {
    json.push_back({{"health", NameOf(diagnosis.health)},
                    {"kind", diagnosis.kind},
                    {"what", diagnosis.what},
                    {"mend", diagnosis.mend}});
  }
  return json;
}

}  // namespace airdos
