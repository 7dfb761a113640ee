#include <experiments/printed_hierarchy.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <experiments/printed_pair_test.h>
#include <snug/geometry/rounding.h>
#include <snug/search/piece.h>
#include <snug/surface/unscale.h>
#include <support/error.h>

namespace snug {
namespace {

bool has_one_extraordinary(const Kind& kind) {
  return kind.regular_corner(0) + kind.regular_corner(1) + kind.regular_corner(2) >= 2;
}

class LeafMaker {
 public:
  LeafMaker(const LimitSurface& surface, const LeafOptions& options, std::vector<OffsetTriangle>& out)
      : surface_(surface), options_(options), back_(surface.scale().inverse()), out_(out) {}

  void visit(PatchId root, Patch patch) {
    const Piece piece = make_piece(surface_.library(), root, std::move(patch), scratch_, options_.method);
    OffsetTriangle leaf = unscaled(piece.offset, back_);
    const bool one = !options_.one_extraordinary || has_one_extraordinary(*piece.patch.kind);
    if (one && leaf.radius <= options_.tolerance / 2) {
      out_.push_back(leaf);
      return;
    }
    if (piece.patch.path.level() >= PiecePath::max_level ||
        piece.offset.radius <= 2 * piece.offset.rounding) {
      throw InputError(InputProblem::refused,
                       "the tolerance is below what rounding leaves; take a larger one");
    }
    for (unsigned child = 0; child < 4; ++child) visit(root, split(piece.patch, child));
  }

 private:
  const LimitSurface& surface_;
  const LeafOptions& options_;
  PowerOfTwo back_;
  BoundingPoints scratch_;
  std::vector<OffsetTriangle>& out_;
};

// A box around offset triangles, along the principal axes of their corners.
Obb box_of(std::span<const OffsetTriangle* const> members) {
  std::vector<Point3> corners;
  for (const OffsetTriangle* member : members) {
    corners.insert(corners.end(), member->base.begin(), member->base.end());
  }
  return fit_box(principal_axes(corners), [&](const Vector3& direction) {
    Extent extent;
    for (const OffsetTriangle* member : members) {
      for (const Point3& p : member->base) {
        const double x = dot(direction, p - Point3{}), reach = enlarged(member->radius * length(direction));
        extent.add({x - reach, x + reach});
      }
    }
    return extent;
  });
}

double middle_along(const OffsetTriangle& triangle, const Vector3& axis) {
  return dot(axis, triangle.base[0] - Point3{}) + dot(axis, triangle.base[1] - Point3{}) +
         dot(axis, triangle.base[2] - Point3{});
}

// Sorts members into two halves, neither empty; returns the size of the first one.
std::size_t halve(std::span<const OffsetTriangle*> members, const Obb& box) {
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (box.half[k] > box.half[longest]) longest = k;
  }
  const Vector3& axis = box.axes[longest];
  double mean = 0;
  for (const OffsetTriangle* member : members) {
    mean += middle_along(*member, axis) / static_cast<double>(members.size());
  }
  const auto middle = std::stable_partition(
      members.begin(), members.end(), [&](const OffsetTriangle* t) { return middle_along(*t, axis) < mean; });
  const auto count = static_cast<std::size_t>(middle - members.begin());
  return count == 0 || count == members.size() ? members.size() / 2 : count;
}

// Radii are those of rigid motions exactly: nothing is proved here.
OffsetTriangle placed(const OffsetTriangle& leaf, const Motion& pose) {
  OffsetTriangle result = leaf;
  for (Point3& p : result.base) p = pose.apply(p);
  return result;
}

}  // namespace

std::vector<OffsetTriangle> leaves(const LimitSurface& surface, const LeafOptions& options,
                                   const WorkMonitor& monitor) {
  require_value(options.tolerance > 0, "leaves: the tolerance must be positive");
  std::vector<OffsetTriangle> result;
  LeafMaker maker(surface, options, result);
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    monitor.checkpoint();
    if (surface.has_patch(PatchId(p))) maker.visit(PatchId(p), surface.patch(PatchId(p)));
  }
  return result;
}

