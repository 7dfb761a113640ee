#include <snug/search/ray_walk.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>

#include <snug/geometry/rounding.h>
#include <snug/search/facet.h>
#include <snug/search/precision.h>
#include <snug/search/ray_group.h>
#include <snug/surface/patch_sides.h>

namespace snug {
namespace {

using CrossingState = LinePieceCrossing::State;

// Tubes that are tried later are narrower, or their pieces smaller even for them: around a vertex of many needles there is little
// room between their edges.
constexpr double smaller_share = 0x1p-4;
constexpr double narrowing = 0x1p-10;
constexpr unsigned tubes = 3;
// Rays of one group are at most so far from its first one, as a share of the surface's radius.
constexpr double widest_group = 0x1p-5;

// Pieces that hold the ray's line are split until they bend by less than that: so much of it may be too long.
constexpr double max_line_bend = 0x1p-12;

// Lines beside the ray that are tried, on a spiral across the tube.
constexpr unsigned trials = 160;

class Spiral {
 public:
  explicit Spiral(double radius) : radius_(radius) {}
  // From the middle outwards, as the seeds of a sunflower lie.
  [[nodiscard]] Offset2 next() {
    const double size = 0.95 * radius_ * std::sqrt(static_cast<double>(taken_++) / trials);
    const Offset2 place{size * turn_.x, size * turn_.y};
    turn_ = {-0.7373688780783197 * turn_.x - 0.6754902942615238 * turn_.y,
             0.6754902942615238 * turn_.x - 0.7373688780783197 * turn_.y};
    return place;
  }

 private:
  double radius_;
  unsigned taken_ = 0;
  Offset2 turn_{1, 0};
};

// A piece in the tube around a ray that is not split further.
struct Leaf {
  SeenPiece seen;
  LinePieceCrossing crossing;  // of the ray itself
  Extent along;                // of all of the piece in the tube
  Node node;
};

// The sides of a patch beyond which there is no other, or more than one: a bit each.
unsigned open_sides(const LimitSurface& surface, PatchId root) {
  const Topology& topology = surface.topology();
  const auto without_surface = [&](std::size_t owner) {
    const auto [begin, end] = surface.patches_of(owner);
    return begin == end || !surface.has_patch(PatchId(begin));
  };
  const std::array<PatchSide, 3> sides = sides_of(surface, root);
  unsigned open = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (sides[k].part == PatchSide::Part::inside) continue;
    const EdgeId edge(sides[k].number);
    const HalfEdge half = topology.half_of(edge);
    const bool ends =
        topology.ends_fans(edge) ||
        (surface.rules().primal
             ? without_surface(topology.face_of(half).index()) ||
                   without_surface(topology.face_of(topology.twin(half)).index())
             : without_surface(topology.from(half).index()) || without_surface(topology.to(half).index()));
    open |= static_cast<unsigned>(ends) << k;
  }
  return open;
}

// A ray that no pieces decide each by itself.
class TubeWalk {
 public:
  TubeWalk(PieceCache& cache, const GroupedRay& ray, const WorkMonitor& monitor)
      : cache_(cache),
        task_(*ray.task),
        monitor_(monitor),
        near_(ray.near),
        ray_(task_.origin, task_.along),
        splits_(quick_splits(task_)) {
    for (std::size_t k = 0; k < 3; ++k) segment_.direction[k][0] = static_cast<float>(task_.along[k]);
    segment_.half[0] = float_up(near_.half * (1 + 0x1p-20));
  }

  FoundHits run() {
    cache_.begin();
    FoundHits best;
    best.complete = false;
    double reach = std::clamp(task_.precision / 8, 0x1p-34, 0x1p-10);
    // Roundings alone are off by more than 2^-46 of that.
    const double least = 0x1p-40 * (1 + near_.far);
    reach = std::max(reach, least);
    double share = tube_share;
    bool resolved = false;
    for (unsigned i = 0; i < tubes + (resolved ? 2 : 0); ++i) {
      const bool certain = search_tube(reach, std::max(share * reach, 0x1p-4 * least));
      const double widest = widest_hit();
      const bool located = certain && !(widest > task_.precision);
      const bool ended = !found_.complete;
      if (i == 0 || (!ended && (certain || !resolved))) best = std::move(found_);
      resolved = resolved || certain;
      if (located || ended || (resolved && task_.query == RayQuery::any)) break;
      if (certain) {  // but too wide: as much narrower as that
        if (!(reach > least)) break;
        reach = std::max(std::clamp(0.25 * task_.precision / widest, narrowing, 0.25) * reach, least);
      } else {  // around needles there is room between smaller pieces, even where rounding leaves no narrower tube
        share *= smaller_share;
        if (resolved) {  // no narrower than is needed
          reach *= std::clamp(0.9 * task_.precision / widest, 1.0, 8.0);
        } else if (narrowing * reach > 16 * least) {
          reach *= narrowing;
        }
      }
    }
    return best;
  }

 private:
  void start() {
    open_.start(Order::nearest_first, {cache_.root(), -INFINITY});
    found_ = {};
  }

