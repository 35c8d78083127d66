#include "common/util/quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/util/check.h"

namespace airdos {

double Quantile(std::vector<double> values, double fraction) {
  AIRDOS_CHECK(fraction >= 0 && fraction <= 1);
  if (values.empty()) return 0;
  const double h = fraction * static_cast<double>(values.size() - 1);
  const double part = h - std::floor(h);
  const auto lower = values.begin() + static_cast<std::ptrdiff_t>(h);
  std::nth_element(values.begin(), lower, values.end());
  if (part == 0) return *lower;
  const double upper = *std::min_element(lower + 1, values.end());
  if (upper == *lower) return upper;  // rounding would find a neighbour of it
  return (1 - part) * *lower + part * upper;
}

}  // namespace airdos
