#include "common/evaluation/trajectory_file.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "common/evaluation/trajectory_columns.h"
#include "common/evaluation/trajectory_times.h"
#include "common/util/error.h"
#include "common/util/quantile.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

/// A row as read, before it is known which rows are poses.
struct Row {
  int line = 0;
  double time = 0;
  TrajectoryPose pose;
  bool has_position = true;
  bool has_rotation = true;
  double quaternion_length = 1;
};

std::string Where(const std::string& path, int line) {
  return path + ":" + std::to_string(line) + ": ";
}

/// The number in a field; nothing if the field denotes a missing value.
std::optional<double> NumberOf(const std::string& field, const std::string& where) {
  if (IsNoValue(field)) return std::nullopt;
  if (!IsNumber(field)) throw InputError(where + "'" + Shown(field) + "' is not a finite number");
  return std::strtod(field.c_str(), nullptr);
}

void ReadQuaternion(const std::vector<std::string>& fields, const std::array<std::size_t, 4>& at,
                    const std::string& where, Row* row) {
  Eigen::Vector4d xyzw = Eigen::Vector4d::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    const std::optional<double> number = NumberOf(fields[at[i]], where);
    if (!number) row->has_rotation = false;
    xyzw[static_cast<Eigen::Index>(i)] = number.value_or(0);
  }
  if (xyzw.isZero(0)) row->has_rotation = false;
  if (!row->has_rotation) return;
  constexpr double kFewDigits = 0.1;
  const Eigen::Quaterniond q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  row->quaternion_length = q.norm();
  if (!(std::abs(q.norm() - 1) <= kFewDigits)) {
    throw InputError(where + "the quaternion is not of length 1 but " + std::to_string(q.norm()) +
                     "; the columns are not those of TUM (t x y z qx qy qz qw)?");
  }
  row->pose.rotation = q.normalized().toRotationMatrix();
}

void ReadMatrix(const std::vector<std::string>& fields, const std::string& where, Row* row) {
  std::array<double, 12> n = {};
  for (std::size_t i = 0; i < n.size(); ++i) {
    const std::optional<double> number = NumberOf(fields[i], where);
    if (!number) row->has_position = false;
    n[i] = number.value_or(0);
  }
  TrajectoryPose& pose = row->pose;
  pose.rotation << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  pose.position_m = {n[3], n[7], n[11]};
  if (pose.rotation.isZero(0)) row->has_position = false;
  if (!row->has_position) return;
  constexpr double kRoundingOfFiles = 1e-2;
  if (!(pose.rotation * pose.rotation.transpose()).isIdentity(kRoundingOfFiles) ||
      pose.rotation.determinant() < 0) {
    throw InputError(where + "columns 1-3, 5-7 and 9-11 are not a rotation");
  }
}

Row ReadRow(const std::vector<std::string>& fields, const TrajectoryColumns& columns,
            const std::string& where) {
  Row row;
  if (columns.is_matrix) {
    ReadMatrix(fields, where, &row);
    return row;
  }
  if (columns.time) {
    const std::string& field = fields[*columns.time];
    if (!IsNumber(field)) throw InputError(where + "'" + Shown(field) + "' is not a finite number");
    row.time = std::strtod(field.c_str(), nullptr);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = NumberOf(fields[columns.position[i]], where);
    if (!number) row.has_position = false;
    row.pose.position_m[static_cast<Eigen::Index>(i)] = number.value_or(0);
  }
  if (columns.quaternion) ReadQuaternion(fields, *columns.quaternion, where, &row);
  return row;
}

/// Recognises words that show that the file is something else.
void CheckIsRows(const std::string& path, const TextLine& first) {
  const std::string& word = first.words[0];
  const std::string where = Where(path, first.number);
  if (word[0] == '{' || word[0] == '[') {
    throw InputError(where + "is JSON; expected are rows of numbers (TUM: t x y z qx qy qz qw)");
  }
  const auto is_control = [](unsigned char c) { return c < 0x20; };
  if (std::any_of(word.begin(), word.end(), is_control)) {
    throw InputError(where +
                     "is not a text file; expected are rows of numbers (TUM: t x y z qx qy qz "
                     "qw; airdos-map export writes one)");
  }
}