  // Adds what a node opens to, none of it before the node's own begin, unless it is farther than `reach` from the
  // line or behind `end`.
  void open(const NodeGap& at, double reach, float end) {
    const PieceCache::Opened opened = cache_.open(at.node);
    const Vector3 from = near_.middle - opened.boxes->origin();
    for (std::size_t k = 0; k < 3; ++k) segment_.middle[k][0] = static_cast<float>(from[k]);
    segment_.origin[0] = static_cast<float>(-dot(task_.along, from));
    segment_.slack[0] = float_up(reach + near_.rounding + 0x1p-118);
    std::array<float, kernels::node_width> begins;
    std::uint32_t met = kernels::boxes_met(*opened.boxes, segment_, 0, begins);
    for (; met != 0; met &= met - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(met));
      const float begin = std::max(at.gap, begins[i]);
      if (begin <= end) open_.add({opened.child(i), begin});
    }
  }

  [[nodiscard]] bool outside(const Extent& along, double end) const {
    return along.lower > end || along.upper < task_.outer.lower;
  }
  [[nodiscard]] SeenPiece seen(const Node& node) const {
    return {ray_, PieceCache::bounds_of(node), node.boxes->origin()};
  }

  // Does the ray lie in a piece, so that smaller ones would tell no more? Then `along` is narrowed.
  [[nodiscard]] bool lies_in(const Node& node, const SeenPiece& piece, double reach, Extent& along) {
    if (const Patch& patch = cache_.patch(node); patch.path.level() == 0) {
      const std::optional<Facet> facet = facet_of(cache_.model().surface(), cache_.name(node).patch);
      if (facet && facet->far) {
        // The whole quad: halves of it end along a curve.
        const std::array<Point3, 4> quad{facet->triangle[0], facet->triangle[1], facet->triangle[2],
                                         *facet->far};
        if (const auto chord = chord_in_plane(ray_, quad, facet->error + facet->off, reach)) {
          along = {std::max(along.lower, chord->lower), std::min(along.upper, chord->upper)};
          return true;
        }
      }
    }
    return piece.bend() <= max_line_bend && piece.seems_to_hold_line(along);
  }

  [[nodiscard]] double widest_hit() const {
    double widest = 0;
    for (const FoundHit& hit : found_.hits) widest = std::max(widest, hit.along.upper - hit.along.lower);
    return widest;
  }

  void add_hit(const Node& node, const Extent& along, bool certified, int side, TriangleParameter at) {
    found_.hits.push_back({along, certified, task_.is_located(along), side, cache_.name(node), at});
  }

  // All pieces within `reach` of the line, known up to `fine` or thinner, in groups that are apart along it.
  struct Tube {
    TubeWalk& walk;
    double reach, fine;
    std::vector<Leaf> leaves{};  // of groups that are not yet resolved
    double end_of_group = -INFINITY;
    bool resolved = true, done = false;  // Is each group crossed for certain? Is that enough?

    Verb look_at(const NodeGap& at) {
      const Node& node = at.node;
      const double begin = walk.near_.centre + static_cast<double>(at.gap) - walk.near_.rounding;
      // The first of the others begins behind all of the group.
      if (!leaves.empty() && begin > end_of_group) {
        resolve_leaves();
        if (done) return Verb::stop;
      }
      if (begin > walk.near_.upper + reach) return Verb::stop;
      if (!node.bounded()) return Verb::open;
      walk.monitor_.checkpoint();
      const SeenPiece piece = walk.seen(node);
      LinePieceCrossing near = piece.crossing({}, reach);
      if (near.state == CrossingState::none) return Verb::drop;
      // Its boxes begin there, so that groups follow one another.
      near.along.lower = std::max(near.along.lower, begin);
      if (near.along.upper < near.along.lower || walk.outside(near.along, walk.near_.upper + reach)) {
        return Verb::drop;
      }
      if (near.state != CrossingState::one && walk.lies_in(node, piece, reach, near.along)) {
        if (near.along.upper < near.along.lower) return Verb::drop;
        add_leaf(node, piece, near.along);
        return Verb::drop;
      }
      const double off = near.limited_by_errors ? piece.error() : piece.width() + 2 * piece.error();
      const bool out_of_budget = walk.splits_ >= walk.task_.budget || walk.cache_.full();
      if (out_of_budget) walk.found_.complete = false;
      if (out_of_budget || off <= fine || !walk.cache_.can_open_further(node)) {
        add_leaf(node, piece, near.along);
        return out_of_budget ? Verb::stop : Verb::drop;
      }
      ++walk.splits_;
      return Verb::open;
    }
    void add_leaf(const Node& node, const SeenPiece& piece, const Extent& along) {
      leaves.push_back({piece, piece.crossing({}, 0), along, node});
      end_of_group = std::max(end_of_group, along.upper);
    }
    void open(const NodeGap& at) { walk.open(at, reach, walk.near_.from_middle(walk.near_.upper + reach)); }

