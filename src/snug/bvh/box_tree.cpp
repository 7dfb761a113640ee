#include <snug/bvh/box_tree.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numeric>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

constexpr std::uint32_t leaf_size = 4;

// Twice the middle of a box along an axis; of one without ends anything.
double middle_of(const Box3& box, std::size_t axis) {
  const double sum = std::max(box.lower[axis], -DBL_MAX / 2) + std::min(box.upper[axis], DBL_MAX / 2);
  return std::isfinite(sum) ? sum : 0;
}

}  // namespace

double gap_of(const Box3& a, const Box3& b) {
  double gaps[3], widest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // A difference that overflows is certainly that large.
    gaps[axis] =
        std::min(std::max({b.lower[axis] - a.upper[axis], a.lower[axis] - b.upper[axis], 0.0}), DBL_MAX);
    widest = std::max(widest, gaps[axis]);
  }
  if (!(widest > 0)) return 0;
  double sum = 0;
  for (const double gap : gaps) sum += (gap / widest) * (gap / widest);
  // One rounding a difference, two a square, two sums, a root, a product: fewer than twelve. No bound is below that of one axis.
  const double together = widest * (std::sqrt(sum) * (1 - 16 * unit_roundoff)) - 2 * underflow_error;
  return std::max({std::min(together, DBL_MAX), rounded_down(widest), 0.0});
}

BoxTree::BoxTree(std::span<const Box3> boxes) : items_(boxes.size()) {
  std::iota(items_.begin(), items_.end(), 0u);
  if (!boxes.empty()) split(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  boxes_.reserve(boxes.size());
  for (const std::uint32_t item : items_) boxes_.push_back(boxes[item]);
}

// Halves along the axis where middles spread most, so that the depth is the logarithm whatever the boxes are.
void BoxTree::split(std::span<const Box3> boxes, std::uint32_t begin, std::uint32_t end) {
  const std::size_t place = nodes_.size();
  nodes_.emplace_back();
  const auto first = items_.begin() + begin, last = items_.begin() + end;
  Box3 around, middles;
  for (auto i = first; i != last; ++i) {
    const Box3& box = boxes[*i];
    around.add(box);
    middles.add(Point3{middle_of(box, 0), middle_of(box, 1), middle_of(box, 2)});
  }
  const bool leaf = end - begin <= leaf_size;
  if (!leaf) {
    std::size_t axis = 0;
    const Point3 &lower = middles.lower, &upper = middles.upper;
    for (const std::size_t other : {1u, 2u}) {
      if (upper[other] - lower[other] > upper[axis] - lower[axis]) axis = other;
    }
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(first, items_.begin() + half, last, [&](std::uint32_t x, std::uint32_t y) {
      const double mx = middle_of(boxes[x], axis), my = middle_of(boxes[y], axis);
      return mx < my || (mx == my && x < y);
    });
    split(boxes, begin, half);
    split(boxes, half, end);
  }
  nodes_[place] = {around, static_cast<std::uint32_t>(nodes_.size()), leaf ? begin : 0, leaf ? end : 0,
                   *std::max_element(items_.begin() + begin, items_.begin() + end)};
}

std::size_t BoxTree::bytes() const {
  return nodes_.capacity() * sizeof(Node) + items_.capacity() * sizeof(std::uint32_t) +
         boxes_.capacity() * sizeof(Box3);
}

}  // namespace snug
