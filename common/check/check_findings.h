#ifndef AIRDOS_COMMON_CHECK_FINDINGS_H_
#define AIRDOS_COMMON_CHECK_FINDINGS_H_

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <set>
#include <string>
#include <vector>

namespace airdos {

/// kNote: what was found out. kWarning: it will run, but look. kError: the result would be wrong.
enum class Severity { kNote, kWarning, kError };
const char* NameOf(Severity severity);

/// One thing that a check of an input found.
struct Finding {
  Severity severity = Severity::kNote;
  std::string kind;   ///< "images.swapped": stays the same from version to version
  std::string where;  ///< file, file:line, or log and image number
  std::string what;   ///< in words
};

/// The findings of one input in the order in which they were made. Of each kind the first few are
/// kept and the others counted, so that a mistake in every file does not hide the other mistakes.
/// What was said before, word for word, is not said again: two checks may meet the same mistake.
class FindingList {
 public:
  static constexpr int kMaxPerKind = 3;

  void Add(Severity severity, const std::string& kind, const std::string& where,
           const std::string& what);
  void Note(const std::string& kind, const std::string& where, const std::string& what) {
    Add(Severity::kNote, kind, where, what);
  }
  void Warn(const std::string& kind, const std::string& where, const std::string& what) {
    Add(Severity::kWarning, kind, where, what);
  }
  void Fail(const std::string& kind, const std::string& where, const std::string& what) {
    Add(Severity::kError, kind, where, what);
  }
  /// An InputError's text, "where: what".
  void FailFrom(const std::string& kind, const std::string& text);

  const std::vector<Finding>& findings() const { return findings_; }
  int count(Severity severity) const;
  bool has_errors() const { return count(Severity::kError) > 0; }

  /// "WHERE: error: WHAT [kind]", a line each, then how many there are.
  void Print(const std::string& input, std::ostream* out) const;
  nlohmann::json ToJson(const std::string& input) const;

 private:
  std::vector<Finding> findings_;
  std::set<std::string> said_;
  std::map<std::string, int> num_of_kind_;
  std::map<Severity, int> num_of_severity_;
};

/// A number with few digits, for texts.
std::string Brief(double value);
/// "12 %".
std::string Percent(double fraction);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_FINDINGS_H_
