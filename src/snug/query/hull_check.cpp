#include <snug/query/hull_check.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#include <snug/contacts.h>
#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/query/closest.h>
#include <snug/query/pair_queries.h>
#include <snug/search/facet_rows.h>
#include <snug/search/piece_set.h>
#include <snug/search/self_contact.h>
#include <snug/search/surface_data.h>
#include <snug/search/triangle_sides.h>
#include <snug/surface/evaluate.h>
#include <support/run.h>
#include <support/system_files.h>

namespace snug {
namespace {

using Names = std::array<std::uint32_t, 3>;

constexpr std::size_t max_contacts = 100;
// To show that a hull is off the surface: splits, and different pieces split of each, for each of its triangles and
// beside those.
constexpr std::uint64_t splits_a_triangle = 16, splits_beside = 1'000'000;
constexpr std::uint64_t splits_kept_a_triangle = 2, splits_kept_beside = 50'000;

// Triangles of a hull as a surface of their own.
class FacetSurface {
 public:
  FacetSurface(const Hull& hull, std::span<const std::uint32_t> which, std::uint64_t max_kept,
               const std::shared_ptr<BoundsCache>& library, const WorkMonitor& monitor)
      : limit_(mesh_of(hull, which), SchemeOptions{Scheme::flat}, library, monitor),
        bvh_(limit_, {}, monitor),
        workspace_(bvh_, max_kept) {}

  [[nodiscard]] PlacedBvh placed() { return {bvh_, workspace_, {}}; }
  [[nodiscard]] const SurfaceBvh& model() const { return bvh_; }
  [[nodiscard]] PieceCache& workspace() { return workspace_; }

 private:
  static ControlMesh mesh_of(const Hull& hull, std::span<const std::uint32_t> which) {
    ControlMesh mesh;
    std::unordered_map<std::uint32_t, std::uint32_t> names;
    for (const std::uint32_t t : which) {
      std::array<VertexId, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [name, added] =
            names.emplace(hull.triangles[t][k], static_cast<std::uint32_t>(mesh.points.size()));
        if (added) mesh.points.push_back(hull.positions[name->first]);
        corners[k] = VertexId(name->second);
      }
      mesh.add_face(corners);
    }
    return mesh;
  }

  LimitSurface limit_;
  SurfaceBvh bvh_;
  PieceCache workspace_;
};

// All that is claimed, by queries that know nothing of how the hulls were made.
class Verification {
 public:
  Verification(const Surface& surface, const HullOptions& options, const Hulls& hulls, const Run& run)
      : surface_(surface),
        model_(surface.data()->bvh()),
        options_(options),
        hulls_(hulls),
        monitor_(stop_only(run)),
        run_{.threads = run.threads, .monitor = &monitor_},
        largest_count_(largest_count(hulls)) {}

  std::vector<HullProblem> run() {
    if (hulls_.closed) own_points_ = points_of(model_);
    std::array<bool, 2> whole{};
    for (const bool inner : {true, false}) {
      const std::optional<Hull>& hull = inner ? hulls_.inner : hulls_.outer;
      if (!hull || !is_whole(*hull, inner)) continue;
      whole[inner] = true;
      system_files::return_free_memory();
      near(*hull, inner);
      if (hulls_.closed) around(*hull, inner);
      system_files::return_free_memory();
      for_each_part(*hull, [&](std::span<const std::uint32_t> part) {
        FacetSurface facets = surface_of(*hull, part);
        PieceCache own(model_, max_kept());
        apart({model_, own, {}}, facets.placed(), HullFault::meets_surface, inner);
      });
    }
    // Those of a closed surface lie on different sides of it.
    if (whole[0] && whole[1] && !hulls_.closed) {
      const std::vector<std::uint8_t> all(hulls_.outer->triangles.size(), 1);
      const FacetRows rows(all, 0, [&](std::size_t t) { return triangle_of(*hulls_.outer, t); });
      for_each_part(*hulls_.inner, [&](std::span<const std::uint32_t> part) {
        Box3 box;
        for (const std::uint32_t t : part) {
          for (const Point3& p : triangle_of(*hulls_.inner, t)) box.add(p);
        }
        std::vector<std::uint32_t> near;
        rows.visit(box, [&](std::size_t t) { near.push_back(static_cast<std::uint32_t>(t)); });
        if (near.empty()) return;
        FacetSurface inner = surface_of(*hulls_.inner, part), outer = surface_of(*hulls_.outer, near);
        apart(inner.placed(), outer.placed(), HullFault::meets_other, true, part);
      });
    }
    return std::move(problems_);
  }

