#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <support/point.h>

namespace snug {

/// All rays from the eye (0, 0, 0) through a rectangle of the plane z = 1: what one pixel sees.
struct Beam {
  double x_low, x_high, y_low, y_high;
};

/// The depths at which a box, seen from the eye, may lie in a beam; empty while near > far.
struct DepthRange {
  double near = 0, far = std::numeric_limits<double>::infinity();
};

/// Guarantee: contains the z of each point of the box in the beam with 0 <= z <= limit, up to rounding.
[[nodiscard]] inline DepthRange depths_in(const Beam& beam, const Box3& box, double limit) {
  DepthRange range{std::max(box.lower.z, 0.0), std::min(box.upper.z, limit)};
  // The points of the beam at depth z have slope z <= bound, for each of its four sides.
  const auto cut = [&range](double slope, double bound) {
    if (slope > 0)
      range.far = std::min(range.far, bound / slope);
    else if (slope < 0)
      range.near = std::max(range.near, bound / slope);
    else if (bound < 0)
      range.far = -1;
  };
  cut(beam.x_low, box.upper.x);
  cut(-beam.x_high, -box.lower.x);
  cut(beam.y_low, box.upper.y);
  cut(-beam.y_high, -box.lower.y);
  return range;
}

/// Boxes in a binary tree of boxes, to be searched by beams from the eye, near to far.
///
/// Cost: n log n to build; 64 bytes a node, about n / 2 nodes.
class BeamHierarchy {
 public:
  /// Requires: fewer than 2^31 finite boxes, not empty. Boxes are grown by 1e-12 of the largest coordinate,
  /// so that the rounding of a search loses none.
  explicit BeamHierarchy(std::span<const Box3> boxes);

  /// Scratch memory of a search.
  using Stack = std::vector<std::pair<std::uint32_t, double>>;

  /// Calls `limit = visit(id)` for the boxes that meet the beam at a depth of at most `limit`, roughly from
  /// near to far.
  ///
  /// Guarantee: each box that meets the beam at or before the last limit returned is visited once.
  /// Requires:  limits never grow.
  template <class Visit>
  void search(const Beam& beam, double limit, Stack& stack, Visit&& visit) const {
    stack.clear();
    const auto push = [&](std::uint32_t index) {
      const DepthRange range = depths_in(beam, nodes_[index].box, limit);
      if (range.near <= range.far) stack.emplace_back(index, range.near);
    };
    if (!nodes_.empty()) push(0);
    while (!stack.empty()) {
      const auto [index, near] = stack.back();
      stack.pop_back();
      if (near > limit) continue;
      const Node& node = nodes_[index];
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) limit = visit(ids_[i]);
        continue;
      }
      const std::size_t before = stack.size();
      push(node.first);
      push(node.first + 1);
      if (stack.size() == before + 2 && stack[before].second < stack[before + 1].second)
        std::swap(stack[before], stack[before + 1]);
    }
  }

 private:
  struct Node {
    Box3 box;
    std::uint32_t first = 0;  // of ids_ in a leaf, of two neighbouring children elsewhere
    std::uint32_t count = 0;  // zero: not a leaf
  };
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> ids_;
};

}  // namespace snug
