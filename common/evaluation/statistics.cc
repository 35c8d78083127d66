#include "common/evaluation/statistics.h"

#include <algorithm>
#include <cmath>

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
  const std::size_t middle = values.size() / 2;
  statistics.median =
      values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return statistics;
}

}  // namespace airdos
