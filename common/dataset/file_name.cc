#include "common/dataset/file_name.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr char kNumberMark = '\0';  // a file name may contain any other character

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

std::size_t EndOfDigits(const std::string& text, std::size_t at) {
  while (at < text.size() && IsDigit(text[at])) ++at;
  return at;
}

std::string WithoutLeadingZeros(const std::string& digits) {
  const std::size_t first = digits.find_first_not_of('0');
  return first == std::string::npos ? "0" : digits.substr(first);
}

std::string WithoutTrailingZeros(const std::string& digits) {
  const std::size_t last = digits.find_last_not_of('0');
  return last == std::string::npos ? "" : digits.substr(0, last + 1);
}

/// Splits a number into its integer part and its decimals.
std::pair<std::string, std::string> Split(const std::string& number) {
  const std::size_t point = number.find('.');
  if (point == std::string::npos) return {number, ""};
  return {number.substr(0, point), number.substr(point + 1)};
}

bool IsNameLess(const FileName& a, const FileName& b) {
  for (std::size_t i = 0; i < a.numbers.size(); ++i) {
    if (a.numbers[i] != b.numbers[i]) return IsNumberLess(a.numbers[i], b.numbers[i]);
  }
  return a.name < b.name;
}

/// Whether digits, a point and digits form one number: a time such as 1403636579.76, but not 1.2.
bool AreDecimals(std::size_t num_whole, std::size_t num_decimals) {
  return num_whole >= 6 || num_decimals >= 3;
}

/// The number that is different in each name and increases with them in natural order; if names
/// share numbers, the first number that differs at all.
int FindCountingNumber(const std::vector<FileName>& names) {
  const int num_numbers = static_cast<int>(names[0].numbers.size());
  std::vector<int> changing;
  for (int i = 0; i < num_numbers; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto differs = [&](const FileName& name) {
      return name.numbers[at] != names[0].numbers[at];
    };
    if (std::any_of(names.begin(), names.end(), differs)) changing.push_back(i);
  }
  if (changing.empty()) return num_numbers - 1;  // one file, or the same numbers everywhere
  if (changing.size() == 1) return changing[0];
  for (const int i : changing) {
    const auto at = static_cast<std::size_t>(i);
    const auto does_not_grow = [&](const FileName& a, const FileName& b) {
      return !IsNumberLess(a.numbers[at], b.numbers[at]);
    };
    if (std::adjacent_find(names.begin(), names.end(), does_not_grow) == names.end()) return i;
  }
  return -1;
}

}  // namespace

FileName TakeApart(const std::string& name) {
  FileName result;
  result.name = name;
  result.stem = fs::path(name).stem().string();
  const std::string& stem = result.stem;
  for (std::size_t i = 0; i < stem.size();) {
    if (!IsDigit(stem[i])) {
      result.pattern += stem[i++];
      continue;
    }
    std::size_t end = EndOfDigits(stem, i);
    std::string number = WithoutLeadingZeros(stem.substr(i, end - i));
    const std::size_t decimals = end + 1;
    const bool has_point = decimals < stem.size() && stem[end] == '.' && IsDigit(stem[decimals]);
    if (has_point && AreDecimals(end - i, EndOfDigits(stem, decimals) - decimals)) {
      end = EndOfDigits(stem, decimals);
      number += "." + WithoutTrailingZeros(stem.substr(decimals, end - decimals));
    }
    result.numbers.push_back(number);
    result.pattern += kNumberMark;
    i = end;
  }
  return result;
}

bool IsNumberLess(const std::string& a, const std::string& b) {
  const auto [whole_a, decimals_a] = Split(a);
  const auto [whole_b, decimals_b] = Split(b);
  return std::make_tuple(whole_a.size(), whole_a, decimals_a) <
         std::make_tuple(whole_b.size(), whole_b, decimals_b);
}

std::string NameSeries::KeyOf(const FileName& name) const {
  return counting < 0 ? name.stem : name.numbers[static_cast<std::size_t>(counting)];
}

std::vector<NameSeries> GroupNames(const std::vector<std::string>& names) {
  std::map<std::pair<std::string, std::size_t>, NameSeries> by_pattern;
  for (const std::string& name : names) {
    FileName taken_apart = TakeApart(name);
    NameSeries& group = by_pattern[{taken_apart.pattern, taken_apart.numbers.size()}];
    group.names.push_back(std::move(taken_apart));
  }
  std::vector<NameSeries> series;
  for (auto& [pattern, group] : by_pattern) {
    std::sort(group.names.begin(), group.names.end(), IsNameLess);
    group.counting = FindCountingNumber(group.names);
    series.push_back(std::move(group));
  }
  const auto rank = [](const NameSeries& a) {
    return std::make_tuple(a.names.size(), !a.names[0].numbers.empty());
  };
  std::stable_sort(series.begin(), series.end(),
                   [&](const auto& a, const auto& b) { return rank(a) > rank(b); });
  return series;
}

std::string EndingOf(const std::string& name) {
  std::string ending = fs::path(name).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

bool IsHidden(const std::string& name) { return !name.empty() && name[0] == '.'; }

std::vector<std::string> ListFiles(const std::string& folder,
                                   const std::vector<std::string>& endings) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    std::error_code ignored;
    if (it->is_directory(ignored)) continue;
    if (endings.empty() ||
        std::find(endings.begin(), endings.end(), EndingOf(name)) != endings.end()) {
      names.push_back(name);
    }
  }
  if (error) throw InputError(folder + ": " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

std::string CountByEnding(const std::vector<std::string>& names) {
  std::map<std::string, std::pair<std::size_t, std::string>> kinds;
  for (const std::string& name : names) {
    auto& [count, example] = kinds[EndingOf(name)];
    if (count++ == 0) example = name;
  }
  std::string text;
  for (const auto& [ending, kind] : kinds) {
    text += (text.empty() ? "" : ", ") + std::to_string(kind.first) +
            (ending.empty() ? "" : " " + ending) + (kind.first == 1 ? " file (" : " files (") +
            kind.second + (kind.first == 1 ? ")" : ", ...)");
  }
  return text;
}

std::string FirstFew(const std::vector<std::string>& names, std::size_t max_shown) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), max_shown); ++i) {
    text += (i == 0 ? "'" : ", '") + names[i] + "'";
  }
  if (names.size() > max_shown) {
    text += " and " + std::to_string(names.size() - max_shown) + " more";
  }
  return text;
}

}  // namespace airdos
