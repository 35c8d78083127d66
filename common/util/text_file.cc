#include "common/util/text_file.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "common/util/error.h"

namespace airdos {

std::vector<TextLine> ReadTextLines(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read");
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    std::istringstream stream(text);
    TextLine line;
    line.number = number;
    line.words.assign(std::istream_iterator<std::string>(stream), {});
    if (!line.words.empty() && line.words[0][0] != '#') lines.push_back(std::move(line));
  }
  if (file.bad()) throw InputError(path + ": cannot be read");
  return lines;
}

std::vector<double> ParseNumbers(const std::string& path, const TextLine& line, std::size_t first) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < line.words.size(); ++i) {
    char* end = nullptr;
    const double number = std::strtod(line.words[i].c_str(), &end);
    if (*end != '\0' || !std::isfinite(number)) {
      throw InputError(path + ":" + std::to_string(line.number) + ": '" + line.words[i] +
                       "' is not a finite number");
    }
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace airdos
