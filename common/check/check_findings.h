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

/// kNote: for information. kWarning: it will run, but needs attention. kError: the result would be
/// wrong.
enum class Severity { kNote, kWarning, kError };
const char* NameOf(Severity severity);

/// One finding of a check of the input.
struct Finding {
  Severity severity = Severity::kNote;
  std::string kind;   ///< such as "images.swapped"; stable across versions
  std::string where;  ///< file, file:line, or log and image number
  std::string what;   ///< the message
};

/// The findings about one input, in the order in which they were made. Of each kind, the first few
/// are kept and the others counted, so that a mistake in every file does not hide other mistakes. A
/// finding that repeats an earlier one word for word is dropped: two checks may notice the same
/// mistake.
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
  /// Adds an error from an InputError's text, "where: what".
  void FailFrom(const std::string& kind, const std::string& text);

  const std::vector<Finding>& findings() const { return findings_; }
  int count(Severity severity) const;
  bool has_errors() const { return count(Severity::kError) > 0; }

  /// Prints "WHERE: error: WHAT [kind]", one line each, then the totals.
  void Print(const std::string& input, std::ostream* out) const;
  nlohmann::json ToJson(const std::string& input) const;

 private:
  std::vector<Finding> findings_;
  std::set<std::string> said_;
  std::map<std::string, int> num_of_kind_;
  std::map<Severity, int> num_of_severity_;
};

/// A number with few digits, for messages.
std::string Brief(double value);
/// A percentage, such as "12 %".
std::string Percent(double fraction);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_FINDINGS_H_
