#include "common/dataset/recording/recording_times.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>

#include "common/dataset/file_name.h"
#include "common/dataset/image_rows.h"
#include "common/dataset/sequence_files.h"
#include "common/dataset/times_file.h"
#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/quantile.h"
#include "common/util/text_file.h"
#include "common/util/words.h"

namespace airdos {
namespace {

struct Row {
  int line = 0;
  std::string time;  // as it stands in the file
  std::string stem;
  bool is_date = false;
};

std::string Where(const std::string& path, const Row& row) {
  return path + ":" + std::to_string(row.line) + ": ";
}

bool IsNumber(const std::string& word) {
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  return !word.empty() && end == word.c_str() + word.size() && std::isfinite(number);
}

bool IsImageName(const std::string& word) {
  std::string ending = std::filesystem::path(word).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

bool IsDate(const std::string& word) {
  int year = 0, month = 0, day = 0, length = 0;
  return std::sscanf(word.c_str(), "%4d%*1[-/]%2d%*1[-/]%2d%n", &year, &month, &day, &length) ==
             3 &&
         static_cast<std::size_t>(length) == word.size();
}

/// What a line holds; nothing if it is neither a time nor a time and a file name.
std::optional<Row> ParseRow(const TextLine& line) {
  const std::vector<std::string> columns = ColumnsOf(line);
  Row row;
  row.line = line.number;
  std::vector<std::string> times;
  for (const std::string& column : columns) {
    if (IsImageName(column)) {
      row.stem = std::filesystem::path(column).stem().string();
    } else {
      times.push_back(column);
    }
  }
  if (times.size() == 2 && IsDate(times[0])) {
    row.time = times[0] + " " + times[1];
    row.is_date = true;
    return row;
  }
  if (times.size() != 1 || !IsNumber(times[0])) return std::nullopt;
  row.time = times[0];
  return row;
}

/// Days from 1970-01-01 to a date of the Gregorian calendar.
std::int64_t DaysSince1970(int year, int month, int day) {
  const std::int64_t y = month <= 2 ? year - 1 : year;  // years that begin in March
  const std::int64_t day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return 365 * y + y / 4 - y / 100 + y / 400 + day_of_year - 719468;
}

int DaysOfMonth(int year, int month) {
  const auto [next_year, next_month] =
      month == 12 ? std::make_pair(year + 1, 1) : std::make_pair(year, month + 1);
  return static_cast<int>(DaysSince1970(next_year, next_month, 1) - DaysSince1970(year, month, 1));
}

bool ParseDate(const std::string& text, std::int64_t* utime) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, length = 0;
  if (std::sscanf(text.c_str(), "%4d%*1[-/]%2d%*1[-/]%2d %2d:%2d:%n", &year, &month, &day, &hour,
                  &minute, &length) != 5 ||
      length == 0) {
    return false;
  }
  std::int64_t second_us = 0;
  if (!ParseMicroseconds(text.substr(static_cast<std::size_t>(length)), &second_us)) return false;
  const auto lies_in = [](int value, int from, int to) { return value >= from && value <= to; };
  constexpr std::int64_t kEnd_us = 61000000;  // of a minute with a leap second
  if (year < 0 || !lies_in(month, 1, 12) || !lies_in(day, 1, DaysOfMonth(year, month)) ||
      !lies_in(hour, 0, 23) || !lies_in(minute, 0, 59) || second_us < 0 || second_us >= kEnd_us) {
    return false;
  }
  *utime = ((DaysSince1970(year, month, day) * 24 + hour) * 60 + minute) * 60000000 + second_us;
  return true;
}

bool ParseTime(const Row& row, const std::string& unit, std::int64_t* utime) {
  if (row.is_date) return ParseDate(row.time, utime);
  const int power_of_unit = unit == "ms" ? -3 : unit == "us" ? -6 : unit == "ns" ? -9 : 0;
  const std::size_t e = row.time.find_first_of("eE");  // as NumPy writes: 1.403636579763555584e+18
  long power = 0;
  if (e != std::string::npos) power = std::strtol(row.time.c_str() + e + 1, nullptr, 10);
  constexpr long kMaxPower = 400;  // of any number that is finite
  power = std::clamp(power, -kMaxPower, kMaxPower) + power_of_unit;
  // Exact: nanoseconds since 1970 have more digits than a double can hold.
  return ParseMicroseconds(row.time.substr(0, e) + "e" + std::to_string(power), utime);
}

std::string UnitOf(const std::vector<Row>& rows) {
  if (rows[0].is_date) return "dates";
  std::vector<double> steps;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    steps.push_back(std::atof(rows[i].time.c_str()) - std::atof(rows[i - 1].time.c_str()));
  }
  const double step = steps.empty() ? 0 : Quantile(std::move(steps), 0.5);
  const std::string unit = OtherTimeUnit(std::atof(rows[0].time.c_str()), step);
  return unit.empty() ? "s" : unit;
}

std::vector<Row> ReadRows(const std::string& path) {
  std::vector<Row> rows;
  bool is_first = true;
  for (const TextLine& line : ReadTextLines(path)) {
    std::optional<Row> row = ParseRow(line);
    const std::vector<std::string> columns = ColumnsOf(line);
    const bool is_heading =
        is_first && std::none_of(columns.begin(), columns.end(), [](const std::string& column) {
          return std::isdigit(static_cast<unsigned char>(column[0])) != 0;
        });
    is_first = false;
    if (!row && is_heading) continue;
    if (!row) {
      throw InputError(path + ":" + std::to_string(line.number) +
                       ": must hold a time, or a time and the name of an image, is '" +
                       Shown(JoinWords(line.words, " ")) + "'");
    }
    if (!rows.empty() && rows[0].is_date != row->is_date) {
      throw InputError(Where(path, *row) + "a date and a number are mixed: '" + Shown(row->time) +
                       "'");
    }
    rows.push_back(std::move(*row));
  }
  if (rows.empty()) throw InputError(path + ": holds no time");
  return rows;
}

void CheckIncrease(const std::string& path, const std::vector<Row>& rows,
                   const std::vector<std::int64_t>& utimes) {
  for (std::size_t i = 1; i < utimes.size(); ++i) {
    if (utimes[i] > utimes[i - 1]) continue;
    throw InputError(Where(path, rows[i]) + "time '" + Shown(rows[i].time) +
                     "' does not come after the previous one, '" + Shown(rows[i - 1].time) + "'" +
                     (utimes[i] == utimes[i - 1] ? ": written with too few digits?" : ""));
  }
}

}  // namespace

