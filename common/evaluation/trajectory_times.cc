#include "common/evaluation/trajectory_times.h"

#include <algorithm>
#include <cmath>

#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

struct Unit {
  double seconds = 1;
  const char* name = "s";
};
constexpr Unit kUnits[] = {{1, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}};
constexpr double kLeastIntervalS = 0.0005;
constexpr double kMostIntervalS = 2;
constexpr double kYear2100S = 4.1e9;
constexpr double kYear1985S = 4.7e8;
/// Key frames and satellite positions may be this rare.
constexpr double kSparseIntervalS = 10;
constexpr double kSparseIntervalSinceEpochS = 400;
constexpr double kMostRepeated = 0.1;
constexpr double kFewRepeated = 0.005;

std::vector<double> IntervalsOf(const std::vector<TrajectoryPose>& poses) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    intervals_s.push_back(poses[i].time_s - poses[i - 1].time_s);
  }
  return intervals_s;
}

double MedianOf(const std::vector<FileTime>& times) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times.size(); ++i) {
    intervals.push_back(times[i].time - times[i - 1].time);
  }
  return Quantile(intervals, 0.5);
}

const char* NameOfUnit(double seconds) {
  for (const Unit& unit : kUnits) {
    if (unit.seconds == seconds) return unit.name;
  }
  return "s";
}

void CheckOrder(const std::string& path, const std::vector<FileTime>& times) {
  std::size_t num_back = 0;
  const FileTime* first = nullptr;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i].time >= times[i - 1].time) continue;
    if (first == nullptr) first = &times[i];
    ++num_back;
  }
  if (first == nullptr) return;
  const bool is_reversed = num_back + 1 == times.size() && num_back > 1;
  throw InputError(
      path + Format(":%d: time %.17g is before that of the row above; ", first->line, first->time) +
      (is_reversed ? "all rows run backwards in time: reverse them (tac)"
                   : "sort the rows by time (sort -g), without duplicates"));
}

void CheckRepetition(const std::string& path, const std::vector<FileTime>& times,
                     Remarks* remarks) {
  std::size_t num_repeated = 0;
  const FileTime* first = nullptr;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i].time != times[i - 1].time) continue;
    if (first == nullptr) first = &times[i];
    ++num_repeated;
  }
  if (first == nullptr) return;
  const std::string what =
      path +
      Format(":%d: times repeat: %zu of %zu rows have the time of the row above (first %.17g)",
             first->line, num_repeated, times.size(), first->time);
  const double share = static_cast<double>(num_repeated) / static_cast<double>(times.size());
  if (share > kMostRepeated) {
    throw InputError(what +
                     "; they were written with too few digits, write s with six decimals (%.6f)");
  }
  remarks->push_back(
      {share > kFewRepeated,
       what + "; rows of the same time may be compared with a pose of another time"});
}

/// Whether the times are 0, 1, 2, ... or count on from another small integer.
bool CountRows(const std::vector<FileTime>& times) {
  const bool starts_small =
      times.size() > 2 && times[0].time < kYear1985S && times[0].time == std::floor(times[0].time);
  double next = times.empty() ? 0 : times[0].time;
  return starts_small && std::all_of(times.begin(), times.end(),
                                     [&](const FileTime& t) { return t.time == next++; });
}

void JudgeUnit(const std::string& path, const std::vector<FileTime>& times, double unit_s,
               Remarks* remarks) {
  const double median = MedianOf(times);
  if (unit_s != 1) {
    remarks->push_back({false, path + Format(": the times are in %s (median interval %.6g) and were"
                                             " converted to s",
                                             NameOfUnit(unit_s), median)});
    return;
  }
  const bool counts_rows = CountRows(times);
  if (counts_rows) {
    remarks->push_back(
        {true, path + Format(": the times %.0f, %.0f, %.0f, ... are numbers of rows "
                             "rather than s: durations and rates are then meaningless",
                             times[0].time, times[1].time, times[2].time)});
  } else if (times.size() > 1 && (median < kLeastIntervalS || median > kSparseIntervalS)) {
    remarks->push_back({true, path + Format(": the median interval of the times is %.6g s: are "
                                            "they in s?",
                                            median)});
  }
}

std::string RangeOf(const std::vector<TrajectoryPose>& poses) {
  const double first_s = poses.front().time_s;
  const double last_s = poses.back().time_s;
  return Format("%.6f to %.6f s (%zu poses in %.3f s)", first_s, last_s, poses.size(),
                last_s - first_s);
}

/// The factor that makes the times of `a` overlap those of `b` with similar start and duration; 0
/// if there is none.
double FactorBetween(const std::vector<TrajectoryPose>& a, const std::vector<TrajectoryPose>& b) {
  const double duration_a_s = a.back().time_s - a.front().time_s;
  const double duration_b_s = b.back().time_s - b.front().time_s;
  for (const double factor : {1e3, 1e6, 1e9, 1e-3, 1e-6, 1e-9}) {
    const bool overlap = factor * a.front().time_s <= b.back().time_s &&
                         factor * a.back().time_s >= b.front().time_s;
    const double ratio = factor * duration_a_s / std::max(duration_b_s, 1e-12);
    if (overlap && ratio > 0.1 && ratio < 10) return factor;
  }
  return 0;
}

