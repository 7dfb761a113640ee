#include <snug/query/hull.h>
#include <snug/search/surface_data.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <snug/contacts.h>
#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/geometry/nearest_to_origin.h>
#include <snug/geometry/rounding.h>
#include <snug/query/closest.h>
#include <snug/query/local_tolerances.h>
#include <snug/query/pair_queries.h>
#include <snug/query/self.h>
#include <snug/query/tessellate.h>
#include <snug/search/feet.h>
#include <snug/search/piece.h>
#include <snug/search/precision.h>
#include <snug/search/self_contact.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/unscale.h>
#include <support/direction.h>
#include <support/error.h>
#include <support/names.h>
#include <support/parallel.h>
#include <support/run.h>
#include <support/system_files.h>

namespace snug {
namespace {

using Names = std::array<std::uint32_t, 3>;

constexpr auto fault_names = std::to_array<Named<HullFault>>({
    {"no-position", HullFault::no_position},
    {"meets-surface", HullFault::meets_surface},
    {"meets-itself", HullFault::meets_itself},
    {"meets-other", HullFault::meets_other},
    {"not-around", HullFault::not_around},
    {"too-few-triangles", HullFault::too_few_triangles},
    {"through-itself", HullFault::through_itself},
});

// Of the tolerance: that of the triangles which are moved, at first; below which it is no longer made smaller,
// where a vertex has no position, and where facets meet something.
constexpr double first_share = 0.4, min_share = 0x1p-6, min_share_apart = 0x1p-8;
// And down to which it is made smaller at once where facets turn over.
constexpr double turned_share = 0x1p-3;
// How much longer than the shortest a displacement may be that goes the way the surface faces.
constexpr double longest_detour = 1.25;
// Vertices of facets that turn over: means over neighbours of the way they go, of the error that is left there how far they may go, and how
// often they are looked for.
constexpr int smoothing_passes = 4, max_steered = 4;
constexpr double room_share = 0.95;
// Of the tolerance of a triangle: how much farther off its plane than its error its facet is kept, and the error
// of the quadratics that it is to be kept off.
constexpr double clearance = 0.1, quadratic_share = 0x1p-4;
// And how far Bezier points of its parts may stick out of them.
constexpr double flat_share = 0x1p-5;
constexpr std::size_t max_problems = 100, max_contacts = 1'000'000;
constexpr int max_rounds = 40;
// Rounds in which facets with the least tolerance fail before a hull is given up, and the share of the error of those beside a place
// where the surface touches itself.
constexpr int max_rounds_at_least = 3;
constexpr double touching_share = 0x1p-5;
// How much larger than that of a facet which fails a tolerance beside it may be.
constexpr double max_growth = 2;
// After which it is asked whether the surface meets itself, if one hull is wanted; of both the first to fail asks at once.
constexpr int rounds_alone = 4;
// Most quadratics that facets are kept off: of the budget, and beside a few of them.
constexpr std::uint64_t pieces_a_triangle = 16, pieces_beside = 1u << 17;
// To show that a hull is off the surface: splits, and different pieces split of each, for each of its triangles and
// beside those.
constexpr std::uint64_t splits_a_triangle = 16, splits_beside = 1'000'000;
constexpr std::uint64_t splits_kept_a_triangle = 2, splits_kept_beside = 50'000;
// To show that a surface without hulls at first meets itself, pairs of pieces: a second or two.
constexpr std::uint64_t tests_a_patch = 4, tests_beside = 100'000;
// Down to which share of the error tolerances are made smaller for whole owners.
constexpr double whole_share = 0x1p-4;
// Of the angle between sheets that go through each other.
constexpr double least_sine = 0x1p-10;

// How triangles meet along their edges.
struct Sides {
  std::optional<std::array<std::size_t, 2>> same_way;  // two that run along an edge the same way
  bool border = false;                                 // does an edge belong to one triangle only?
};

Sides sides_of(std::span<const Names> triangles) {
  Sides found;
  std::unordered_map<std::uint64_t, std::size_t> sides;
  sides.reserve(3 * triangles.size());
  const auto key = [](std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [there, added] = sides.emplace(key(triangles[t][k], triangles[t][(k + 1) % 3]), t);
      if (!added) found.same_way = {there->second, t};
    }
  }
  found.border = std::any_of(sides.begin(), sides.end(), [&](const auto& side) {
    return !sides.contains(
        key(static_cast<std::uint32_t>(side.first), static_cast<std::uint32_t>(side.first >> 32)));
  });
  return found;
}

// Is there a border? Refuses what has no two sides.
bool has_border(const Tessellation& mesh) {
  const Sides sides = sides_of(mesh.triangles);
  if (!sides.same_way) return sides.border;
  const auto [s, t] = *sides.same_way;
  throw InputError(InputProblem::refused,
                   "hull: faces " + std::to_string(mesh.owners[s]) + " and " +
                       std::to_string(mesh.owners[t]) +
                       " run along an edge of the surface the same way, so that it has no two sides there; "
                       "orient the faces, or separate sheets that share an edge");
}

// Are the faces of a closed surface oriented inward, on the whole? No proof rests on it.
bool is_inward(const Tessellation& mesh, PowerOfTwo scale) {
  const Point3 origin = scale.apply(mesh.positions[0]);
  double volume = 0;
  for (const Names& t : mesh.triangles) {
    const auto from = [&](std::uint32_t v) { return scale.apply(mesh.positions[v]) - origin; };
    volume += dot(from(t[0]), cross(from(t[1]), from(t[2])));
  }
  return volume < 0;
}

// One problem of a sort and side for each owner, and not too many.
void keep_some(std::vector<HullProblem>& problems) {
  std::set<std::tuple<HullFault, bool, std::optional<std::uint32_t>>> known;
  std::erase_if(problems,
                [&](const HullProblem& p) { return !known.emplace(p.fault, p.inner, p.owner).second; });
  if (problems.size() > max_problems) problems.resize(max_problems);
}

std::uint64_t max_pieces(const LimitSurface& surface, const Run& run) {
  const std::uint64_t triangles =
      std::max<std::uint64_t>(run.max_splits.value_or(default_splits::hull), surface.patch_count());
  return pieces_beside + pieces_a_triangle * std::min(triangles, std::uint64_t{1} << 40);
}

// The quadratics that facets are kept off. All together would take a third of the memory: they are made where they are looked at, for
// a few patches that lie together at a time.
class NearPieces {
 public:
  // Errors are at most `error`, in scaled units, where refine() does not make them less.
  NearPieces(const LimitSurface& surface, double error, const Run& run)
      : surface_(surface), error_(error), run_(run), max_(max_pieces(surface, run)) {
    std::vector<PatchId> there;
    std::vector<Point3> centres;
    for (std::size_t i = 0; i < surface.patch_count(); ++i) {
      const PatchId patch(i);
      if (!surface.has_patch(patch)) continue;
      there.push_back(patch);
      centres.push_back(surface.patch(patch).origin);
    }
    for (const std::uint32_t i : in_order_of_place(centres, run.threads)) patches_.push_back(there[i]);
    boxes_.resize(std::min(patches_.size(), max_blocks));
  }

