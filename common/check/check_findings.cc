#include "common/check/check_findings.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/util/format.h"

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

namespace {

/// Findings quote files: no control character of them may reach a terminal.
std::string Printable(std::string text) {
  for (char& c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f) c = '?';
  }
  return text;
}

}  // namespace

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

double Quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const double rank = std::ceil(fraction * static_cast<double>(values.size())) - 1;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::clamp(
                                        rank, 0.0, static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace airdos