PrintedHierarchy::PrintedHierarchy(const LimitSurface& surface, const LeafOptions& options,
                                   const WorkMonitor& monitor)
    : leaves_(snug::leaves(surface, options, monitor)) {
  std::vector<const OffsetTriangle*> members;
  for (const OffsetTriangle& leaf : leaves_) members.push_back(&leaf);
  struct Task {
    std::uint32_t node;
    std::span<const OffsetTriangle*> members;
  };
  nodes_.reserve(2 * leaves_.size());
  nodes_.emplace_back();
  std::vector<Task> tasks{{0, members}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    nodes_[task.node].box = box_of(task.members);
    if (task.members.size() == 1) {
      nodes_[task.node].leaf = static_cast<std::uint32_t>(task.members[0] - leaves_.data());
      continue;
    }
    const std::size_t first = halve(task.members, nodes_[task.node].box);
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[task.node].first_child = child;
    nodes_.resize(nodes_.size() + 2);
    tasks.push_back({child + 1, task.members.subspan(first)});
    tasks.push_back({child, task.members.first(first)});
  }
}

// The fifteen axes; those across two edges are not of length 1, which lets fewer boxes be apart.
bool PrintedHierarchy::apart(const Node& a, const Motion& place_a, const Node& b, const Motion& place_b,
                             double epsilon) {
  std::array<Vector3, 3> axes_a, axes_b;
  for (std::size_t k = 0; k < 3; ++k) {
    axes_a[k] = place_a.rotate(a.box.axes[k]);
    axes_b[k] = place_b.rotate(b.box.axes[k]);
  }
  const Vector3 between = place_b.apply(b.box.centre) - place_a.apply(a.box.centre);
  double turn[3][3], size[3][3];
  Vector3 in_a, in_b;
  for (std::size_t i = 0; i < 3; ++i) {
    in_a[i] = dot(axes_a[i], between);
    in_b[i] = dot(axes_b[i], between);
    for (std::size_t j = 0; j < 3; ++j) {
      turn[i][j] = dot(axes_a[i], axes_b[j]);
      size[i][j] = std::fabs(turn[i][j]);
    }
  }
  const Vector3 &half_a = a.box.half, &half_b = b.box.half;
  for (std::size_t i = 0; i < 3; ++i) {
    const double reach_b = half_b.x * size[i][0] + half_b.y * size[i][1] + half_b.z * size[i][2],
                 reach_a = half_a.x * size[0][i] + half_a.y * size[1][i] + half_a.z * size[2][i];
    if (std::fabs(in_a[i]) > half_a[i] + reach_b + epsilon) return true;
    if (std::fabs(in_b[i]) > reach_a + half_b[i] + epsilon) return true;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double reach = half_a[i1] * size[i2][j] + half_a[i2] * size[i1][j] + half_b[j1] * size[i][j2] +
                           half_b[j2] * size[i][j1];
      if (std::fabs(in_a[i2] * turn[i1][j] - in_a[i1] * turn[i2][j]) > reach + epsilon) return true;
    }
  }
  return false;
}

bool PrintedHierarchy::says_separated(const PrintedHierarchy& a, const Motion& place_a,
                                      const PrintedHierarchy& b, const Motion& place_b, double epsilon) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const Node &node_a = a.nodes_[i], &node_b = b.nodes_[j];
    if (apart(node_a, place_a, node_b, place_b, epsilon)) continue;
    const bool leaf_a = node_a.first_child == 0, leaf_b = node_b.first_child == 0;
    if (leaf_a && leaf_b) {
      if (!printed_test_says_separated(placed(a.leaves_[node_a.leaf], place_a),
                                       placed(b.leaves_[node_b.leaf], place_b), epsilon)) {
        return false;
      }
    } else if (leaf_b || (!leaf_a && max_abs(node_a.box.half) >= max_abs(node_b.box.half))) {
      for (const std::uint32_t child : {0u, 1u}) stack.emplace_back(node_a.first_child + child, j);
    } else {
      for (const std::uint32_t child : {0u, 1u}) stack.emplace_back(i, node_b.first_child + child);
    }
  }
  return true;
}

}  // namespace snug
