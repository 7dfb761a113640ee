#include <experiments/kdop_tree.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <snug/patch/evaluate.h>
#include <snug/surface/control_hull.h>

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

double box_gap(const Obb& box, const Obb& other, const RelativeFrame& frame) {
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

double kdop_gap(Volume volume, const BoundingVolume& set, const BoundingVolume& other,
                const VolumeView& view) {
  const std::span<const Vector3> directions = directions_of(volume);
  double best = -INFINITY, size = max_abs(view.frame.translation);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    Extent seen{0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const double w = view.sums[i].weight[k];
      const Extent& own = other.extents[view.sums[i].place[k]];
      seen.lower += w * (w >= 0 ? own.lower : own.upper);
      seen.upper += w * (w >= 0 ? own.upper : own.lower);
      size = std::max({size, std::fabs(own.lower), std::fabs(own.upper)});
    }
    const Extent& own = set.extents[i];
    size = std::max({size, std::fabs(own.lower), std::fabs(own.upper)});
    const double moved = dot(directions[i], view.frame.translation);
    best = std::max(best, std::max(seen.lower + moved - own.upper, own.lower - seen.upper - moved) /
                              length(directions[i]));
  }
  if (!std::isfinite(size)) return -INFINITY;
  return best - 2 * view.frame.slack - rounding(8 * (1 + view.frame.scale) * size);
}

}  // namespace

const char* name_of(Volume volume) {
  static constexpr std::array names{"aabb", "obb", "dop14", "dop18", "dop26"};
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

BoundingVolume fit(Volume volume, std::span<const Point3> spread,
                   const std::function<Extent(const Vector3&)>& extent) {
  BoundingVolume result;
  if (volume == Volume::obb) {
    result.box = fit_box(principal_axes(spread), extent);
    return result;
  }
  const std::span<const Vector3> directions = directions_of(volume);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Extent found = extent(directions[i]);
    const bool finite = std::isfinite(found.lower) && std::isfinite(found.upper);
    result.extents[i] = finite ? found : unbounded;
  }
  return result;
}

BoundingVolume merge(Volume volume, std::span<const BoundingVolume> parts) {
  BoundingVolume result = parts[0];
  if (volume == Volume::obb) {
    std::vector<Obb> boxes;
    for (const BoundingVolume& part : parts) boxes.push_back(part.box);
    result.box = merge(boxes);
  }
  for (const BoundingVolume& part : parts.subspan(1)) {
    for (std::size_t i = 0; i < directions_of(volume).size(); ++i) result.extents[i].add(part.extents[i]);
  }
  return result;
}

Ball ball_around(Volume volume, const BoundingVolume& set) {
  if (volume == Volume::obb) return ball_around(set.box);
  Point3 centre;
  Vector3 half;
  for (std::size_t k = 0; k < 3; ++k) {
    centre[k] = (set.extents[k].lower + set.extents[k].upper) / 2;
    half[k] = std::max(set.extents[k].upper - centre[k], centre[k] - set.extents[k].lower);
  }
  const double reach = std::sqrt(length_sq(half));
  if (!std::isfinite(reach) || !is_finite(centre)) return {Point3{}, INFINITY};
  return {centre, enlarged(reach)};
}

VolumeView::VolumeView(Volume volume, const PlacedFrame& target, const PlacedFrame& source)
    : frame(target, source) {
  for (const Vector3& d : directions_of(volume)) {
    const Vector3 back = d.x * frame.rows[0] + d.y * frame.rows[1] + d.z * frame.rows[2];
    sums.push_back(Decomposition(volume, back).sum);
  }
}

double gap(Volume volume, const BoundingVolume& set, const BoundingVolume& other, const VolumeView& view) {
  return volume == Volume::obb ? box_gap(set.box, other.box, view.frame) : kdop_gap(volume, set, other, view);
}

KdopTree::KdopTree(const LimitSurface& surface, Volume volume) : surface_(surface), volume_(volume) {
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) patches_.emplace_back(p);
  }
  nodes_.emplace_back();
  build(0, 0, patches_.size());
}

KdopTree::Node KdopTree::make_node(const BoundingVolume& set) const {
  return {set, 2 * ball_around(volume_, set).radius};
}

