#include "common/check/check_times.h"

#include <algorithm>
#include <cmath>

#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr double kMinPeriod_s = 0.005;
constexpr double kMaxPeriod_s = 1;

/// "ms" if the interval would suit a camera if the times were ms instead of s; otherwise "".
std::string OtherUnit(double period_s) {
  std::string unit;
  for (const char* name : {"ms", "us", "ns"}) {
    period_s *= 1e-3;
    if (period_s >= kMinPeriod_s && period_s <= kMaxPeriod_s) unit = name;
  }
  return unit;
}

void CheckRate(double period_s, const std::string& where, FindingList* findings) {
  if (period_s >= kMinPeriod_s && period_s <= kMaxPeriod_s) {
    findings->Note("times.rate", where, Brief(1 / period_s) + " images per second");
    return;
  }
  const std::string interval = "the median interval is " + Brief(period_s) + " s";
  const std::string unit = OtherUnit(period_s);
  if (!unit.empty()) {
    findings->Fail("times.unit", where, interval + ": the times are in " + unit + ", not in s");
  } else if (period_s < kMinPeriod_s / 10) {
    findings->Fail("times.unit", where, interval + ": are the times in s?");
  } else {
    findings->Warn("times.rate", where, interval + ": motion between images may be too large");
  }
}

/// Checks for times that repeat or go back.
void CheckOrder(const std::vector<std::int64_t>& utimes, const std::string& where,
                FindingList* findings) {
  if (utimes.size() > 2 && std::equal(utimes.begin() + 1, utimes.end(), utimes.begin())) {
    findings->Fail("times.order", where,
                   "all " + std::to_string(utimes.size()) + " images have one time, " +
                       std::to_string(utimes[0]) + " us");
    return;
  }
  for (std::size_t i = 1; i < utimes.size(); ++i) {
    const double interval_s = 1e-6 * static_cast<double>(utimes[i] - utimes[i - 1]);
    if (interval_s > 0) continue;
    findings->Fail(
        "times.order", where,
        "image " + std::to_string(i) +
            (interval_s == 0 ? " has the same time as the previous one"
                             : " comes " + Brief(-interval_s) + " s before the previous one"));
  }
}

}  // namespace

void CheckTimes(const std::vector<std::int64_t>& utimes, const std::string& where,
                FindingList* findings) {
  CheckOrder(utimes, where, findings);
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < utimes.size(); ++i) {
    intervals_s.push_back(1e-6 * static_cast<double>(utimes[i] - utimes[i - 1]));
  }
  if (intervals_s.empty()) return;
  const double period_s = Quantile(intervals_s, 0.5);
  if (period_s <= 0) return;
  CheckRate(period_s, where, findings);
  for (std::size_t i = 0; i < intervals_s.size(); ++i) {
    if (intervals_s[i] <= 1.5 * period_s) continue;
    const auto num_missing = std::max(1.0, std::round(intervals_s[i] / period_s) - 1);
    findings->Warn("times.gap", where,
                   Brief(intervals_s[i]) + " s between images " + std::to_string(i) + " and " +
                       std::to_string(i + 1) + ": about " + Brief(num_missing) + " missing");
  }
}

}  // namespace airdos