std::vector<Row> ReadRows(const std::string& path, TrajectoryColumns* columns) {
  std::string heading;
  std::vector<TextLine> lines = ReadTextLines(path, &heading);
  if (lines.empty()) throw InputError(path + ": contains no pose");
  CheckIsRows(path, lines[0]);
  std::size_t first = 0;
  const std::vector<std::string> names = SplitFields(lines[0], Where(path, lines[0].number));
  if (names.size() > 2 && !IsNumber(names[0]) && !IsNumber(names[1]) && !IsNoValue(names[0])) {
    heading.clear();
    for (const std::string& word : lines[0].words) heading += " " + word;
    first = 1;
  }
  std::vector<Row> rows;
  for (std::size_t i = first; i < lines.size(); ++i) {
    const std::string where = Where(path, lines[i].number);
    const std::vector<std::string> fields = SplitFields(lines[i], where);
    const bool has_commas = fields.size() > lines[i].words.size() ||
                            lines[i].words[0].find_first_of(",;") != std::string::npos;
    if (i == first) *columns = FindColumns(where, heading, fields, has_commas);
    if (fields.size() != columns->num_columns) {
      throw InputError(where + "must hold " + std::to_string(columns->num_columns) +
                       " numbers like the rows above, holds " + std::to_string(fields.size()));
    }
    rows.push_back(ReadRow(fields, *columns, where));
    rows.back().line = lines[i].number;
  }
  if (rows.empty()) throw InputError(path + ": contains no pose");
  return rows;
}

/// Median step between neighbouring rows that are both away from the origin.
double MedianStep(const std::vector<Row*>& rows) {
  std::vector<double> steps_m;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Eigen::Vector3d& a = rows[i - 1]->pose.position_m;
    const Eigen::Vector3d& b = rows[i]->pose.position_m;
    if (!a.isZero(0) && !b.isZero(0)) steps_m.push_back((b - a).norm());
  }
  return Quantile(std::move(steps_m), 0.5);
}

/// Removes the position from rows exactly at the origin whose neighbour is many steps away: this is
/// how some programs record that they lost the camera. A trajectory that starts at the origin is
/// not affected.
std::size_t MarkLostAtOrigin(std::vector<Row>* rows, int* first_line) {
  constexpr double kJump = 3;  // in median steps
  constexpr double kJumpAtStart = 10;
  std::vector<Row*> posed;
  for (Row& row : *rows) {
    if (row.has_position) posed.push_back(&row);
  }
  const double step_m = MedianStep(posed);
  if (step_m <= 0) return 0;
  const auto distance_m = [&](std::size_t i) { return posed[i]->pose.position_m.norm(); };
  std::size_t num_lost = 0;
  for (std::size_t begin = 0, end = 0; begin < posed.size(); begin = end + 1) {
    end = begin;
    while (end < posed.size() && distance_m(end) == 0) ++end;
    if (end == begin) continue;
    double jump_m = begin > 0 ? distance_m(begin - 1) : 0;
    if (end < posed.size()) jump_m = std::max(jump_m, distance_m(end));
    if (jump_m <= (begin == 0 ? kJumpAtStart : kJump) * step_m) continue;
    for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i) {
      if (num_lost == 0) *first_line = posed[i]->line;
      posed[i]->has_position = false;
      ++num_lost;
    }
  }
  return num_lost;
}

/// Rows with missing numbers are not poses, unless hardly any row has a rotation: then the file
/// contains positions only.
void MarkLost(const TrajectoryColumns& columns, std::vector<Row>* rows, Trajectory* trajectory) {
  const auto num_rotations = static_cast<std::size_t>(
      std::count_if(rows->begin(), rows->end(), [](const Row& row) { return row.has_rotation; }));
  const bool is_named = columns.is_matrix || columns.quaternion.has_value();
  trajectory->has_rotations = is_named && 10 * num_rotations >= rows->size() && num_rotations > 0;
  std::size_t num_lost = 0;
  int first_line = 0;
  for (Row& row : *rows) {
    if (trajectory->has_rotations && !row.has_rotation) row.has_position = false;
    if (row.has_position) continue;
    if (num_lost == 0) first_line = row.line;
    ++num_lost;
  }
  if (num_lost > 0) {
    trajectory->remarks.push_back(
        {true, Where(trajectory->path, first_line) + std::to_string(num_lost) +
                   " rows (this is the first) hold no pose (nan or a rotation of zeros): they "
                   "count as frames without a pose"});
  }
  const std::size_t num_at_origin = MarkLostAtOrigin(rows, &first_line);
  if (num_at_origin > 0) {
    trajectory->remarks.push_back(
        {true, Where(trajectory->path, first_line) + std::to_string(num_at_origin) +
                   " rows (this is the first) lie exactly at the origin, far from the rows around "
                   "them: they count as frames without a pose"});
  }
  trajectory->num_lost_rows = num_lost + num_at_origin;
}

