#include <experiments/volume_tree.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <snug/search/piece.h>

namespace snug {
namespace {

// Axes, diagonals of a cube, those of its faces; and the same without the first diagonals.
constexpr std::array<Vector3, 13> diagonals_then_faces{{{1, 0, 0},
                                                        {0, 1, 0},
                                                        {0, 0, 1},
                                                        {1, 1, 1},
                                                        {1, 1, -1},
                                                        {1, -1, 1},
                                                        {1, -1, -1},
                                                        {1, 1, 0},
                                                        {1, -1, 0},
                                                        {1, 0, 1},
                                                        {1, 0, -1},
                                                        {0, 1, 1},
                                                        {0, 1, -1}}};
constexpr std::array<Vector3, 9> faces{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}}};

// A vector as a sum of directions of a sort with weights: of those that span the cell around it.
class Decomposition {
 public:
  Decomposition(Volume volume, const Vector3& v) : directions_(directions_of(volume)), v_(v) {
    // Axes by size: p >= q >= r >= 0.
    std::array<std::size_t, 3> a{0, 1, 2};
    std::sort(a.begin(), a.end(),
              [&](std::size_t i, std::size_t j) { return std::fabs(v[i]) > std::fabs(v[j]); });
    const double p = std::fabs(v[a[0]]), q = std::fabs(v[a[1]]), r = std::fabs(v[a[2]]);
    const Which all{true, true, true};
    if (volume == Volume::dop14) {
      add(all, r), add(only(a[0]), p - r), add(only(a[1]), q - r);
    } else if (volume == Volume::dop26) {
      add(all, r), add(both(a[0], a[1]), q - r), add(only(a[0]), p - q);
    } else if (volume == Volume::aabb) {
      for (std::size_t k = 0; k < 3; ++k) add(only(k), std::fabs(v[k]));
    } else if (p >= q + r) {
      add(both(a[0], a[1]), q), add(both(a[0], a[2]), r), add(only(a[0]), p - q - r);
    } else {
      add(both(a[0], a[1]), (p + q - r) / 2), add(both(a[0], a[2]), (p + r - q) / 2);
      add(both(a[1], a[2]), (q + r - p) / 2);
    }
  }
  VolumeView::Sum sum{};

 private:
  using Which = std::array<bool, 3>;
  static Which only(std::size_t i) { return {i == 0, i == 1, i == 2}; }
  static Which both(std::size_t i, std::size_t j) {
    return {i == 0 || j == 0, i == 1 || j == 1, i == 2 || j == 2};
  }
  // The direction with the signs of v in some coordinates and zero in the others, or its opposite with a
  // negative weight.
  void add(const Which& which, double weight) {
    Vector3 wanted;
    for (std::size_t i = 0; i < 3; ++i) wanted[i] = which[i] ? (v_[i] < 0 ? -1.0 : 1.0) : 0.0;
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      if (directions_[d] != wanted && directions_[d] != -wanted) continue;
      sum.place[count_] = static_cast<std::uint8_t>(d);
      sum.weight[count_++] = directions_[d] == wanted ? weight : -weight;
    }
  }

  std::span<const Vector3> directions_;
  Vector3 v_;
  std::size_t count_ = 0;
};

// More than the roundings of sums of a dozen products of numbers of this size.
double rounding(double size) { return 256 * unit_roundoff * size; }

// Between extents in one frame, whose roundings are those of numbers of this size.
double gap_along(Volume volume, std::span<const Extent> set, std::span<const Extent> seen, double slack,
                 double size) {
  const std::span<const Vector3> directions = directions_of(volume);
  double best = -INFINITY;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    best = std::max(
        best, std::max(seen[i].lower - set[i].upper, set[i].lower - seen[i].upper) / length(directions[i]));
  }
  return best - 2 * slack - rounding(size);
}

}  // namespace

