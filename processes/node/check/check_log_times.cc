#include "processes/node/check/check_log_times.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/check/check_times.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

// Periods of cameras. The units differ by factors of 1000 and a camera may be slow: among the units
// that would fit, the one closest to 20 images per second is assumed.
constexpr double kMinPeriod_s = 0.004;
constexpr double kMaxPeriod_s = 2;
constexpr double kUsualPeriod_s = 0.05;

std::vector<double> Intervals_us(const std::vector<std::int64_t>& utimes) {
  std::vector<double> intervals_us;
  for (std::size_t i = 1; i < utimes.size(); ++i) {
    // In floating point: the difference of hostile times may not fit into an integer.
    intervals_us.push_back(static_cast<double>(utimes[i]) - static_cast<double>(utimes[i - 1]));
  }
  return intervals_us;
}

/// The unit in which this interval would suit a camera; empty if there is none, or for us.
std::string OtherUnit(double interval) {
  struct Unit {
    const char* name;
    double seconds;
  };
  constexpr std::array<Unit, 4> kUnits{{{"ns", 1e-9}, {"us", 1e-6}, {"ms", 1e-3}, {"s", 1}}};
  const auto distance = [interval](const Unit& unit) {
    return std::abs(std::log(interval * unit.seconds / kUsualPeriod_s));
  };
  const double as_us_s = 1e-6 * interval;
  if (as_us_s >= kMinPeriod_s && as_us_s <= kMaxPeriod_s) return "";
  const Unit* best = &kUnits[0];
  for (const Unit& unit : kUnits) {
    if (distance(unit) < distance(*best)) best = &unit;
  }
  const double period_s = interval * best->seconds;
  return period_s >= kMinPeriod_s && period_s <= kMaxPeriod_s ? best->name : "";
}

/// Whether the times are ordered at all; reports once what is wrong with them.
bool CheckOrder(const std::vector<double>& intervals_us, const std::string& where,
                FindingList* findings) {
  const auto report = [&](auto is_wrong, const std::string& what) {
    const auto first = std::find_if(intervals_us.begin(), intervals_us.end(), is_wrong);
    if (first == intervals_us.end()) return false;
    const auto num = std::count_if(first, intervals_us.end(), is_wrong);
    findings->Fail("times.order", where,
                   std::to_string(num) + " of " + std::to_string(intervals_us.size() + 1) +
                       " images " + what + " the previous one; the first is at place " +
                       std::to_string(first - intervals_us.begin() + 2) + " in the log's order");
    return true;
  };
  const bool goes_back =
      report([](double interval) { return interval < 0; }, "have an earlier capture time than");
  const bool repeats =
      report([](double interval) { return interval == 0; }, "have the same capture time as");
  return !goes_back && !repeats;
}

}  // namespace

void CheckLogTimes(const std::vector<std::int64_t>& utimes, const std::string& where,
                   FindingList* findings) {
  const std::vector<double> intervals_us = Intervals_us(utimes);
  if (intervals_us.empty()) return;
  if (std::all_of(utimes.begin(), utimes.end(), [&](auto utime) { return utime == utimes[0]; })) {
    findings->Fail("times.constant", where,
                   "all " + std::to_string(utimes.size()) + " images have the capture time " +
                       std::to_string(utimes[0]) +
                       " (utime): it must be the time in us at which each was taken");
    return;
  }
  double interval_us = Quantile(intervals_us, 0.5);
  if (interval_us <= 0) {  // times in whole seconds repeat
    interval_us = (static_cast<double>(utimes.back()) - static_cast<double>(utimes[0])) /
                  static_cast<double>(intervals_us.size());
  }
  const std::string unit = interval_us > 0 ? OtherUnit(interval_us) : "";
  if (!unit.empty()) {
    findings->Fail("times.unit", where,
                   "utime is in us, but these are " + unit + ": the interval of the images is " +
                       Brief(interval_us) + ", which would be " + Brief(1e-6 * interval_us) +
                       " s; publish capture times in us");
    return;
  }
  if (CheckOrder(intervals_us, where, findings)) CheckTimes(utimes, where, findings);
}

}  // namespace airdos