  // Calls visit(set, box) for sets of pieces in boxes for which is_near(box): on several threads, and not for all of them if
  // there are too many; then it is false.
  template <class IsNear, class Visit>
  [[nodiscard]] bool visit(const IsNear& is_near, const Visit& visit) {
    std::atomic<std::uint64_t> count{0};
    parallel_for(boxes_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        run_.monitor->checkpoint();
        if ((boxes_[b] && !is_near(*boxes_[b])) || count.load(std::memory_order_relaxed) > max_) continue;
        const std::size_t first = b * patches_.size() / boxes_.size(),
                          last = (b + 1) * patches_.size() / boxes_.size();
        PieceSet set(surface_, std::span(patches_).subspan(first, last - first), error_, finer_, 1,
                     *run_.monitor, max_);
        count.fetch_add(set.size() > 0 ? set.size() : max_ + 1, std::memory_order_relaxed);
        if (set.size() == 0) continue;
        set.prepare(1);
        boxes_[b] = set.box();
        if (is_near(*boxes_[b])) visit(set, *boxes_[b]);
      }
    });
    return count.load() <= max_;
  }
  // To be made finer. Those that are marked, each once, in their order.
  void mark(const std::vector<PieceName>& pieces) {
    marked_.insert(marked_.end(), pieces.begin(), pieces.end());
  }
  [[nodiscard]] const std::vector<PieceName>& marked() {
    std::sort(marked_.begin(), marked_.end());
    return marked_;
  }
  void refine(double error) {
    for (const PieceName& name : marked_) finer_[name] = error;
    marked_.clear();
  }

 private:
  static constexpr std::size_t max_blocks = 16;

  const LimitSurface& surface_;
  double error_;
  const Run& run_;
  std::uint64_t max_;
  std::vector<PatchId> patches_;            // block by block
  std::vector<std::optional<Box3>> boxes_;  // of the blocks, once they are known
  PieceSet::FinerPieces finer_;
  std::vector<PieceName> marked_;
};

