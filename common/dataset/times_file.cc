#include "common/dataset/times_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/quantile.h"
#include "common/util/text_file.h"
#include "common/util/words.h"

namespace airdos {
namespace {

std::string Joined(const TextLine& line) { return Shown(JoinWords(line.words, " ")); }

bool IsNumber(const std::string& word, double* number) {
  char* end = nullptr;
  *number = std::strtod(word.c_str(), &end);
  return !word.empty() && end == word.c_str() + word.size() && std::isfinite(*number);
}

/// Whether the word begins like 2026-03-01 or 2026/03/01.
bool IsDate(const std::string& word) {
  const std::string pattern = "dddd-dd-dd";
  if (word.size() < pattern.size()) return false;
  return std::equal(pattern.begin(), pattern.end(), word.begin(), [](char expected, char c) {
    return expected == 'd' ? std::isdigit(static_cast<unsigned char>(c)) != 0
                           : c == '-' || c == '/';
  });
}

bool IsImageName(const std::string& word) {
  return word.find(".png") != std::string::npos || word.find(".jpg") != std::string::npos;
}

/// What a line looks like that is not a single number.
std::string ExplainTimeLine(const TextLine& line) {
  double number = 0;
  if (IsDate(line.words[0])) {
    return "a date; seconds are expected, such as those of the day: awk '{split($2,t,\":\"); "
           "printf "
           "\"%.6f\\n\", t[1]*3600+t[2]*60+t[3]}'";
  }
  const auto first = static_cast<unsigned char>(line.words[0][0]);
  if (std::isalpha(first) != 0 && !IsNumber(line.words[0], &number)) {
    return "a heading or text; start it with # or remove it; one time in s per line is expected";
  }
  if (line.words[0].find(',') != std::string::npos) {
    if (IsImageName(line.words.back())) {
      return "a line of EuRoC's data.csv (time in ns, file name); one time in s per line is "
             "expected: "
             "awk -F, '!/^#/{printf \"%.6f\\n\", $1*1e-9}'";
    }
    return "columns separated by commas, or a decimal comma; one time in s per line is expected, "
           "with "
           "a decimal point";
  }
  if (line.words.size() == 2 && IsImageName(line.words[1])) {
    return "a time and a file name; only the times are expected: awk '{print $1}'";
  }
  if (line.words.size() == 2 && IsNumber(line.words[0], &number) &&
      IsNumber(line.words[1], &number)) {
    return "two columns; only the time in s is expected: awk '{print $2}' if it is the second";
  }
  if (line.words.size() == 8 || line.words.size() == 12) {
    return "a row of poses (" + std::to_string(line.words.size()) + " columns)";
  }
  if (line.words.size() > 1) {
    return std::to_string(line.words.size()) + " columns; only the time in s is expected";
  }
  return "not a number";
}

struct TimeRow {
  int line = 0;
  std::string text;
  double value = 0;
};

std::vector<TimeRow> ReadRows(const std::string& path) {
  std::vector<TimeRow> rows;
  for (const TextLine& line : ReadTextLines(path)) {
    TimeRow row = {line.number, line.words[0], 0};
    if (line.words.size() != 1 || !IsNumber(row.text, &row.value)) {
      throw InputError(path + ":" + std::to_string(line.number) + ": must hold one time in s, '" +
                       Joined(line) + "' is " + ExplainTimeLine(line));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void CheckUnit(const std::string& path, const std::vector<TimeRow>& rows) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < rows.size(); ++i) steps.push_back(rows[i].value - rows[i - 1].value);
  const double median = Quantile(std::move(steps), 0.5);
  const std::string unit = rows.empty() ? "" : OtherTimeUnit(rows[0].value, median);
  if (unit.empty()) return;
  throw InputError(path + WrongTimeUnit(unit, "'" + Shown(rows[0].text) + "', steps of " +
                                                  Format("%.6g", median)));
}

void CheckOrder(const std::string& path, const std::vector<TimeRow>& rows,
                const std::vector<std::int64_t>& utimes) {
  std::size_t num_repeated = 0;
  for (std::size_t i = 1; i < utimes.size(); ++i) num_repeated += utimes[i] == utimes[i - 1];
  if (num_repeated > 0 && num_repeated + 1 == utimes.size()) {
    throw InputError(path + ": all " + std::to_string(utimes.size()) + " times are '" +
                     Shown(rows[0].text) + "': written with too few digits?");
  }
  for (std::size_t i = 1; i < utimes.size(); ++i) {
    if (utimes[i] > utimes[i - 1]) continue;
    const std::string where = path + ":" + std::to_string(rows[i].line) + ": time '" +
                              Shown(rows[i].text) + "' does not come after the previous one, '" +
                              Shown(rows[i - 1].text) + "'";
    throw InputError(where + (num_repeated > 1 ? "; " + std::to_string(num_repeated) + " of " +
                                                     std::to_string(utimes.size()) +
                                                     " repeat: written with too few digits?"
                                               : ""));
  }
}

}  // namespace

std::string OtherTimeUnit(double first, double median_step) {
  // 1e11 s after 1970 is the year 5138; as ms it is 1973.
  if (first > 1e17) return "ns";
  if (first > 1e14) return "us";
  if (first > 1e11) return "ms";
  std::string unit;
  for (const char* name : {"ms", "us", "ns"}) {
    median_step *= 1e-3;
    if (median_step >= 0.005 && median_step <= 1) unit = name;
  }
  return unit;
}

std::string WrongTimeUnit(const std::string& unit, const std::string& shown) {
  const std::string factor = unit == "ms" ? "1e-3" : unit == "us" ? "1e-6" : "1e-9";
  return ": the times are in " + unit + " (" + shown +
         "), expected in s; awk '{$1=sprintf(\"%.6f\"," + " $1*" + factor +
         "); print}' converts them";
}

std::string ExplainSeparators(const TextLine& line) {
  for (const std::string& word : line.words) {
    if (word.find(',') != std::string::npos) {
      return "; numbers must be separated by blanks, not commas";
    }
    if (word.find(';') != std::string::npos) {
      return "; numbers must be separated by blanks, not semicolons";
    }
  }
  return "";
}

std::vector<std::int64_t> ReadTimes(const std::string& path) {
  const std::vector<TimeRow> rows = ReadRows(path);
  CheckUnit(path, rows);
  std::vector<std::int64_t> utimes;
  for (const TimeRow& row : rows) {
    std::int64_t utime = 0;
    if (!ParseMicroseconds(row.text, &utime)) {
      throw InputError(path + ":" + std::to_string(row.line) + ": '" + Shown(row.text) +
                       "' is not a time in s");
    }
    utimes.push_back(utime);
  }
  CheckOrder(path, rows, utimes);
  return utimes;
}

}  // namespace airdos