double gap(const Obb& box, const Obb& other, const RelativeFrame& frame) {
  const Vector3 between = frame.apply(other.centre) - box.centre;
  std::array<Vector3, 3> edges;  // of the other one, half of them
  for (std::size_t k = 0; k < 3; ++k) edges[k] = other.half[k] * times(frame.rows, other.axes[k]);
  const double size = max_abs(between) + max_abs(other.centre - Point3{}) + max_abs(box.centre - Point3{}) +
                      box.half.x + box.half.y + box.half.z + max_abs(edges[0]) + max_abs(edges[1]) +
                      max_abs(edges[2]);
  if (!std::isfinite(size)) return -INFINITY;
  double best = -INFINITY;
  const auto look_along = [&](const Vector3& n) {
    double taken = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      taken += box.half[k] * std::fabs(dot(n, box.axes[k])) + std::fabs(dot(n, edges[k]));
    }
    best = std::max(best, std::fabs(dot(n, between)) - taken);
  };
  std::array<Vector3, 3> axes;
  for (std::size_t k = 0; k < 3; ++k) {
    axes[k] = (1 / frame.scale) * times(frame.rows, other.axes[k]);
    look_along(box.axes[k]);
    look_along(axes[k]);
  }
  // Cross products are at most 1 long: only gaps count.
  for (std::size_t i = 0; i < 3 && !(best > 0); ++i) {
    for (std::size_t j = 0; j < 3; ++j) look_along(cross(box.axes[i], axes[j]));
  }
  // As vectors they may be longer than 1 by what the frame lacks of rigidity, which its slack covers.
  return best * (1 - 0x1p-40) - frame.slack - rounding(size);
}

double gap(Volume volume, std::span<const Extent> set, std::span<const Extent> other,
           const VolumeView& view) {
  const std::span<const Vector3> directions = directions_of(volume);
  std::array<Extent, diagonals_then_faces.size()> seen;
  double size = max_abs(view.frame.translation);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double moved = dot(directions[i], view.frame.translation);
    seen[i] = {moved, moved};
    for (std::size_t k = 0; k < 3; ++k) {
      const double w = view.sums[i].weight[k];
      const Extent& own = other[view.sums[i].place[k]];
      seen[i].lower += w * (w >= 0 ? own.lower : own.upper);
      seen[i].upper += w * (w >= 0 ? own.upper : own.lower);
      size = std::max({size, std::fabs(own.lower), std::fabs(own.upper)});
    }
    size = std::max({size, std::fabs(set[i].lower), std::fabs(set[i].upper)});
  }
  if (!std::isfinite(size)) return -INFINITY;
  return gap_along(volume, set, std::span(seen).first(directions.size()), view.frame.slack,
                   8 * (1 + view.frame.scale) * size);
}

const char* name_of(Volume volume) {
  static constexpr std::array names{"aabb", "dop14", "dop18", "dop26", "obb"};
  return names[static_cast<std::size_t>(volume)];
}

std::span<const Vector3> directions_of(Volume volume) {
  const std::span<const Vector3> all(diagonals_then_faces);
  switch (volume) {
    case Volume::aabb:
      return all.first(3);
    case Volume::dop14:
      return all.first(7);
    case Volume::dop18:
      return faces;
    case Volume::dop26:
      return all;
    case Volume::obb:
      break;
  }
  return {};
}

VolumeView::VolumeView(Volume volume, const PlacedFrame& target, const PlacedFrame& source)
    : frame(target, source) {
  for (const Vector3& d : directions_of(volume)) {
    const Vector3 back = d.x * frame.rows[0] + d.y * frame.rows[1] + d.z * frame.rows[2];
    sums.push_back(Decomposition(volume, back).sum);
  }
}

const char* name_of(Turning turning) { return turning == Turning::bounded ? "bounded" : "refitted"; }

VolumeTree::VolumeTree(const PrintedHierarchy& hierarchy, Volume volume)
    : hierarchy_(hierarchy), volume_(volume) {
  if (volume != Volume::obb) {
    RelativeFrame own;
    own.rows = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    refit(own, extents_);
    return;
  }
  for (const PrintedHierarchy::Node& node : hierarchy.nodes()) boxes_.push_back(node.box);
}

std::size_t VolumeTree::bytes() const {
  return extents_.size() * sizeof(Extent) + boxes_.size() * sizeof(Obb);
}

std::span<const Extent> VolumeTree::extents(std::size_t node) const {
  const std::size_t count = directions_of(volume_).size();
  return std::span(extents_).subspan(node * count, count);
}

