#include "common/evaluation/statistics.h"

#include <algorithm>
#include <cmath>

#include "common/util/quantile.h"

namespace airdos {

Statistics ComputeStatistics(std::vector<double> values) {
  Statistics statistics;
  statistics.count = values.size();
  if (values.empty()) return statistics;
  const double n = static_cast<double>(values.size());
  std::sort(values.begin(), values.end());
  double sum = 0;
  double sum_of_squares = 0;
  for (const double value : values) {
    sum += value;
    sum_of_squares += value * value;
  }
  statistics.mean = sum / n;
  statistics.rmse = std::sqrt(sum_of_squares / n);
  double sum_of_deviations = 0;
  for (const double value : values) {
    sum_of_deviations += (value - statistics.mean) * (value - statistics.mean);
  }
  statistics.std = std::sqrt(sum_of_deviations / n);
  statistics.max = values.back();
  statistics.median = Quantile(std::move(values), 0.5);
  return statistics;
}

}  // namespace airdos
