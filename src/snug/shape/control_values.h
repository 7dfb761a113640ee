#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/scheme/stencils.h>

/// Values of control points, one coordinate of a net.
namespace snug {

/// (largest - least) / 2, rounded up: as much as conditions on derivatives see of a net.
inline double extent(std::span<const double> values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return enlarged(0.5 * (*most - *least));
}

inline double largest_of(std::span<const double> values) {
  double largest = 0;
  for (const double x : values) largest = std::max(largest, std::fabs(x));
  return largest;
}

/// The values after a step.
inline void apply(const Stencils& rows, const std::vector<double>& from, std::vector<double>& to) {
  to.resize(rows.row_count());
  for (std::size_t r = 0; r < to.size(); ++r) {
    const Stencils::Row row = rows.row(r);
    double sum = 0;
    for (std::size_t i = 0; i < row.sources.size(); ++i) sum += row.weights[i] * from[row.sources[i]];
    to[r] = sum;
  }
}

}  // namespace snug
