#include "common/evaluation/trajectory_columns.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "common/util/error.h"
#include "common/util/words.h"

namespace airdos {
namespace {

std::string Trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string SmallLetters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// n separators delimit n + 1 fields, some of which may be empty.
std::vector<std::string> SplitAt(char separator, const std::string& text) {
  std::vector<std::string> fields;
  std::size_t begin = 0;
  for (std::size_t end = text.find(separator); end != std::string::npos;
       end = text.find(separator, begin)) {
    fields.push_back(Trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  fields.push_back(Trimmed(text.substr(begin)));
  return fields;
}

std::vector<std::string> SplitAtBlanks(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> fields;
  for (std::string field; stream >> field;) fields.push_back(field);
  return fields;
}

/// Whether it is like "1305031102,1604": a number with a decimal comma.
bool HasDecimalComma(const std::string& field) {
  const std::size_t comma = field.find(',');
  if (comma == 0 || comma == std::string::npos || comma + 1 == field.size()) return false;
  std::string with_point = field;
  with_point[comma] = '.';
  return IsNumber(with_point) && std::isdigit(static_cast<unsigned char>(field[comma + 1])) &&
         std::isdigit(static_cast<unsigned char>(field[comma - 1]));
}

/// The names in a heading, one per column, without units ("[m]"), in lower case.
std::vector<std::string> NamesOf(const std::string& heading) {
  const char separator = heading.find(',') != std::string::npos   ? ','
                         : heading.find(';') != std::string::npos ? ';'
                                                                  : ' ';
  std::vector<std::string> names;
  for (const std::string& field :
       separator == ' ' ? SplitAtBlanks(heading) : SplitAt(separator, heading)) {
    const std::string name = Trimmed(field.substr(0, field.find('[')));
    if (!name.empty()) names.push_back(SmallLetters(name));
  }
  return names;
}

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool EndsWithAnyOf(const std::string& text, const std::vector<std::string>& ends) {
  return std::any_of(ends.begin(), ends.end(),
                     [&](const std::string& end) { return EndsWith(text, end); });
}

bool IsTimeName(const std::string& name) {
  return name == "t" || StartsWith(name, "time") || StartsWith(name, "%time") ||
         StartsWith(name, "utime") || EndsWith(name, "stamp");
}

/// The part before the axis in "q_RS_w", "tx", "pose.position.x", without trailing separators.
std::string StemOf(const std::string& name) {
  std::string stem = name.substr(0, name.size() - 1);
  while (!stem.empty() && std::string("._- ").find(stem.back()) != std::string::npos) {
    stem.pop_back();
  }
  return stem;
}

bool IsPositionStem(const std::string& stem) {
  return stem.empty() || stem == "t" || StartsWith(stem, "p_") || stem == "p" ||
         EndsWithAnyOf(stem, {"pos", "position", "translation", "trans"});
}

bool IsQuaternionStem(const std::string& stem) {
  return stem == "q" || StartsWith(stem, "q_") ||
         EndsWithAnyOf(stem, {"orientation", "rotation", "quat", "quaternion", "rot"});
}

/// The columns named by a heading, if it names a time and a position.
std::optional<TrajectoryColumns> FromHeading(const std::string& heading, std::size_t num_columns) {
  const std::vector<std::string> names = NamesOf(heading);
  if (names.size() != num_columns) return std::nullopt;
  TrajectoryColumns columns;
  columns.num_columns = num_columns;
  std::array<std::optional<std::size_t>, 3> position;
  std::array<std::optional<std::size_t>, 4> quaternion;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::size_t axis = std::string("xyzw").find(names[i].back());
    if (IsTimeName(names[i])) {
      if (!columns.time || EndsWith(names[i], "header.stamp")) columns.time = i;
    } else if (axis != std::string::npos && IsQuaternionStem(StemOf(names[i]))) {
      if (!quaternion[axis]) quaternion[axis] = i;
    } else if (axis < 3 && IsPositionStem(StemOf(names[i]))) {
      if (!position[axis]) position[axis] = i;
    }
  }
  if (!columns.time || !position[0] || !position[1] || !position[2]) return std::nullopt;
  columns.position = {*position[0], *position[1], *position[2]};
  const auto is_named = [](const std::optional<std::size_t>& column) { return column.has_value(); };
  if (std::all_of(quaternion.begin(), quaternion.end(), is_named)) {
    columns.quaternion = {*quaternion[0], *quaternion[1], *quaternion[2], *quaternion[3]};
    columns.order =
        *quaternion[3] < *quaternion[0] ? QuaternionOrder::kWxyz : QuaternionOrder::kXyzw;
  } else if (std::any_of(quaternion.begin(), quaternion.end(), is_named)) {
    return std::nullopt;
  }
  return columns;
}

TrajectoryColumns Matrix(std::size_t num_columns) {
  TrajectoryColumns columns;
  columns.num_columns = num_columns;
  columns.is_matrix = true;
  return columns;
}

TrajectoryColumns Positions(std::size_t num_columns, std::size_t first, bool has_time) {
  TrajectoryColumns columns;
  columns.num_columns = num_columns;
  if (has_time) columns.time = 0;
  columns.position = {first, first + 1, first + 2};
  return columns;
}

TrajectoryColumns Poses(std::size_t num_columns, bool has_time, QuaternionOrder order) {
  const std::size_t first = has_time ? 1 : 0;
  TrajectoryColumns columns = Positions(num_columns, first, has_time);
  const std::size_t q = first + 3;
  columns.order = order;
  if (order == QuaternionOrder::kWxyz) {
    columns.quaternion = {q + 1, q + 2, q + 3, q};
  } else {
    columns.quaternion = {q, q + 1, q + 2, q + 3};
  }
  return columns;
}

bool EndsWithRow0001(const std::vector<std::string>& fields) {
  const std::size_t n = fields.size();
  for (std::size_t i = n - 4; i < n; ++i) {
    if (std::strtod(fields[i].c_str(), nullptr) != (i + 1 == n ? 1 : 0)) return false;
  }
  return true;
}

std::string WhatIsRead() {
  return "expected are 8 (t x y z qx qy qz qw, TUM), 12 (KITTI), 17 (EuRoC's state_groundtruth), 7 "
         "(x y z qx qy qz qw, TartanAir) or 4 (t x y z)";
}

}  // namespace

bool IsNumber(const std::string& field) {
  if (field.empty() || std::isspace(static_cast<unsigned char>(field[0]))) return false;
  char* end = nullptr;
  const double number = std::strtod(field.c_str(), &end);
  return end == field.c_str() + field.size() && std::isfinite(number);
}

bool IsNoValue(const std::string& field) {
  std::string text = SmallLetters(field);
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.erase(0, 1);
  for (const char* const word : {"", "nan", "inf", "infinity", "null", "none", "n/a", "nan(ind)"}) {
    if (text == word) return true;
  }
  return false;
}

std::vector<std::string> SplitFields(const TextLine& line, const std::string& where) {
  const std::string text = JoinWords(line.words, " ");
  const bool has_semicolons = text.find(';') != std::string::npos;
  std::vector<std::string> fields = has_semicolons ? SplitAt(';', text) : line.words;
  const auto num_decimal = std::count_if(fields.begin(), fields.end(), HasDecimalComma);
  if (fields.size() >= 4 && 2 * static_cast<std::size_t>(num_decimal) >= fields.size()) {
    throw InputError(where + "'" + fields[0] +
                     "': numbers have decimal commas; use points (sed 's/,/./g')");
  }
  if (!has_semicolons && text.find(',') != std::string::npos) fields = SplitAt(',', text);
  // "..., 1," ends with a separator, whereas ",,,," contains no pose.
  const bool ends_empty = fields.size() > 1 && fields.back().empty();
  if (ends_empty && !fields[fields.size() - 2].empty()) fields.pop_back();
  return fields;
}

TrajectoryColumns FindColumns(const std::string& where, const std::string& heading,
                              const std::vector<std::string>& first_row, bool has_commas) {
  const std::size_t n = first_row.size();
  if (const std::optional<TrajectoryColumns> named = FromHeading(heading, n)) {
    TrajectoryColumns columns = *named;
    const bool is_tum = n == 8 && columns.order == QuaternionOrder::kXyzw;
    if (!is_tum) columns.form = "columns as its heading names them";
    return columns;
  }
  constexpr double kNsSince1970 = 1e17;
  if (n == 8 && has_commas && std::strtod(first_row[0].c_str(), nullptr) > kNsSince1970) {
    TrajectoryColumns columns = Poses(8, true, QuaternionOrder::kWxyz);
    columns.form = "8 columns between commas behind times in ns, as EuRoC has them";
    return columns;
  }
  if (n == 8) return Poses(8, true, QuaternionOrder::kXyzw);
  if (n == 12) return Matrix(12);
  TrajectoryColumns columns;
  if (n == 7) {
    columns = Poses(7, false, QuaternionOrder::kXyzw);
    columns.form = "7 numbers in a row, as TartanAir has them: x y z qx qy qz qw without times";
  } else if (n == 16 && EndsWithRow0001(first_row)) {
    columns = Matrix(16);
    columns.form = "16 numbers in a row: 4 x 4 matrices without times";
  } else if (n == 17 && !EndsWithRow0001(first_row)) {
    columns = Poses(17, true, QuaternionOrder::kWxyz);
    columns.form = "17 columns, as EuRoC's state_groundtruth has them";
  } else if (n == 4) {
    columns = Positions(4, 1, true);
    columns.form = "4 numbers in a row: a time and a position";
  } else {
    const bool is_numbered_matrix = n == 13 || n == 17;
    throw InputError(where + "holds " + std::to_string(n) + " numbers per row" +
                     (is_numbered_matrix ? " (a number or time before a matrix, as KITTI-360 has "
                                           "it? cut it off with cut -d' ' -f2- and give --times)"
                                         : "") +
                     ": " + WhatIsRead());
  }
  return columns;
}

}  // namespace airdos