// Leaves of up to eight patches; nodes of up to eight children, by three halvings along the longest side.
void KdopTree::build(std::size_t node, std::size_t begin, std::size_t end) {
  const std::span<PatchId> all(patches_);
  if (end - begin <= 8) {
    ControlHull hull;
    hull.assign(surface_, all.subspan(begin, end - begin));
    std::vector<Point3> spread;
    for (std::size_t i = begin; i < end; ++i) {
      for (const VertexId v : surface_.topology().face(FaceId(surface_.place(patches_[i]).owner))) {
        spread.push_back(surface_.scaled_point(v));
      }
    }
    nodes_[node] = make_node(fit(volume_, spread, [&](const Vector3& d) { return hull.extent(d); }));
    nodes_[node].first = static_cast<std::uint32_t>(begin);
    nodes_[node].count = static_cast<std::uint32_t>(end - begin);
    nodes_[node].opened = false;
    return;
  }
  std::vector<std::size_t> cuts{begin, end};
  while (cuts.size() < 9 && cuts[1] - cuts[0] > 8) {
    std::vector<std::size_t> finer{begin};
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const std::span<PatchId> part = all.subspan(cuts[i], cuts[i + 1] - cuts[i]);
      Box3 box;
      for (const PatchId p : part) box.add(surface_.middle(p));
      std::size_t axis = 0;
      for (std::size_t k = 1; k < 3; ++k) {
        if (box.upper[k] - box.lower[k] > box.upper[axis] - box.lower[axis]) axis = k;
      }
      const auto middle = part.begin() + static_cast<std::ptrdiff_t>((part.size() + 1) / 2);
      std::nth_element(part.begin(), middle, part.end(), [&](PatchId x, PatchId y) {
        return surface_.middle(x)[axis] < surface_.middle(y)[axis];
      });
      finer.push_back(cuts[i] + (part.size() + 1) / 2);
      finer.push_back(cuts[i + 1]);
    }
    cuts = std::move(finer);
  }
  const std::size_t first = nodes_.size(), count = cuts.size() - 1;
  nodes_.resize(first + count);
  std::vector<BoundingVolume> sets;
  for (std::size_t i = 0; i < count; ++i) {
    build(first + i, cuts[i], cuts[i + 1]);
    sets.push_back(nodes_[first + i].set);
  }
  nodes_[node] = make_node(merge(volume_, sets));
  nodes_[node].first = static_cast<std::uint32_t>(first);
  nodes_[node].count = static_cast<std::uint32_t>(count);
}

// Fitted in scratch_.
void KdopTree::add_piece(Piece piece) {
  pieces_.push_back(std::move(piece));
  BoundingVolume set;
  set.box = box_around(pieces_.back().offset, scratch_, BoundMethod::rows);
  const OffsetTriangle& offset = pieces_.back().offset;
  if (volume_ != Volume::obb) {
    set = fit(volume_, offset.base, [&](const Vector3& d) { return extent_of(offset, d); });
  }
  Node node = make_node(set);
  node.opened = false;
  node.piece = &pieces_.back();
  nodes_.push_back(node);
}

void KdopTree::open(std::size_t node) {
  if (nodes_[node].opened) return;
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  BoundsCache& library = surface_.library();
  if (const Piece* const piece = nodes_[node].piece) {
    for (unsigned child = 0; child < 4; ++child) add_piece(child_of(library, *piece, child, scratch_));
  } else {
    const std::size_t begin = nodes_[node].first, end = begin + nodes_[node].count;
    for (std::size_t i = begin; i < end; ++i)
      add_piece(make_piece(library, patches_[i], surface_.patch(patches_[i]), scratch_));
  }
  nodes_[node].first = first;
  nodes_[node].count = static_cast<std::uint32_t>(nodes_.size() - first);
  nodes_[node].opened = true;
}

// Depth first, the pair that overlaps more deeply first.
class KdopWalk {
 public:
  KdopWalk(KdopTree& a, const Motion& place_a, KdopTree& b, const Motion& place_b, double tolerance)
      : tree_{&a, &b},
        frame_{frame_of(a, place_a), frame_of(b, place_b)},
        view_{VolumeView(a.volume_, frame_[0], frame_[1]), VolumeView(a.volume_, frame_[1], frame_[0])},
        tolerance_(tolerance) {}

