#ifndef AIRDOS_COMMON_UTIL_QUANTILE_H_
#define AIRDOS_COMMON_UTIL_QUANTILE_H_

#include <vector>

namespace airdos {

/// The value that `fraction` (0..1) of the values lie below, for reports and checks. With the n
/// values sorted as x_0 .. x_(n-1), it is what stands at h = fraction (n - 1), interpolated on a
/// line between the two around it: definition 7 of Hyndman and Fan (1996), which NumPy, R and
/// spreadsheets take, too. So 0 gives the least value, 1 the greatest, and 0.5 the median, the mean
/// of the two in the middle where n is even. Infinite values are values; NaN is none. 0 of no
/// values.
double Quantile(std::vector<double> values, double fraction);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_QUANTILE_H_