std::vector<std::string> ColumnsOf(const TextLine& line) {
  std::vector<std::string> columns;
  for (const std::string& word : line.words) {
    std::string column;
    for (const char c : word + ",") {
      if (c != ',' && c != ';') {
        column += c;
        continue;
      }
      if (!column.empty()) columns.push_back(column);
      column.clear();
    }
  }
  return columns;
}

RecordingTimes ReadRecordingTimes(const std::string& path) {
  const std::vector<Row> rows = ReadRows(path);
  RecordingTimes times;
  times.path = path;
  times.unit = UnitOf(rows);
  for (const Row& row : rows) {
    std::int64_t utime = 0;
    if (!ParseTime(row, times.unit, &utime)) {
      throw InputError(Where(path, row) + "'" + Shown(row.time) + "' is not a " +
                       (row.is_date ? "date and time of day" : "time in " + times.unit));
    }
    times.utimes.push_back(utime);
    times.stems.push_back(row.stem);
  }
  CheckIncrease(path, rows, times.utimes);
  const bool has_all =
      std::none_of(rows.begin(), rows.end(), [](const Row& row) { return row.stem.empty(); });
  if (!has_all) times.stems.clear();
  return times;
}

std::vector<std::optional<std::int64_t>> TimesOfImages(const RecordingTimes& times,
                                                       const ImageNames& images,
                                                       std::vector<std::string>* notes) {
  std::map<std::string, std::int64_t> by_stem;
  for (std::size_t i = 0; i < times.stems.size(); ++i) by_stem[times.stems[i]] = times.utimes[i];
  std::vector<std::optional<std::int64_t>> utimes;
  std::vector<std::string> without;
  for (const std::string& file : images.files) {
    const auto it = by_stem.find(std::filesystem::path(file).stem().string());
    const bool is_found = it != by_stem.end();
    utimes.push_back(is_found ? std::optional<std::int64_t>(it->second) : std::nullopt);
    if (!is_found) without.push_back(file);
  }
  if (without.size() < images.files.size()) {  // the names are those of these images
    if (!without.empty()) {
      notes->push_back(times.path + ": holds no time of " + FirstFew(without) + ": skipped");
    }
    return utimes;
  }
  utimes.clear();
  for (const std::size_t row :
       RowsOfImages(times.path, "times", times.utimes.size(), images, notes)) {
    utimes.emplace_back(times.utimes[row]);
  }
  return utimes;
}

std::int64_t TimeAtRate(std::size_t index, double rate_hz) {
  return static_cast<std::int64_t>(std::llround(1e6 * static_cast<double>(index) / rate_hz));
}

std::vector<std::int64_t> TimesAtRate(std::size_t count, double rate_hz) {
  if (!(rate_hz > 0))
    throw InputError(Format("a rate of %g images a second is not positive", rate_hz));
  std::vector<std::int64_t> utimes;
  for (std::size_t i = 0; i < count; ++i) utimes.push_back(TimeAtRate(i, rate_hz));
  return utimes;
}

}  // namespace airdos