// Triangles around each vertex.
class TrianglesAround {
 public:
  explicit TrianglesAround(const Tessellation& mesh)
      : begins_(mesh.positions.size() + 1), triangles_(3 * mesh.triangles.size()) {
    for (const Names& t : mesh.triangles) {
      for (const std::uint32_t v : t) ++begins_[v + 1];
    }
    for (std::size_t v = 1; v < begins_.size(); ++v) begins_[v] += begins_[v - 1];
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) triangles_[next[v]++] = static_cast<std::uint32_t>(t);
    }
  }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t v) const {
    return std::span(triangles_).subspan(begins_[v], begins_[v + 1] - begins_[v]);
  }

 private:
  std::vector<std::uint32_t> begins_, triangles_;
};

// Marked triangles by boxes around them, and around some in a row, which mostly lie together.
class FacetRows {
 public:
  // `corners(t)`: of triangle t. Boxes are larger than the triangles by `growth` times their longest sides.
  template <class CornersOf>
  FacetRows(std::span<const std::uint8_t> marks, double growth, const CornersOf& corners)
      : marks_(marks), growth_(growth), corners_(corners), rows_((marks.size() + row - 1) / row) {
    for (std::size_t t = 0; t < marks.size(); ++t) {
      if (marks[t] != 0) rows_[t / row].add(box(t));
    }
  }
  [[nodiscard]] bool meet(const Box3& box) const {
    return std::any_of(rows_.begin(), rows_.end(), [&](const Box3& r) { return overlap(r, box); });
  }
  template <class Visit>
  void visit(const Box3& box, const Visit& visit) const {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      if (!overlap(rows_[r], box)) continue;
      for (std::size_t t = r * row; t < std::min(marks_.size(), (r + 1) * row); ++t) {
        if (marks_[t] != 0 && overlap(this->box(t), box)) visit(t);
      }
    }
  }

 private:
  static constexpr std::size_t row = 64;

  [[nodiscard]] Box3 box(std::size_t t) const {
    Box3 box;
    for (const Point3& p : corners_(t)) box.add(p);
    const double more = growth_ * longest_side(box);
    for (std::size_t k = 0; k < 3; ++k) {
      box.lower[k] -= more;
      box.upper[k] += more;
    }
    return box;
  }

  std::span<const std::uint8_t> marks_;
  double growth_;
  std::function<Triangle(std::size_t)> corners_;
  std::vector<Box3> rows_;
};

struct SurfacePlace {
  Point3 point;
  std::uint32_t owner;
};

// Do the two sheets lie across each other there? Where they only touch there may be a hull on one side.
bool goes_through(const Surface& surface, const SelfContactPair& pair) {
  const auto a = normal_at(surface, *pair.points[0].at), b = normal_at(surface, *pair.points[1].at);
  return !pair.touching && a && b && length(cross(a->direction, b->direction)) > least_sine;
}

// Where a surface is proved to meet itself, found once it is asked for.
class OwnContacts {
 public:
  OwnContacts(const Surface& surface, const LimitSurface& limit, const Run& run)
      : surface_(surface), limit_(limit), run_(run) {}

  // The owners and places where it goes through itself.
  [[nodiscard]] const std::vector<SurfacePlace>& through() {
    find();
    return through_;
  }
  // Does it touch itself so near to a point? Then no hull gets between its sheets.
  [[nodiscard]] bool touches_near(const Point3& p, double reach) {
    find();
    return std::any_of(touching_.begin(), touching_.end(),
                       [&](const Point3& touching) { return distance(touching, p) <= reach; });
  }

 private:
  void find() {
    if (std::exchange(found_, true)) return;
    const WorkMonitor monitor = stop_only(run_);
    const SelfContact found =
        contact_far_apart(surface_, {.threads = run_.threads,
                                     .monitor = &monitor,
                                     .max_splits = tests_beside + tests_a_patch * limit_.patch_count()});
    if (found.verdict != SelfVerdict::intersecting) return;
    for (const SelfContactPair& pair : found.pairs) {
      if (goes_through(surface_, pair)) {
        through_.push_back({pair.points[0].point, pair.points[0].at->owner});
      } else {
        touching_.push_back(pair.points[0].point);
      }
    }
  }

  const Surface& surface_;
  const LimitSurface& limit_;
  const Run& run_;
  bool found_ = false;
  std::vector<SurfacePlace> through_;
  std::vector<Point3> touching_;
};