void RemarkOnForm(const TrajectoryColumns& columns, const std::vector<Row>& rows,
                  Trajectory* trajectory) {
  const char* const order = columns.order == QuaternionOrder::kWxyz ? ", quaternions w x y z" : "";
  if (!columns.form.empty() || *order != '\0') {
    trajectory->remarks.push_back({false, trajectory->path + ": read as " + columns.form + order});
  }
  if (columns.quaternion && !trajectory->has_rotations) {
    trajectory->remarks.push_back(
        {false, trajectory->path + ": hardly any row has a rotation: read as positions only"});
  }
  constexpr double kRounding = 1e-2;
  for (const Row& row : rows) {
    if (std::abs(row.quaternion_length - 1) <= kRounding) continue;
    trajectory->remarks.push_back(
        {true, Where(trajectory->path, row.line) + "the quaternion is of length " +
                   std::to_string(row.quaternion_length) +
                   ", normalised: written with few digits? This affects rotation figures"});
    return;
  }
}

}  // namespace

Trajectory ReadTrajectory(const std::string& path) {
  Trajectory trajectory;
  trajectory.path = path;
  TrajectoryColumns columns;
  std::vector<Row> rows = ReadRows(path, &columns);
  trajectory.has_times = columns.time.has_value();
  trajectory.order = columns.order;
  MarkLost(columns, &rows, &trajectory);
  RemarkOnForm(columns, rows, &trajectory);
  std::vector<double> times_s;
  if (trajectory.has_times) {
    std::vector<FileTime> times;
    for (const Row& row : rows) times.push_back({row.time, row.line});
    times_s = TimesInSeconds(path, times, &trajectory.remarks);
  } else {
    for (std::size_t i = 0; i < rows.size(); ++i) times_s.push_back(static_cast<double>(i));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].has_position) continue;
    trajectory.poses.push_back(rows[i].pose);
    trajectory.poses.back().time_s = times_s[i];
  }
  if (trajectory.poses.empty()) throw InputError(path + ": contains no pose");
  return trajectory;
}

void SetTimes(const std::string& times_path, Trajectory* trajectory) {
  std::vector<FileTime> times;
  for (const TextLine& line : ReadTextLines(times_path)) {
    const std::vector<double> numbers = ParseNumbers(times_path, line, 0);
    const bool is_later = times.empty() || numbers[0] > times.back().time;
    if (numbers.size() != 1 || !is_later) {
      throw InputError(Where(times_path, line.number) +
                       "must hold one time (s), later than the previous one");
    }
    times.push_back({numbers[0], line.number});
  }
  if (times.size() != trajectory->num_rows()) {
    throw InputError(times_path + ": holds " + std::to_string(times.size()) + " times, " +
                     NameOf("trajectory", *trajectory) + " has " +
                     std::to_string(trajectory->num_rows()) +
                     " rows: one time per row is needed; add rows of nan for the frames "
                     "without a pose, or the times of its rows");
  }
  const std::vector<double> times_s = TimesInSeconds(times_path, times, &trajectory->remarks);
  for (TrajectoryPose& pose : trajectory->poses) {
    pose.time_s = times_s[static_cast<std::size_t>(pose.time_s)];  // row number
  }
  trajectory->has_times = true;
}

void SetTimesOfPair(const std::string& times_path, Trajectory* estimate, Trajectory* ground_truth) {
  if (estimate->has_times && ground_truth->has_times) {
    throw InputError(times_path + ": is not needed, " + NameOf("estimate", *estimate) + " and " +
                     NameOf("ground truth", *ground_truth) + " have times; omit --times");
  }
  const bool is_for_both = !estimate->has_times && !ground_truth->has_times;
  if (is_for_both && estimate->num_rows() != ground_truth->num_rows()) {
    const std::size_t num_times = ReadTextLines(times_path).size();
    const bool fits_estimate = num_times == estimate->num_rows();
    const bool fits_truth = num_times == ground_truth->num_rows();
    throw InputError(
        times_path + ": holds " + std::to_string(num_times) + " times and fits " +
        (fits_estimate ? "the estimate only"
         : fits_truth  ? "the ground truth only"
                       : "neither file") +
        ": " + NameOf("estimate", *estimate) + " has " + std::to_string(estimate->num_rows()) +
        " rows, " + NameOf("ground truth", *ground_truth) + " " +
        std::to_string(ground_truth->num_rows()) +
        "; provide the shorter one as TUM with times, or with rows of nan for the frames without a "
        "pose");
  }
  if (!estimate->has_times) SetTimes(times_path, estimate);
  if (!ground_truth->has_times) SetTimes(times_path, ground_truth);
}

}  // namespace airdos
