#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <support/contract.h>

namespace snug {

/// The value below which a share in [0, 1] of the others lies: 0 the least, 0.5 the median, 1 the largest. It
/// is one of `values`, no mean of two.
/// Requires:  at least one value, no NaN.
[[nodiscard]] inline double quantile(std::vector<double> values, double share) {
  SNUG_EXPECT(!values.empty() && share >= 0 && share <= 1);
  const auto at = static_cast<std::size_t>(std::floor(share * static_cast<double>(values.size() - 1) + 0.5));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

}  // namespace snug
