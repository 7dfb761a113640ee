#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <support/point.h>

namespace snug {

[[nodiscard]] inline bool touch(const Box3& a, const Box3& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(a.lower[axis] <= b.upper[axis] && b.lower[axis] <= a.upper[axis])) return false;
  }
  return true;
}

/// Calls visit(i, k), i != k, once for any two of the boxes that have a point in common.
/// Cost:      by a sweep along the axis that they spread most along: n log n, and the pairs that touch along it.
template <class Visit>
void for_each_touching(std::span<const Box3> boxes, const Visit& visit) {
  Box3 all;
  for (const Box3& box : boxes) all.add(box.lower);
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3 && !all.empty(); ++k) {
    if (all.upper[k] - all.lower[k] > all.upper[axis] - all.lower[axis]) axis = k;
  }
  std::vector<std::uint32_t> order(boxes.size()), active;
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t k) {
    return boxes[i].lower[axis] != boxes[k].lower[axis] ? boxes[i].lower[axis] < boxes[k].lower[axis] : i < k;
  });
  for (const std::uint32_t i : order) {
    std::size_t kept = 0;
    for (const std::uint32_t k : active) {
      if (boxes[k].upper[axis] < boxes[i].lower[axis]) continue;
      active[kept++] = k;
      if (touch(boxes[i], boxes[k])) visit(i, k);
    }
    active.resize(kept);
    active.push_back(i);
  }
}

}  // namespace snug