// Facets of earlier rounds that were found off the surface, and each two of them off each other: as long as their corners stay
// where they are they need not be compared again. Known by their hashes: what a wrong one leaves out is found where the hull is verified.
class KnownFacets {
 public:
  [[nodiscard]] bool contains(const Triangle& facet) const {
    return std::binary_search(known_.begin(), known_.end(), hash_of(facet));
  }
  // Those that are marked, and no others.
  template <class FacetOf>
  void assign(std::span<const std::uint8_t> marks, const FacetOf& facet) {
    known_.clear();
    for (std::size_t t = 0; t < marks.size(); ++t) {
      if (marks[t] != 0) known_.push_back(hash_of(facet(t)));
    }
    std::sort(known_.begin(), known_.end());
  }

 private:
  static std::uint64_t hash_of(const Triangle& facet) {
    std::uint64_t hash = 0;
    for (const Point3& p : facet) {
      for (const double x : {p.x, p.y, p.z}) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
      }
    }
    return hash;
  }
  std::vector<std::uint64_t> known_;
};

// A hull on one side, by triangles whose tolerances are made smaller where it fails.
class OneHull {
 public:
  OneHull(const LimitSurface& surface, const HullOptions& options, bool inner, const Run& run)
      : surface_(surface),
        options_(options),
        inner_(inner),
        monitor_(stop_only(run)),
        run_{.threads = run.threads,
             .monitor = &monitor_,
             .max_splits = run.max_splits.value_or(default_splits::hull)},
        scale_(surface.scale()),
        tolerances_(surface, std::vector<double>(surface.owner_count(), first_share * *options.error)),
        pieces_(surface, quadratic_share * first_share * scale_.apply(*options.error), run_) {}

  // Moves triangles until nothing is wrong, or nothing can be done about it. Returns the problems left; where the surface goes
  // through itself, which is asked after some rounds, only that.
  std::vector<HullProblem> run(OwnContacts& contacts, int asked_from) {
    for (int round = 0;; ++round) {
      end_round();
      LocalTessellation made = tessellate(surface_, tolerances_, {.normals = false}, run_);
      begin_round(made);
      if (round == 0) {
        faces_.border = has_border(mesh_);
        faces_.inward = !faces_.border && is_inward(mesh_, scale_);
      }
      move_vertices(std::move(made.errors));
      if (!whole_mesh() && !problems_.empty()) break;
      if (!facets_.any_turned && !keep_off() && !blame_budget()) break;
      if (problems_.empty()) break;
      if (round >= asked_from && !contacts.through().empty()) {
        problems_.clear();
        for (const SurfacePlace& place : contacts.through())
          problems_.push_back({HullFault::through_itself, inner_, place.point, place.owner});
        break;
      }
      if (round + 1 == max_rounds || !whole_mesh() || is_hopeless(contacts) || !refine()) break;
    }
    return std::move(problems_);
  }
  // Did the budget allow for all triangles?
  [[nodiscard]] bool whole_mesh() const { return mesh_.outcome == Outcome::complete; }
  [[nodiscard]] bool has_border_edges() const { return faces_.border; }
  // Oriented outward.
  [[nodiscard]] Hull take() {
    for (Names& t : mesh_.triangles) {
      if (faces_.inward) std::swap(t[1], t[2]);
    }
    return {std::move(facets_.positions), std::move(mesh_.triangles), std::move(mesh_.owners), facets_.gap};
  }

