#ifndef AIRDOS_COMMON_UTIL_SUGGESTION_H_
#define AIRDOS_COMMON_UTIL_SUGGESTION_H_

#include <string>
#include <vector>

namespace airdos {

/// How many letters must be put in, left out, replaced or exchanged with their neighbour to make
/// one word of the other; capitals count as small letters, and _ as -.
int EditDistance(const std::string& a, const std::string& b);

/// "; did you mean 'x'?" with the candidate that a mistyped word most probably stands for: one that
/// differs by few letters, or goes on where the word ends, or the other way round, or (for
/// "section.key") has the same last part. Empty where none is near.
std::string DidYouMean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_SUGGESTION_H_
