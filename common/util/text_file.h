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

/// The lines that are neither empty nor a comment (#); a byte order mark of UTF-8 and the CR of
/// Windows' line ends are left out. Throws InputError naming the file where it cannot be read, is
/// UTF-16, or has more than 1,000,000 lines or one of more than 20,000 bytes. `heading`, where
/// given, gets the text of the last comment above the first line, which often names the columns.
std::vector<TextLine> ReadTextLines(const std::string& path, std::string* heading = nullptr);

/// Messages quote files: no control character of them may reach a terminal. Each becomes a question
/// mark.
std::string Printable(std::string text);
/// A word of a file for a message: printable, and cut where it is longer than 60 bytes.
std::string Shown(const std::string& word);

/// The words from number `first` on as finite numbers. Throws InputError naming file, line and
/// word.
std::vector<double> ParseNumbers(const std::string& path, const TextLine& line, std::size_t first);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_TEXT_FILE_H_