    void resolve_leaves() {
      std::sort(leaves.begin(), leaves.end(),
                [](const Leaf& x, const Leaf& y) { return x.along.lower < y.along.lower; });
      for (std::size_t begin = 0, end; begin < leaves.size() && !done; begin = end) {
        Extent along = leaves[begin].along;
        for (end = begin + 1; end < leaves.size() && !(leaves[end].along.lower > along.upper); ++end) {
          along.add(leaves[end].along);
        }
        resolve_group(std::span(leaves).subspan(begin, end - begin), along);
      }
      leaves.clear();
      end_of_group = -INFINITY;
    }

    // One group. Its border, but for that of an open surface, belongs to pieces that no line in the tube meets: so
    // each of these crosses the group equally often, signs counted.
    void resolve_group(std::span<const Leaf> group, const Extent& along) {
      if (walk.outside(along, walk.task_.outer.upper)) return;
      const bool whole =
          walk.found_.complete && walk.task_.within(along) &&
          std::none_of(group.begin(), group.end(), [&](const Leaf& leaf) { return near_open_side(leaf); });
      const Leaf* at = &group.front();
      TriangleParameter place = at->crossing.at;
      int number = 0;
      if (whole) {
        Spiral spiral(reach);
        for (unsigned i = 0; i < trials; ++i) {
          const auto counted = count(group, spiral.next());
          if (!counted) continue;
          number = counted->number;
          if (counted->leaf != nullptr) {
            at = counted->leaf;
            place = counted->at;
          }
          break;
        }
      }
      // An answer for each crossing that is left, where all are wanted.
      const int answers = walk.task_.query == RayQuery::all ? std::max(1, std::abs(number)) : 1;
      for (int i = 0; i < answers; ++i) {
        walk.add_hit(at->node, along, number != 0, std::clamp(number, -1, 1), place);
      }
      resolved = resolved && number != 0;
      done = number != 0 && walk.task_.query != RayQuery::all;
    }

    struct Count {
      int number = 0;
      const Leaf* leaf = nullptr;  // one that is crossed
      TriangleParameter at;
    };
    [[nodiscard]] static std::optional<Count> count(std::span<const Leaf> group, const Offset2& place) {
      Count result;
      for (const Leaf& leaf : group) {
        const LinePieceCrossing crossing = leaf.seen.crossing(place, 0);
        if (crossing.state == CrossingState::none) continue;
        if (crossing.state != CrossingState::one) return std::nullopt;
        result.number += crossing.side;
        result.leaf = &leaf;
        result.at = crossing.at;
      }
      return result;
    }

    [[nodiscard]] bool near_open_side(const Leaf& leaf) {
      const PatchId root = walk.cache_.name(leaf.node).patch;
      unsigned sides = open_sides(walk.cache_.model().surface(), root);
      if (sides == 0) return false;
      const PiecePath& path = walk.cache_.patch(leaf.node).path;
      for (unsigned level = 0; level < path.level(); ++level) {
        const unsigned child = path.digit(level);
        sides &= child == 3 ? 0u : 1u << child | 1u << (child + 2) % 3;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        if ((sides >> k & 1u) != 0 && !leaf.seen.passes_side(k, {}, reach)) return true;
      }
      return false;
    }
  };

  // True if each group is crossed for certain.
  bool search_tube(double reach, double fine) {
    start();
    Tube question{*this, reach, fine};
    search(open_, question);
    if (!question.done) question.resolve_leaves();
    if (task_.query == RayQuery::any) keep_certified();
    found_.sort();
    return question.resolved;
  }

  void keep_certified() {
    auto& hits = found_.hits;
    const auto certified =
        std::find_if(hits.begin(), hits.end(), [](const FoundHit& hit) { return hit.certified; });
    if (certified != hits.end()) hits.assign(1, FoundHit(*certified));
  }

  PieceCache& cache_;
  const RayTask& task_;
  const WorkMonitor& monitor_;
  const NearPart near_;
  const RayFrame ray_;
  kernels::SeenSegments segment_{};  // in lane 0
  Frontier<NodeGap>& open_ = cache_.open_nodes();
  FoundHits found_;
  std::uint64_t splits_;
};

}  // namespace

void walk_rays(PieceCache& cache, std::span<const RayTask> tasks, const WorkMonitor& monitor,
               std::span<FoundHits> found) {
  const Ball& ball = cache.model().tree().ball();
  std::vector<GroupedRay> rays;
  rays.reserve(tasks.size());
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const NearPart near(tasks[i], ball);
    found[i].hits.clear();
    found[i].complete = true;
    if (!near.bounded() || near.empty()) {
      found[i].complete = near.bounded();
      continue;
    }
    rays.push_back({&tasks[i], near, &found[i]});
  }
  for (std::size_t begin = 0, end; begin < rays.size(); begin = end) {
    const std::size_t most = std::min(rays.size(), begin + kernels::ray_width);
    for (end = begin + 1; end < most && lie_close(rays[begin], rays[end], widest_group * ball.radius);
         ++end) {
    }
    const std::span<GroupedRay> group = std::span(rays).subspan(begin, end - begin);
    cache.begin();
    RayGroup(cache, group, monitor).run();
  }
  for (const GroupedRay& ray : rays) {
    if (!ray.decided()) *ray.found = TubeWalk(cache, ray, monitor).run();
  }
}

}  // namespace snug
