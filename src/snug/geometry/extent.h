#pragma once

#include <algorithm>
#include <cmath>

namespace snug {

/// Bounds of dot(direction, x) over a set, rounding included; empty at first.
struct Extent {
  double lower = INFINITY, upper = -INFINITY;

  void add(double height) {
    lower = std::min(lower, height);
    upper = std::max(upper, height);
  }
  void add(const Extent& other) {
    lower = std::min(lower, other.lower);
    upper = std::max(upper, other.upper);
  }
};

/// Bounds of what cannot be bounded.
inline constexpr Extent unbounded{-INFINITY, INFINITY};

}  // namespace snug
