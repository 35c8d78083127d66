#ifndef AIRDOS_COMMON_UTIL_WORDS_H_
#define AIRDOS_COMMON_UTIL_WORDS_H_

#include <cstddef>
#include <string>
#include <vector>

namespace airdos {

/// The words of the text in lines of at most `width` columns; only a word that is longer alone
/// makes a longer line. No line for a text without words.
std::vector<std::string> WrapWords(const std::string& text, std::size_t width);

/// The words in their order, with `between` between each two.
std::string JoinWords(const std::vector<std::string>& words, const std::string& between);

/// The parts of the text between commas; none for what is empty.
std::vector<std::string> SplitAtCommas(const std::string& text);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_WORDS_H_
