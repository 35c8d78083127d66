#ifndef AIRDOS_COMMON_UTIL_TEXT_FILE_H_
#define AIRDOS_COMMON_UTIL_TEXT_FILE_H_

#include <cstddef>
#include <string>
#include <vector>

namespace airdos {

/// A line of a text file: its number (from 1) and its words.
struct TextLine {
  int number = 0;
  std::vector<std::string> words;
};

/// The lines that are neither empty nor comments (#), without a UTF-8 byte order mark and the CR of
/// Windows line ends. Throws InputError naming the file if it cannot be read, is UTF-16, or has
/// more than 1,000,000 lines or a line of more than 20,000 bytes. If given, `heading` receives the
/// text of the last comment before the first line, which often names the columns.
std::vector<TextLine> ReadTextLines(const std::string& path, std::string* heading = nullptr);

/// Messages quote files, and no control character from a file may reach a terminal. Each becomes a
/// question mark.
std::string Printable(std::string text);
/// A word from a file for a message: printable, and truncated if longer than 60 bytes.
std::string Shown(const std::string& word);

/// The words from index `first` on as finite numbers. Throws InputError naming file, line and word.
std::vector<double> ParseNumbers(const std::string& path, const TextLine& line, std::size_t first);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_TEXT_FILE_H_
