#ifndef AIRDOS_COMMON_EVALUATION_STATISTICS_H_
#define AIRDOS_COMMON_EVALUATION_STATISTICS_H_

#include <cstddef>
#include <vector>

namespace airdos {

/// Statistics of a set of non-negative errors, in their unit.
struct Statistics {
  std::size_t count = 0;
  double rmse = 0;
  double mean = 0;
  double median = 0;  ///< mean of the two middle ones if the count is even
  double max = 0;
  double std = 0;  ///< normalised by the count
};

/// All zero if there are no values.
Statistics ComputeStatistics(std::vector<double> values);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_STATISTICS_H_