 private:
  // Before the next one makes its triangles: those of both would take most of the memory.
  void end_round() {
    mesh_ = {};
    parts_ = {};
    allowed_ = {};
    around_.reset();
    facets_ = {};
  }
  void begin_round(LocalTessellation& made) {
    mesh_ = std::move(made.mesh);
    mesh_.parameters = {};
    system_files::return_free_memory();
    parts_ = std::move(made.parts);
    around_.emplace(mesh_);
    allowed_.resize(parts_.size());
    parallel_for(parts_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) allowed_[t] = tolerances_.of(parts_[t]);
    });
    problems_.clear();
    failed_.clear();
    wrong_owners_.assign(surface_.owner_count(), 0);
  }

  // Did a facet fail whose tolerance was small before, for several rounds or beside a place where the surface touches itself?
  [[nodiscard]] bool is_hopeless(OwnContacts& contacts) {
    for (std::size_t i = 0; i < problems_.size(); ++i) {
      if (problems_[i].fault == HullFault::no_position) continue;
      const std::uint32_t t = failed_[i];
      if (tolerances_.times_at_least(parts_[t]) >= max_rounds_at_least) return true;
      if (allowed_[t] <= touching_share * *options_.error &&
          contacts.touches_near(problems_[i].place, *options_.error))
        return true;
    }
    return false;
  }

  // With a problem; returns false.
  bool blame_budget() {
    blame(HullFault::too_few_triangles, 0, mesh_.positions[mesh_.triangles[0][0]]);
    return false;
  }

  // Of the surface.
  struct Faces {
    bool border = false, inward = false;
  };
  // Triangles with their vertices moved.
  struct Facets {
    std::vector<Point3> positions{};
    double gap = 0;
    bool any_turned = false;
  };

  [[nodiscard]] Triangle scaled(const std::vector<Point3>& points, const Names& t) const {
    return {scale_.apply(points[t[0]]), scale_.apply(points[t[1]]), scale_.apply(points[t[2]])};
  }
  void blame(HullFault fault, std::size_t t, const Point3& place) {
    problems_.push_back({fault, inner_, place, mesh_.owners[t]});
    failed_.push_back(static_cast<std::uint32_t>(t));
    wrong_owners_[mesh_.owners[t]] = 1;
    const double least = fault == HullFault::no_position ? min_share : min_share_apart;
    mark(parts_[t], least);
    // What is much coarser beside it moves the vertices of both farther than what is fine has room for.
    for (const std::uint32_t v : mesh_.triangles[t]) {
      for (const std::uint32_t s : (*around_)[v]) {
        if (allowed_[s] > max_growth * allowed_[t]) mark(parts_[s], least);
      }
    }
  }
  // To be made finer, down to a share of the error.
  void mark(const PatchPart& part, double least) {
    tolerances_.mark(part, least * *options_.error, whole_share * *options_.error);
  }

  [[nodiscard]] QuadraticTriangle facet(std::size_t t) const {
    return flat_quadratic(scaled(facets_.positions, mesh_.triangles[t]));
  }
  // How far a vertex of a hull is at most moved when it becomes a float.
  [[nodiscard]] double float_loss() const {
    if (!options_.single_precision) return 0;
    const double largest = scale_.inverse().apply(2) + *options_.error;
    return 2 * (0x1p-24 * largest + 0x1p-150);
  }
  // The coordinates that are handed out.
  [[nodiscard]] Point3 as_written(Point3 p) const {
    for (std::size_t a = 0; a < 3 && options_.single_precision; ++a) {
      const auto rounded = static_cast<float>(p[a]);
      if (!std::isfinite(rounded)) {
        throw InputError(
            InputProblem::unrepresentable,
            "hull: a coordinate does not fit a float; scale the mesh down, or write a format that "
            "holds doubles");
      }
      p[a] = static_cast<double>(rounded);
    }
    return require_representable(p);
  }

  // The planes of triangles that their vertices are moved beyond.
  struct Planes {
    std::vector<Vector3> areas, normals;  // outward; area vectors, scaled, and of length 1
    std::vector<double> errors, offsets;  // of the surface, and how far beyond
  };
  [[nodiscard]] Planes planes_of(std::vector<double> errors) const {
    const std::size_t count = mesh_.triangles.size();
    const double float_loss = this->float_loss();
    Planes planes{std::vector<Vector3>(count), std::vector<Vector3>(count), std::move(errors),
                  std::vector<double>(count)};
    parallel_for(count, run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const Triangle triangle = scaled(mesh_.positions, mesh_.triangles[t]);
        planes.areas[t] = sign() * cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
        planes.normals[t] = sign() * unit_normal(triangle);
        planes.offsets[t] = planes.errors[t] + clearance * allowed_[t] + float_loss;
      }
    });
    return planes;
  }
  [[nodiscard]] double sign() const { return inner_ != faces_.inward ? -1 : 1; }

  // The way that the triangles around each vertex face together.
  [[nodiscard]] std::vector<Vector3> facings(const Planes& planes) const {
    std::vector<Vector3> facing(mesh_.positions.size());
    for (std::size_t v = 0; v < facing.size(); ++v) {
      for (const std::uint32_t t : (*around_)[v]) facing[v] = facing[v] + planes.areas[t];
      facing[v] = normalized(facing[v]);
    }
    return facing;
  }
  // Mean over the vertex and its neighbours, several times.
  [[nodiscard]] std::vector<Vector3> smoothed(std::vector<Vector3> facing) const {
    std::vector<Vector3> mean(facing.size());
    for (int pass = 0; pass < smoothing_passes; ++pass) {
      parallel_for(mean.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          Vector3 sum;
          for (const std::uint32_t t : (*around_)[v]) {
            for (const std::uint32_t w : mesh_.triangles[t]) sum = sum + facing[w];
          }
          mean[v] = normalized(sum);
        }
      });
      facing.swap(mean);
    }
    return facing;
  }

  // A vertex about as near as possible to where it was, beyond the planes of the triangles around it. The way that it faces goes before
  // the shortest one: beside a narrow triangle, whose normal may be anything, that leads past the next vertex. That way it may go `room`
  // however short the other one is. Nothing if there is no such place.
  [[nodiscard]] static std::optional<Vector3> displacement(std::span<const std::uint32_t> around,
                                                           const Planes& beyond, const Vector3& facing,
                                                           double room) {
    const auto& [areas, normals, errors, offsets] = beyond;
    std::vector<Vector3> planes;
    double largest = 0, along = 0;
    for (const std::uint32_t t : around) largest = std::max(largest, offsets[t]);
    for (const std::uint32_t t : around) {
      if (normals[t] == Vector3{}) continue;
      planes.push_back((largest / offsets[t]) * normals[t]);
      const double cosine = dot(facing, normals[t]);
      along = cosine > 0 ? std::max(along, offsets[t] / cosine) : INFINITY;
    }
    // A point of needles only: it stays, and is found to be on the surface.
    if (planes.empty()) return Vector3{};
    if (along <= room) return along * facing;
    const Vector3 z = nearest_to_origin(planes);
    const double square = length_sq(z);
    if (!(square > 1e-16)) return std::nullopt;
    // The shortest is largest / |z| long; lengths in mesh units have no squares.
    return along * std::sqrt(square) <= longest_detour * largest ? along * facing : (largest / square) * z;
  }
  // Where a vertex goes; how far, scaled: infinite if it has no place.
  double move_vertex(std::uint32_t v, const Planes& planes, const Vector3& facing, double share_of_room) {
    Point3& p = facets_.positions[v];
    p = mesh_.positions[v];
    double error = 0;
    for (const std::uint32_t t : (*around_)[v]) error = std::max(error, planes.errors[t]);
    const std::optional<Vector3> by =
        displacement((*around_)[v], planes, facing, share_of_room * (*options_.error - error));
    if (!by) return INFINITY;
    p = as_written(p + *by);
    return enlarged(distance(scale_.apply(p), scale_.apply(mesh_.positions[v])));
  }
  // Does a facet lie the other way round than its triangle: did corners move sideways past each other?
  [[nodiscard]] bool is_turned(std::size_t t, const Planes& planes) const {
    return sign() * dot(unit_normal(scaled(facets_.positions, mesh_.triangles[t])), planes.normals[t]) < 0;
  }
  // Vertices of such facets that are not steered yet, which now are.
  [[nodiscard]] std::vector<std::uint32_t> steer(const Planes& planes,
                                                 std::vector<std::uint8_t>& steered) const {
    std::vector<std::uint32_t> vertices;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!is_turned(t, planes)) continue;
      for (const std::uint32_t v : mesh_.triangles[t]) {
        if (std::exchange(steered[v], std::uint8_t{1}) == 0) vertices.push_back(v);
      }
    }
    return vertices;
  }

  // Each by itself at first. Where triangles are narrower than they move, and the surface has ripples, facets turn over: vertices of these go
  // the way that the surface faces on the whole, about as those beside them go.
  void move_vertices(std::vector<double> errors) {
    const Planes planes = planes_of(std::move(errors));
    facets_ = {.positions = mesh_.positions};
    std::vector<double> moved(mesh_.positions.size());
    std::vector<Vector3> facing = facings(planes);
    std::vector<std::uint8_t> steered(moved.size());
    std::vector<std::uint32_t> vertices(moved.size());
    std::iota(vertices.begin(), vertices.end(), 0u);
    for (int time = 0; !vertices.empty(); ++time) {
      if (time == 1) facing = smoothed(std::move(facing));
      parallel_for(vertices.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
        monitor_.checkpoint();
        for (const std::uint32_t v : std::span(vertices).subspan(begin, end - begin))
          moved[v] = move_vertex(v, planes, facing[v], time == 0 ? 0 : room_share);
      });
      if (time == max_steered) break;
      vertices = steer(planes, steered);
    }
    blame_moved(planes, moved);
  }
  // Facets that are too far from the surface, or turned.
  void blame_moved(const Planes& planes, std::span<const double> moved) {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Names& names = mesh_.triangles[t];
      const double most = std::max({moved[names[0]], moved[names[1]], moved[names[2]]});
      // Parameter by parameter: the facet from its triangle, this from the surface.
      const double gap =
          most == INFINITY ? INFINITY : rounded_up(unscaled_up(most, scale_.inverse()) + planes.errors[t]);
      facets_.gap = std::max(facets_.gap, gap);
      if (gap <= *options_.error) {
        // Most of these meet others, and finding them is cheap.
        if (allowed_[t] > turned_share * *options_.error && is_turned(t, planes)) {
          blame(HullFault::meets_itself, t, mesh_.positions[names[0]]);
          facets_.any_turned = true;
        }
        continue;
      }
      const std::size_t k = static_cast<std::size_t>(
          std::max_element(names.begin(), names.end(), [&](auto a, auto b) { return moved[a] < moved[b]; }) -
          names.begin());
      blame(whole_mesh() ? HullFault::no_position : HullFault::too_few_triangles, t,
            mesh_.positions[names[k]]);
    }
  }

  // Facets that may meet the surface, or each other. False if the budget does not allow for the pieces.
  [[nodiscard]] bool keep_off() {
    const std::size_t count = mesh_.triangles.size();
    std::vector<std::uint8_t> changed(count), asked(count), clear(count);
    for (std::size_t t = 0; t < count; ++t) {
      changed[t] = !known_.contains(scaled(facets_.positions, mesh_.triangles[t]));
      // Else there is no position, or none that is near enough.
      clear[t] = wrong_owners_[mesh_.owners[t]] == 0;
      asked[t] = clear[t] & changed[t];
    }
    std::vector<std::atomic<bool>> meets(count);
    const FacetRows rows(asked, 0,
                         [&](std::size_t t) { return scaled(facets_.positions, mesh_.triangles[t]); });
    const bool whole = pieces_.visit([&](const Box3& box) { return rows.meet(box); },
                                     [&](const PieceSet& set, const Box3& box) {
                                       rows.visit(box, [&](std::size_t t) {
                                         if (!meets[t].load(std::memory_order_relaxed) &&
                                             may_meet(set, facet(t), flat_share * scale_.apply(allowed_[t])))
                                           meets[t].store(true, std::memory_order_relaxed);
                                       });
                                     });
    if (!whole) return false;
    for (std::size_t t = 0; t < count; ++t) {
      asked[t] = meets[t];
      if (!meets[t]) continue;
      clear[t] = 0;
      blame(HullFault::meets_surface, t, mesh_.positions[mesh_.triangles[t][0]]);
    }
    if (!mark_pieces(asked)) return false;
    std::vector<Point3> points;
    points.reserve(facets_.positions.size());
    for (const Point3& p : facets_.positions) points.push_back(scale_.apply(p));
    for (const auto& [a, b, contact] :
         self_contacts(points, mesh_.triangles, max_contacts, run_.threads, monitor_, changed)) {
      blame(HullFault::meets_itself, a, mesh_.positions[mesh_.triangles[a][0]]);
      blame(HullFault::meets_itself, b, mesh_.positions[mesh_.triangles[b][0]]);
      clear[a] = clear[b] = 0;
    }
    if (problems_.empty()) return true;
    known_.assign(clear, [&](std::size_t t) { return scaled(facets_.positions, mesh_.triangles[t]); });
    return true;
  }

  // Marks what is near facets that meet the surface: they may meet another sheet, whose own facets are as near.
  [[nodiscard]] bool mark_pieces(std::span<const std::uint8_t> meeting) {
    // Balls around facets reach less far than twice their sides beyond them.
    const FacetRows rows(meeting, 2,
                         [&](std::size_t t) { return scaled(facets_.positions, mesh_.triangles[t]); });
    std::mutex mutex;
    const bool whole =
        pieces_.visit([&](const Box3& box) { return rows.meet(box); },
                      [&](const PieceSet& set, const Box3& box) {
                        std::vector<std::uint8_t> marks(set.size());
                        rows.visit(box, [&](std::size_t t) { mark_near(set, facet(t), 0, marks); });
                        std::vector<PieceName> near;
                        for (std::size_t p = 0; p < set.size(); ++p) {
                          if (marks[p] != 0) near.push_back(set.name(p));
                        }
                        const std::scoped_lock lock(mutex);
                        pieces_.mark(near);
                      });
    for (const auto& [patch, path] : pieces_.marked())
      mark({patch, {to_face(path, {0, 0}), to_face(path, {1, 0}), to_face(path, {0, 1})}}, min_share_apart);
    return whole;
  }

  // Smaller tolerances where something is wrong; false where they are as small as they get.
  bool refine() {
    const double least = tolerances_.refine();
    pieces_.refine(quadratic_share * scale_.apply(least));
    return least < INFINITY;
  }

  const LimitSurface& surface_;
  const HullOptions& options_;
  bool inner_;
  WorkMonitor monitor_;
  Run run_;  // with this monitor
  PowerOfTwo scale_;
  LocalTolerances tolerances_;
  Tessellation mesh_;
  std::vector<PatchPart> parts_;           // of its triangles
  std::vector<double> allowed_;            // their tolerances
  std::optional<TrianglesAround> around_;  // of the mesh
  NearPieces pieces_;
  std::vector<HullProblem> problems_;
  std::vector<std::uint32_t> failed_;  // the triangle of each
  std::vector<std::uint8_t> wrong_owners_;
  Faces faces_;
  Facets facets_;
  KnownFacets known_;
};

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
      for_each_part(*hulls_.inner, [&](std::span<const std::uint32_t> part) {
        const std::vector<std::uint32_t> near = near_part(*hulls_.outer, *hulls_.inner, part);
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
  // Triangles that may have a point in common with a part of another hull.
  [[nodiscard]] static std::vector<std::uint32_t> near_part(const Hull& hull, const Hull& other,
                                                            std::span<const std::uint32_t> part) {
    const auto add_to = [](Box3& box, const Hull& of, std::uint32_t t) {
      for (const std::uint32_t v : of.triangles[t]) box.add(of.positions[v]);
    };
    Box3 around;
    for (const std::uint32_t t : part) add_to(around, other, t);
    std::vector<std::uint32_t> near;
    for (std::uint32_t t = 0; t < hull.triangles.size(); ++t) {
      Box3 box;
      add_to(box, hull, t);
      if (overlap(box, around)) near.push_back(t);
    }
    return near;
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
    const Sides sides = sides_of(hull.triangles);
    if (sides.same_way) blame_triangle(HullFault::meets_itself, (*sides.same_way)[1]);
    if (hulls_.closed && sides.border) blame_triangle(HullFault::not_around, 0);
    std::vector<Point3> points;
    points.reserve(hull.positions.size());
    for (const Point3& p : hull.positions) points.push_back(model_.surface().scale().apply(p));
    for (const auto& [a, b, contact] :
         self_contacts(points, hull.triangles, max_problems, run_.threads, monitor_)) {
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

const char* name_of(HullFault fault) { return name_in(fault_names, fault); }

std::vector<HullProblem> problems_of(const Surface& surface, const Hulls& hulls, const HullOptions& options,
                                     const Run& run) {
  return Verification(surface, options, hulls, run).run();
}

Hulls hull(const Surface& handle, const HullOptions& wanted, const Run& run) {
  const LimitSurface& surface = handle.data()->bvh().surface();
  HullOptions options = wanted;
  if (!options.error) options.error = share_of_size(1e-2, surface.size());
  require_value(*options.error > 0 && std::isfinite(*options.error),
                "hull: the error must be finite and greater than 0");
  // Tolerances of triangles go down to a share of it.
  const double least = surface.scale().inverse().apply(options.single_precision ? 0x1p-20 : 0x1p-30);
  if (*options.error < least) {
    throw InputError(InputProblem::value,
                     std::string("hull: ") + (options.single_precision ? "floats" : "doubles") +
                         " allow no error below " + shortest(least) +
                         " for coordinates of this size; ask for that or more" +
                         (options.single_precision ? ", or write a format that holds doubles" : ""));
  }
  if (*options.error > surface.size() / 2) {
    throw InputError(InputProblem::value,
                     "hull: the error is more than half of the surface's size; give at most " +
                         shortest(surface.size() / 2));
  }
  require_value(options.inner || options.outer, "hull: ask for the inner hull, the outer one, or both");
  Hulls result;
  // Two balls that go through each other a little have an inner hull, and no outer one; turned inside out the other way round.
  const int asked_from = options.inner && options.outer ? 0 : rounds_alone;
  OwnContacts contacts(handle, surface, run);
  for (const bool inner : {true, false}) {
    if (!(inner ? options.inner : options.outer)) continue;
    OneHull side(surface, options, inner, run);
    const std::vector<HullProblem> problems = side.run(contacts, asked_from);
    result.problems.insert(result.problems.end(), problems.begin(), problems.end());
    result.closed = !side.has_border_edges();
    (inner ? result.inner : result.outer) = side.take();
    monitor_of(run).report(inner ? 0.3 : 0.6);
    // Nothing is proved of the other one then, and one that fails takes most of the time.
    if (!problems.empty()) break;
  }
  system_files::return_free_memory();
  if (result.problems.empty()) result.problems = problems_of(handle, result, options, run);
  const bool too_few =
      std::any_of(result.problems.begin(), result.problems.end(),
                  [](const HullProblem& problem) { return problem.fault == HullFault::too_few_triangles; });
  result.outcome = outcome_of(result.problems.empty(), too_few);
  keep_some(result.problems);
  monitor_of(run).report(1);
  return result;
}

}  // namespace snug
