#include "common/util/text_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "common/util/error.h"
#include "common/util/input_file.h"

namespace airdos {
namespace {

constexpr std::size_t kMaxLineBytes = 20000;
constexpr int kMaxLines = 1000000;

/// Like std::getline(), but stops early in a line that is too long.
bool ReadLine(std::istream* stream, std::string* line) {
  line->clear();
  std::streambuf* const buffer = stream->rdbuf();
  for (int c = buffer->sbumpc(); c != std::char_traits<char>::eof(); c = buffer->sbumpc()) {
    if (c == '\n') return true;
    line->push_back(static_cast<char>(c));
    if (line->size() > kMaxLineBytes) return true;
  }
  return !line->empty();
}

/// Windows editors start a file with a byte order mark (U+FEFF). That of UTF-8 is removed.
void CheckEncoding(const std::string& path, std::string* first_line) {
  constexpr const char* kUtf8Mark = "\xEF\xBB\xBF";
  if (first_line->compare(0, 3, kUtf8Mark) == 0) first_line->erase(0, 3);
  const bool is_marked = first_line->compare(0, 2, "\xFF\xFE") == 0 ||  // little, big endian
                         first_line->compare(0, 2, "\xFE\xFF") == 0;
  const std::string start = first_line->substr(0, 64);
  // In UTF-16, every other byte of ASCII text is zero.
  const bool looks_like_it =
      start.size() >= 4 &&
      3 * std::count(start.begin(), start.end(), '\0') >= static_cast<std::ptrdiff_t>(start.size());
  if (is_marked || looks_like_it) {
    throw InputError(path + ": is UTF-16 text (as PowerShell's > writes it); convert it with " +
                     "'iconv -f UTF-16 -t UTF-8'");
  }
}

}  // namespace

std::string Printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

std::string Shown(const std::string& word) {
  constexpr std::size_t kMaxShown = 60;
  return Printable(word.substr(0, kMaxShown)) + (word.size() > kMaxShown ? "..." : "");
}

std::vector<TextLine> ReadTextLines(const std::string& path, std::string* heading) {
  RequireRegularFile(path);
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read");
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; ReadLine(&file, &text); ++number) {
    const std::string where = path + ":" + std::to_string(number);
    if (text.size() > kMaxLineBytes) {
      throw InputError(where + ": a line of more than " + std::to_string(kMaxLineBytes) + " bytes");
    }
    if (number > kMaxLines) {
      throw InputError(where + ": more than " + std::to_string(kMaxLines) + " lines");
    }
    if (number == 1) CheckEncoding(path, &text);
    std::istringstream stream(text);
    TextLine line;
    line.number = number;
    line.words.assign(std::istream_iterator<std::string>(stream), {});
    if (line.words.empty()) continue;
    if (line.words[0][0] != '#') {
      lines.push_back(std::move(line));
    } else if (heading != nullptr && lines.empty()) {
      *heading = text.substr(text.find('#') + 1);
    }
  }
  if (file.bad()) throw InputError(path + ": cannot be read");
  return lines;
}

std::vector<double> ParseNumbers(const std::string& path, const TextLine& line, std::size_t first) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < line.words.size(); ++i) {
    char* end = nullptr;
    const double number = std::strtod(line.words[i].c_str(), &end);
    // Compared by length, since a word may contain a zero byte.
    const bool is_whole = end == line.words[i].c_str() + line.words[i].size();
    if (!is_whole || !std::isfinite(number)) {
      throw InputError(path + ":" + std::to_string(line.number) + ": '" + Shown(line.words[i]) +
                       "' is not a finite number");
    }
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace airdos
