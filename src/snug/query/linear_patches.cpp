#include <snug/query/linear_patches.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include <snug/geometry/rounding.h>
#include <snug/query/trajectory.h>

namespace snug {
namespace {

// Pairs of nodes that are opened to find the fastest one; then what is left counts as it is.
constexpr std::size_t max_opened = 4000;

// All (1 - w) p + w q with p, q in the boxes and w in [0, 1]. Three products and sums err by less than 4 u of
// the larger one, and what is taken off rounds once more.
Box3 mixed(const Box3& p, const Box3& q, double w) {
  Box3 result;
  const auto mix = [w](double x, double y, double outward) {
    const double doubt = 8 * unit_roundoff * (std::fabs(x) + std::fabs(y)) + 4 * underflow_error;
    return (1 - w) * x + w * y + outward * doubt;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.lower[axis] = mix(p.lower[axis], q.lower[axis], -1);
    result.upper[axis] = mix(p.upper[axis], q.upper[axis], 1);
  }
  return result;
}

// Around all y - x.
Box3 difference(const Box3& x, const Box3& y) {
  Box3 result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.lower[axis] = rounded_down(y.lower[axis] - x.upper[axis]);
    result.upper[axis] = rounded_up(y.upper[axis] - x.lower[axis]);
  }
  return result;
}

}  // namespace

LinearPatches::LinearPatches(const LimitSurface& surface, std::span<const Box3> start,
                             std::span<const Box3> end) {
  std::vector<Node> leaves;
  std::vector<VertexId> corners, all;
  for (std::size_t owner = 0; owner < surface.owner_count(); ++owner) {
    const auto [first, last] = surface.patches_of(owner);
    Node leaf;
    corners.clear();
    if (surface.rules().primal) {
      for (const VertexId v : surface.topology().face(FaceId(owner))) corners.push_back(v);
    } else {
      corners.emplace_back(owner);
    }
    for (std::size_t p = first; p < last && surface.has_patch(PatchId(p)); ++p) {
      surface.control_vertices(PatchId(p), all);
      const double weight =
          surface.polygon_of(PatchId(p)) ? 1.0 : std::min(1.0, surface.kind(PatchId(p)).outer_weight());
      const auto around = [&](const auto& box_of) {
        Box3 inner, outer;
        for (const VertexId v : corners) inner.add(box_of(v));
        for (const VertexId v : all) outer.add(box_of(v));
        return mixed(inner, outer, weight);
      };
      leaf.start.add(around([&](VertexId v) { return start[v.index()]; }));
      leaf.end.add(around([&](VertexId v) { return end[v.index()]; }));
      leaf.velocity.add(around([&](VertexId v) { return difference(start[v.index()], end[v.index()]); }));
    }
    if (!leaf.start.empty()) leaves.push_back(leaf);
  }
  nodes_.reserve(2 * leaves.size());
  nodes_.emplace_back();
  split(0, leaves);
}

// Halves of equal number, along the axis of places or velocities that they spread most along.
void LinearPatches::split(std::uint32_t node, std::span<Node> leaves) {
  if (leaves.size() == 1) {
    nodes_[node] = leaves[0];
    return;
  }
  const auto middle = [](const Node& leaf, std::size_t axis) {
    const Box3& box = axis < 3 ? leaf.start : leaf.velocity;
    return box.lower[axis % 3] + box.upper[axis % 3];
  };
  std::array<Interval, 6> spread;
  spread.fill({INFINITY, -INFINITY});
  for (const Node& leaf : leaves) {
    for (std::size_t axis = 0; axis < 6; ++axis) {
      spread[axis].lower = std::min(spread[axis].lower, middle(leaf, axis));
      spread[axis].upper = std::max(spread[axis].upper, middle(leaf, axis));
    }
  }
  const auto widest = std::max_element(
      spread.begin(), spread.end(),
      [](const Interval& x, const Interval& y) { return x.upper - x.lower < y.upper - y.lower; });
  const auto axis = static_cast<std::size_t>(widest - spread.begin());
  const std::size_t half = leaves.size() / 2;
  std::nth_element(leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(half), leaves.end(),
                   [&](const Node& x, const Node& y) { return middle(x, axis) < middle(y, axis); });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  split(child, leaves.first(half));
  split(child + 1, leaves.subspan(half));
  Node whole = nodes_[child];
  whole.start.add(nodes_[child + 1].start);
  whole.end.add(nodes_[child + 1].end);
  whole.velocity.add(nodes_[child + 1].velocity);
  whole.child = child;
  nodes_[node] = whole;
}

// Not where one is beyond the other along an axis at both times: what is so at both is so between.
bool LinearPatches::may_meet(const Node& a, const Node& b, double from, double to, double margin) {
  const Box3 a_from = mixed(a.start, a.end, from), a_to = mixed(a.start, a.end, to),
             b_from = mixed(b.start, b.end, from), b_to = mixed(b.start, b.end, to);
  const auto beyond = [margin](double upper, double lower) {
    return margin == 0 ? upper < lower : rounded_down(lower - upper) > margin;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (beyond(a_from.upper[axis], b_from.lower[axis]) && beyond(a_to.upper[axis], b_to.lower[axis]))
      return false;
    if (beyond(b_from.upper[axis], a_from.lower[axis]) && beyond(b_to.upper[axis], a_to.lower[axis]))
      return false;
  }
  return true;
}

double LinearPatches::speed(const Node& a, const Node& b) {
  const Box3 against = difference(a.velocity, b.velocity);
  return length_up({Interval{against.lower.x, against.upper.x}, Interval{against.lower.y, against.upper.y},
                    Interval{against.lower.z, against.upper.z}});
}

std::optional<double> LinearPatches::meeting_speed(const LinearPatches& a, const LinearPatches& b,
                                                   double from, double to, double margin) {
  struct Pair {
    double speed;
    std::uint32_t depth, a, b;
    // The fastest one first, of equal ones the deepest.
    bool operator<(const Pair& other) const {
      return speed != other.speed ? speed < other.speed : depth < other.depth;
    }
  };
  std::priority_queue<Pair> open;
  const auto add = [&](std::uint32_t in_a, std::uint32_t in_b, std::uint32_t depth) {
    const Node &one = a.nodes_[in_a], &other = b.nodes_[in_b];
    if (may_meet(one, other, from, to, margin)) open.push({speed(one, other), depth, in_a, in_b});
  };
  add(0, 0, 0);
  const auto size = [](const Node& node) { return longest_side(node.start) + longest_side(node.velocity); };
  for (std::size_t opened = 0; !open.empty(); ++opened) {
    const Pair pair = open.top();
    const Node &one = a.nodes_[pair.a], &other = b.nodes_[pair.b];
    if ((one.child == 0 && other.child == 0) || opened == max_opened) return pair.speed;
    open.pop();
    const bool open_a = other.child == 0 || (one.child != 0 && size(one) > size(other));
    for (std::uint32_t k = 0; k < 2; ++k) {
      if (open_a) {
        add(one.child + k, pair.b, pair.depth + 1);
      } else {
        add(pair.a, other.child + k, pair.depth + 1);
      }
    }
  }
  return std::nullopt;
}

}  // namespace snug
