#include "common/config/option_pages.h"

#include <algorithm>
#include <sstream>

#include "common/util/words.h"

namespace airdos {
namespace {

constexpr std::size_t kFileWidth = 130;
constexpr std::size_t kTerminalWidth = 100;

/// A line of the file up to its comment, and the comment's paragraphs.
struct Line {
  std::string start;
  std::vector<std::string> comment;
};

std::string WithUnit(const Option& option) {
  return (option.unit.empty() ? "" : option.unit + ": ") + option.help.front();
}

std::vector<Line> SectionLines(const OptionTable& table, std::size_t section) {
  const OptionTable::Section& here = table.sections()[section];
  const std::size_t end = section + 1 < table.sections().size()
                              ? table.sections()[section + 1].first_option
                              : table.options().size();
  std::vector<Line> lines{{here.name + ":", {here.help}}};
  for (std::size_t i = here.first_option; i < end; ++i) {
    const Option& option = table.options()[i];
    const std::string name = option.key.substr(here.name.size() + 1);
    std::vector<std::string> comment = option.help;
    comment.front() = WithUnit(option);
    lines.push_back({"  " + name + ": " + option.value(), comment});
  }
  return lines;
}

/// The comments stand below each other.
std::string Aligned(const std::vector<Line>& lines) {
  std::size_t column = 0;
  for (const Line& line : lines) column = std::max(column, line.start.size() + 2);
  std::string text;
  for (const Line& line : lines) {
    std::string start = line.start;
    for (const std::string& paragraph : line.comment) {
      for (const std::string& part : WrapWords(paragraph, kFileWidth - column - 2)) {
        start.resize(column, ' ');
        text += start + "# " + part + "\n";
        start.clear();
      }
    }
    if (!start.empty()) text += start + "\n";
  }
  return text;
}

std::string Allowed(const Option& option) {
  std::ostringstream text;
  if (option.range) text << option.range->min << " to " << option.range->max;
  if (option.kind == Option::Kind::kSwitch) text << "true or false";
  for (const std::string& word : option.words) text << (text.tellp() > 0 ? ", " : "") << word;
  if (option.kind == Option::Kind::kWholes) text << ", separated by commas";
  if (option.kind == Option::Kind::kWords) text << "words separated by commas";
  if (option.kind == Option::Kind::kText) text << "text";
  return text.str();
}

}  // namespace

std::string ConfigFileText(const OptionTable& table) {
  const std::string about = table.about() + " Every key must be here; an unknown key is an error.";
  std::string text;
  for (const std::string& line : WrapWords(about, kFileWidth - 2)) text += "# " + line + "\n";
  for (std::size_t i = 0; i < table.sections().size(); ++i) {
    text += "\n" + Aligned(SectionLines(table, i));
  }
  return text;
}

std::string OptionReference(const OptionTable& table) {
  std::string text;
  for (const Option& option : table.options()) {
    text += option.key + ": " + option.value() + "  (" + Allowed(option) + ")\n";
    for (std::size_t i = 0; i < option.help.size(); ++i) {
      const std::string paragraph = i == 0 ? WithUnit(option) : option.help[i];
      for (const std::string& line : WrapWords(paragraph, kTerminalWidth - 4)) {
        text += "    " + line + "\n";
      }
    }
  }
  return text;
}

}  // namespace airdos