/// Why times that do not overlap may differ by `offset_s`.
std::string ExplainOffset(double offset_s) {
  constexpr double kGpsEpochS = 315964800;
  constexpr double kMostLeapS = 40;
  const double size_s = std::abs(offset_s);
  const double hours = std::round(size_s / 3600);
  const char* why = "they come from different clocks";
  if (size_s > kYear1985S) {
    why = "one counts from 1970, the other from another origin";
  } else if (std::abs(size_s - kGpsEpochS) < kMostLeapS) {
    why = "one is GPS time, the other since 1970";
  } else if (hours >= 1 && hours <= 24 && std::abs(size_s - 3600 * hours) < 60) {
    why = "whole hours: one is local time";
  }
  return Format("the first poses are %.6f s apart, %s; shift the times of one file", size_s, why);
}

}  // namespace

double UnitOfTimes(const std::vector<FileTime>& times) {
  if (times.empty()) return 1;
  const double most = std::max(std::abs(times.front().time), std::abs(times.back().time));
  const double median = MedianOf(times);
  const double sparse =
      most > kYear1985S && most < kYear2100S ? kSparseIntervalSinceEpochS : kSparseIntervalS;
  if (most < kYear2100S && median <= sparse) return 1;
  for (const Unit& unit : kUnits) {
    const bool is_before_2100 = unit.seconds * most < kYear2100S;
    const bool is_interval =
        unit.seconds * median >= kLeastIntervalS && unit.seconds * median <= kMostIntervalS;
    if (is_before_2100 && (is_interval || times.size() == 1)) return unit.seconds;
  }
  // Infrequent poses, with times since 1970 in a small unit.
  for (const Unit& unit : kUnits) {
    const double most_s = unit.seconds * most;
    if (most_s > kYear1985S && most_s < kYear2100S && unit.seconds * median <= sparse &&
        unit.seconds < 1) {
      return unit.seconds;
    }
  }
  return 1;
}

std::vector<double> TimesInSeconds(const std::string& path, const std::vector<FileTime>& times,
                                   Remarks* remarks) {
  CheckOrder(path, times);
  CheckRepetition(path, times, remarks);
  const double unit_s = UnitOfTimes(times);
  JudgeUnit(path, times, unit_s, remarks);
  std::vector<double> times_s;
  for (const FileTime& t : times) times_s.push_back(unit_s * t.time);
  return times_s;
}

double MedianInterval(const std::vector<TrajectoryPose>& poses) {
  return Quantile(IntervalsOf(poses), 0.5);
}

double ShortInterval(const std::vector<TrajectoryPose>& poses) {
  return Quantile(IntervalsOf(poses), 0.1);
}

std::string CompareTimes(const Trajectory& estimate, const Trajectory& ground_truth,
                         double max_time_difference_s) {
  const std::vector<TrajectoryPose>& a = estimate.poses;
  const std::vector<TrajectoryPose>& b = ground_truth.poses;
  std::string text = NameOf("estimate", estimate) + " spans " + RangeOf(a) + ", " +
                     NameOf("ground truth", ground_truth) + " " + RangeOf(b) + ": ";
  const double factor = FactorBetween(a, b);
  const bool overlap = a.front().time_s <= b.back().time_s && b.front().time_s <= a.back().time_s;
  if (factor != 0) {
    return text + Format(
                      "the times differ by a factor of %.0e, one file is in another unit; "
                      "convert both to s",
                      factor);
  }
  if (!overlap) return text + ExplainOffset(a.front().time_s - b.front().time_s);
  double nearest_s = 1e300;
  std::size_t j = 0;
  for (const TrajectoryPose& pose : a) {
    while (j + 1 < b.size() && b[j + 1].time_s <= pose.time_s) ++j;
    nearest_s = std::min(nearest_s, std::abs(b[j].time_s - pose.time_s));
    if (j + 1 < b.size()) nearest_s = std::min(nearest_s, b[j + 1].time_s - pose.time_s);
  }
  return text + Format(
                    "they overlap, but the nearest times are %.6f s apart and --max-diff is "
                    "%.6f s; are the times of one rounded, or shifted by part of a frame?",
                    nearest_s, max_time_difference_s);
}

std::size_t FramesOfSlowerEstimate(const Trajectory& estimate, const Trajectory& ground_truth) {
  constexpr double kHigherRate = 1.5;
  constexpr double kRegular = 0.25;  // relative to the interval
  const double interval_s = MedianInterval(estimate.poses);
  const double truth_interval_s = MedianInterval(ground_truth.poses);
  const bool has_fewer_rows = estimate.num_rows() < ground_truth.num_rows();
  if (!has_fewer_rows || truth_interval_s <= 0 ||
      ShortInterval(estimate.poses) < kHigherRate * truth_interval_s) {
    return 0;
  }
  std::size_t num_regular = 0;
  double num_frames = 1;
  const std::vector<double> intervals_s = IntervalsOf(estimate.poses);
  for (const double interval : intervals_s) {
    const double steps = std::max(1.0, std::round(interval / interval_s));
    num_frames += steps;
    if (std::abs(interval - steps * interval_s) <= kRegular * interval_s) ++num_regular;
  }
  const bool is_regular = 10 * num_regular >= 9 * intervals_s.size();
  constexpr double kMostFrames = 1e9;
  return is_regular && num_frames < kMostFrames
             ? std::max(static_cast<std::size_t>(num_frames), estimate.num_rows())
             : estimate.num_rows();
}

}  // namespace airdos