void VolumeTree::refit(const RelativeFrame& frame, std::vector<Extent>& extents) const {
  const std::span<const Vector3> directions = directions_of(volume_);
  const std::span<const PrintedHierarchy::Node> nodes = hierarchy_.nodes();
  extents.resize(nodes.size() * directions.size());
  double growth = 1;  // of radii along a direction
  for (const Vector3& d : directions) {
    const Vector3 back = d.x * frame.rows[0] + d.y * frame.rows[1] + d.z * frame.rows[2];
    growth = std::max(growth, length(back) / length(d));
  }
  // Children follow their parents.
  for (std::size_t n = nodes.size(); n-- > 0;) {
    const std::span<Extent> own = std::span(extents).subspan(n * directions.size(), directions.size());
    if (nodes[n].first_child != 0) {
      const Extent* const first = &extents[nodes[n].first_child * directions.size()];
      for (std::size_t i = 0; i < own.size(); ++i) {
        own[i] = first[i];
        own[i].add(first[i + own.size()]);
      }
      continue;
    }
    OffsetTriangle leaf = hierarchy_.leaves()[nodes[n].leaf];
    for (Point3& p : leaf.base) p = frame.apply(p);
    leaf.radius = enlarged(leaf.radius * growth) + rounding(4);
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = extent_of(leaf, directions[i]);
  }
}

bool leaves_apart(const OffsetTriangle& a, const PlacedFrame& frame_a, const OffsetTriangle& b,
                  const PlacedFrame& frame_b) {
  std::array<Triangle, 2> base;
  double radii = 0;
  const auto place = [&](std::size_t side, const OffsetTriangle& leaf, const PlacedFrame& frame) {
    double error = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      base[side][k] = frame.apply(leaf.base[k]);
      error = std::max(error, frame.apply_error(leaf.base[k]));
    }
    radii = enlarged(radii + enlarged(leaf.radius * frame.growth() + spatial_error(error)));
  };
  place(0, a, frame_a);
  place(1, b, frame_b);
  return nearest(base[0], base[1]).certain_distance > radii;
}

PlacedFrame frame_of(const Motion& motion) {
  return {{motion.row(0), motion.row(1), motion.row(2)}, 1, motion.offset(), motion.defect()};
}

VolumeTree::Answer VolumeTree::compare(const VolumeTree& a, const Motion& place_a, const VolumeTree& b,
                                       const Motion& place_b, Turning turning) {
  const std::array<PlacedFrame, 2> frame{frame_of(place_a), frame_of(place_b)};
  const VolumeView view(a.volume_, frame[0], frame[1]);
  const bool refitted = turning == Turning::refitted && a.volume_ != Volume::obb;
  std::vector<Extent> turned;
  if (refitted) b.refit(view.frame, turned);
  const std::size_t count = directions_of(a.volume_).size();
  const auto gap_of = [&](std::size_t i, std::size_t j) {
    if (a.volume_ == Volume::obb) return gap(a.boxes_[i], b.boxes_[j], view.frame);
    if (!refitted) return gap(a.volume_, a.extents(i), b.extents(j), view);
    return gap_along(a.volume_, a.extents(i), std::span(turned).subspan(j * count, count), view.frame.slack,
                     0);
  };
  const auto nodes_a = a.hierarchy_.nodes(), nodes_b = b.hierarchy_.nodes();
  Answer answer;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    ++answer.volume_tests;
    if (gap_of(i, j) > 0) continue;
    const PrintedHierarchy::Node &node_a = nodes_a[i], &node_b = nodes_b[j];
    const bool leaf_a = node_a.first_child == 0, leaf_b = node_b.first_child == 0;
    if (leaf_a && leaf_b) {
      ++answer.triangle_tests;
      if (!leaves_apart(a.hierarchy_.leaves()[node_a.leaf], frame[0], b.hierarchy_.leaves()[node_b.leaf],
                        frame[1])) {
        return answer;
      }
    } else if (leaf_b || (!leaf_a && max_abs(node_a.box.half) >= max_abs(node_b.box.half))) {
      for (const std::uint32_t child : {0u, 1u}) stack.emplace_back(node_a.first_child + child, j);
    } else {
      for (const std::uint32_t child : {0u, 1u}) stack.emplace_back(i, node_b.first_child + child);
    }
  }
  answer.separated = true;
  return answer;
}

}  // namespace snug
