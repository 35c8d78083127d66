#ifndef AIRDOS_COMMON_UTIL_SUGGESTION_H_
#define AIRDOS_COMMON_UTIL_SUGGESTION_H_

#include <string>
#include <vector>

namespace airdos {

/// Number of insertions, deletions, replacements and swaps of adjacent letters that turn one word
/// into the other. Ignores case, and treats _ as -.
int EditDistance(const std::string& a, const std::string& b);

/// "; did you mean 'x'?" with the candidate that a mistyped word most likely stands for: one that
/// differs by a few letters, that extends the word or is extended by it, or (for "section.key")
/// that has the same last part. Empty if no candidate is similar.
std::string DidYouMean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_SUGGESTION_H_
