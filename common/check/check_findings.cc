#include "common/check/check_findings.h"

#include <nlohmann/json.hpp>

#include "common/util/format.h"
#include "common/util/text_file.h"

namespace airdos {

const char* NameOf(Severity severity) {
  switch (severity) {
    case Severity::kNote:
      return "note";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      break;
  }
  return "error";
}

void FindingList::Add(Severity severity, const std::string& kind, const std::string& where,
                      const std::string& what) {
  if (!said_.insert(kind + "\n" + where + "\n" + what).second) return;
  ++num_of_severity_[severity];
  if (++num_of_kind_[kind] > kMaxPerKind) return;
  findings_.push_back({severity, kind, Printable(where), Printable(what)});
}

void FindingList::FailFrom(const std::string& kind, const std::string& text) {
  const std::size_t end = text.find(": ");
  if (end == std::string::npos) return Fail(kind, "", text);
  Fail(kind, text.substr(0, end), text.substr(end + 2));
}

int FindingList::count(Severity severity) const {
  const auto it = num_of_severity_.find(severity);
  return it == num_of_severity_.end() ? 0 : it->second;
}

void FindingList::Print(const std::string& input, std::ostream* out) const {
  for (const Finding& finding : findings_) {
    *out << (finding.where.empty() ? input : finding.where) << ": " << NameOf(finding.severity)
         << ": " << finding.what << " [" << finding.kind << "]\n";
  }
  for (const auto& [kind, count] : num_of_kind_) {
    if (count <= kMaxPerKind) continue;
    *out << input << ": note: " << count - kMaxPerKind << " more like the last [" << kind << "]\n";
  }
  *out << input << ": " << count(Severity::kError) << " errors, " << count(Severity::kWarning)
       << " warnings\n";
}

nlohmann::json FindingList::ToJson(const std::string& input) const {
  nlohmann::json json = {{"input", input},
                         {"errors", count(Severity::kError)},
                         {"warnings", count(Severity::kWarning)},
                         {"findings", nlohmann::json::array()},
                         {"counts", num_of_kind_}};
  for (const Finding& finding : findings_) {
    json["findings"].push_back({{"severity", NameOf(finding.severity)},
                                {"kind", finding.kind},
                                {"where", finding.where},
                                {"what", finding.what}});
  }
  return json;
}

std::string Brief(double value) { return Format("%.3g", value); }

std::string Percent(double fraction) { return Format("%.0f %%", 100 * fraction); }

}  // namespace airdos