  KdopTree::Answer run() {
    bool unresolved = false;
    stack_.push_back({{0, 0}, -INFINITY});
    while (!stack_.empty() && !answer_.within) {
      const Pair pair = stack_.back();
      stack_.pop_back();
      const Nodes nodes{&tree_[0]->nodes_[pair.nodes[0]], &tree_[1]->nodes_[pair.nodes[1]]};
      if (nodes[0]->piece != nullptr && nodes[1]->piece != nullptr && apart_or_within(nodes)) continue;
      const auto can_open = [&](std::size_t s) {
        return nodes[s]->piece == nullptr || nodes[s]->piece->can_split();
      };
      std::size_t side = frame_[1].scale * nodes[1]->size > frame_[0].scale * nodes[0]->size ? 1 : 0;
      if (!can_open(side)) side = 1 - side;
      if (!can_open(side)) {
        unresolved = true;
        continue;
      }
      open(pair, side);
    }
    answer_.separated = !answer_.within && !unresolved;
    return answer_;
  }

 private:
  struct Pair {
    std::array<std::size_t, 2> nodes;
    double gap;
  };
  using Nodes = std::array<const KdopTree::Node*, 2>;

  static PlacedFrame frame_of(const KdopTree& tree, const Motion& pose) {
    return {{pose.row(0), pose.row(1), pose.row(2)},
            tree.surface_.scale().inverse().apply(1.0),
            pose.offset(),
            pose.defect()};
  }

  void open(const Pair& pair, std::size_t side) {
    tree_[side]->open(pair.nodes[side]);
    const KdopTree::Node& node = tree_[side]->nodes_[pair.nodes[side]];
    const KdopTree::Node& other = tree_[1 - side]->nodes_[pair.nodes[1 - side]];
    const std::size_t before = stack_.size();
    for (std::size_t i = 0; i < node.count; ++i) {
      ++answer_.volume_tests;
      Pair next = pair;
      next.nodes[side] = node.first + i;
      next.gap = gap(tree_[side]->volume_, tree_[side]->nodes_[next.nodes[side]].set, other.set, view_[side]);
      if (!(next.gap > 0)) stack_.push_back(next);
    }
    std::sort(stack_.begin() + static_cast<std::ptrdiff_t>(before), stack_.end(),
              [](const Pair& x, const Pair& y) { return x.gap > y.gap; });
  }

  // Are base triangles farther apart than their radii, or limit points where they are nearest near enough?
  bool apart_or_within(const Nodes& nodes) {
    ++answer_.triangle_tests;
    std::array<Triangle, 2> base;
    double radii = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      const OffsetTriangle& offset = nodes[s]->piece->offset;
      double error = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        base[s][k] = frame_[s].apply(offset.base[k]);
        error = std::max(error, frame_[s].apply_error(offset.base[k]));
      }
      radii = enlarged(radii + enlarged(offset.radius * frame_[s].growth() + spatial_error(error)));
    }
    const NearestTriangles near = nearest(base[0], base[1]);
    if (near.certain_distance > radii) return true;
    if (near.certain_distance > tolerance_) return false;
    const std::array<Barycentric, 2> at{near.on_a, near.on_b};
    std::array<Point3, 2> points;
    double error = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      const Patch& patch = nodes[s]->piece->patch;
      const LimitPoint limit = limit_point(patch, clamped(at[s]));
      points[s] = frame_[s].apply(patch.origin + limit.relative);
      error += 2 * frame_[s].growth() * limit.error + rounding(1);
    }
    answer_.within = distance(points[0], points[1]) + 2 * error <= tolerance_;
    return answer_.within;
  }

  std::array<KdopTree*, 2> tree_;
  std::array<PlacedFrame, 2> frame_;
  std::array<VolumeView, 2> view_;
  double tolerance_;
  std::vector<Pair> stack_;
  KdopTree::Answer answer_;
};

KdopTree::Answer KdopTree::compare(KdopTree& a, const Motion& place_a, KdopTree& b, const Motion& place_b,
                                   double tolerance) {
  return KdopWalk(a, place_a, b, place_b, tolerance).run();
}

}  // namespace snug