 private:
  static std::uint64_t largest_count(const Hulls& hulls) {
    std::uint64_t largest = 0;
    for (const auto* hull : {&hulls.inner, &hulls.outer}) {
      if (*hull) largest = std::max<std::uint64_t>(largest, (*hull)->triangles.size());
    }
    return largest;
  }
  [[nodiscard]] std::uint64_t max_kept() const {
    return splits_kept_beside + splits_kept_a_triangle * largest_count_;
  }
  static std::vector<std::uint32_t> all_of(const Hull& hull) {
    std::vector<std::uint32_t> all(hull.triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }
  // Calls check(triangles) for parts of a hull that lie together, until one fails: what queries keep of all of it would take most of
  // the memory.
  template <class Check>
  void for_each_part(const Hull& hull, const Check& check) const {
    std::vector<Point3> centres;
    centres.reserve(hull.triangles.size());
    for (const Names& t : hull.triangles)
      centres.push_back(model_.surface().scale().apply(hull.positions[t[0]]));
    const std::vector<std::uint32_t> order = in_order_of_place(centres, run_.threads);
    const std::size_t before = problems_.size();
    for (std::size_t begin = 0; begin < order.size() && problems_.size() == before; begin += part_size)
      check(std::span(order).subspan(begin, std::min(part_size, order.size() - begin)));
  }
  // Scaled: sides may be longer than any double.
  [[nodiscard]] Triangle triangle_of(const Hull& hull, std::size_t t) const {
    const PowerOfTwo scale = model_.surface().scale();
    const auto& [a, b, c] = hull.triangles[t];
    return {scale.apply(hull.positions[a]), scale.apply(hull.positions[b]), scale.apply(hull.positions[c])};
  }
  [[nodiscard]] FacetSurface surface_of(const Hull& hull, std::span<const std::uint32_t> which) const {
    return {hull, which, max_kept(), model_.surface().shared_library(), monitor_};
  }
  // A limit point of each component.
  struct Member {
    Point3 position;
    std::uint32_t owner;
  };
  std::vector<Member> points_of(const SurfaceBvh& model) {
    const LimitSurface& surface = model.surface();
    std::vector<Member> points;
    for (const PatchId p : model.solid().components()) {
      const SurfacePoint at = evaluate(surface, place_of(surface, p, {1.0 / 3, 1.0 / 3}));
      points.push_back({at.point, surface.place(p).owner});
      // Sets that do not meet must be farther apart than this: then the limit point is on the side of the double.
      certain_gap_ = std::max(certain_gap_, 2 * at.error);
    }
    return points;
  }
  void blame(HullFault fault, bool inner, const Point3& place, std::optional<std::uint32_t> owner) {
    problems_.push_back({fault, inner, place, owner});
  }
  // Does it touch itself at vertices and edges only, and is it closed where the surface is?
  bool is_whole(const Hull& hull, bool inner) {
    const std::size_t before = problems_.size();
    const auto blame_triangle = [&](HullFault fault, std::size_t t) {
      blame(fault, inner, hull.positions[hull.triangles[t][0]], hull.owners[t]);
    };
    const TriangleSides sides = sides_of(hull.triangles);
    if (sides.same_way) blame_triangle(HullFault::meets_itself, (*sides.same_way)[1]);
    if (hulls_.closed && sides.border) blame_triangle(HullFault::not_around, 0);
    std::vector<Point3> points;
    points.reserve(hull.positions.size());
    for (const Point3& p : hull.positions) points.push_back(model_.surface().scale().apply(p));
    for (const auto& [a, b, contact] :
         self_contacts(points, hull.triangles, max_contacts, run_.threads, monitor_)) {
      blame_triangle(HullFault::meets_itself, a);
    }
    return problems_.size() == before;
  }
  // `part`: of the inner hull, against the outer one.
  void apart(const PlacedBvh& a, const PlacedBvh& b, HullFault fault, bool inner,
             std::span<const std::uint32_t> part = {}) {
    const Collision found = collide(
        a, b,
        {.tolerance = 0, .margin = certain_gap_, .witness = WitnessKind::approximate, .prove_contact = true},
        {.monitor = &monitor_, .max_splits = splits_beside + splits_a_triangle * largest_count_});
    if (found.verdict == Verdict::separated) return;
    std::optional<std::uint32_t> owner;
    if (found.witness && (*found.witness)[0].at) {
      const std::uint32_t of_a = (*found.witness)[0].at->owner;
      owner = fault == HullFault::meets_other ? hulls_.inner->owners[part[of_a]] : of_a;
    }
    blame(fault, inner, found.witness ? (*found.witness)[0].point : Point3{}, owner);
  }
  void near(const Hull& hull, bool inner) {
    const Deviation found =
        deviation(surface_, hull.positions, hull.triangles,
                  {.absolute = 0x1p-6 * *options_.error, .threshold = *options_.error}, run_);
    for (const OneSidedDistance* side : {&found.from_surface, &found.from_candidate}) {
      if (side->distance.upper <= *options_.error) continue;
      std::optional<std::uint32_t> owner;
      if (side->from.at) owner = side->from.at->owner;
      blame(HullFault::no_position, inner, side->from.point, owner);
    }
  }
  // One lies in the solid of the other with all its components, and none of these in the solid of the one.
  void around(const Hull& hull, bool inner) {
    FacetSurface facets = surface_of(hull, all_of(hull));
    PieceCache own(model_, max_kept());
    const std::vector<Member> points_of_hull = points_of(facets.model());
    for (const bool of_hull : {false, true}) {
      for (const auto& [position, owner] : of_hull ? points_of_hull : own_points_) {
        const std::optional<bool> inside = contains(of_hull ? own : facets.workspace(), position, run_);
        if (inside == (of_hull == inner)) continue;
        blame(HullFault::not_around, inner, position, of_hull ? hull.owners[owner] : owner);
      }
    }
  }

  static constexpr std::size_t part_size = 4096;

  const Surface& surface_;
  const SurfaceBvh& model_;
  const HullOptions& options_;
  const Hulls& hulls_;
  WorkMonitor monitor_;
  Run run_;                      // with this monitor
  std::uint64_t largest_count_;  // of triangles of a hull
  std::vector<Member> own_points_;
  double certain_gap_ = 0;  // mesh units
  std::vector<HullProblem> problems_;
};

}  // namespace

std::vector<HullProblem> problems_of(const Surface& surface, const Hulls& hulls, const HullOptions& options,
                                     const Run& run) {
  return Verification(surface, options, hulls, run).run();
}

}  // namespace snug
