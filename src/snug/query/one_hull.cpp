#include <snug/query/one_hull.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/query/hull_vertices.h>
#include <snug/query/local_tolerances.h>
#include <snug/query/near_pieces.h>
#include <snug/query/tessellate.h>
#include <snug/search/facet_rows.h>
#include <snug/search/feet.h>
#include <snug/search/piece.h>
#include <snug/search/precision.h>
#include <snug/search/self_contact.h>
#include <snug/search/triangle_sides.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/parallel.h>
#include <support/run.h>
#include <support/system_files.h>

namespace snug {
namespace {

using Names = std::array<std::uint32_t, 3>;

// Of the tolerance: that of the triangles which are moved, at first; below which it is no longer made smaller,
// where a vertex has no position, and where facets meet something.
constexpr double first_share = 0.4, min_share = 0x1p-6, min_share_apart = 0x1p-8;
// And down to which it is made smaller at once where facets turn over.
constexpr double turned_share = 0x1p-3;
// Of the tolerance of a triangle: the error of the quadratics that its facet is to be kept off, and how far Bezier points of its parts
// may stick out of them.
constexpr double quadratic_share = 0x1p-4, flat_share = 0x1p-5;
constexpr std::size_t max_contacts = 1'000'000;
constexpr int max_rounds = 40;
// Rounds in which facets with the least tolerance fail before a hull is given up, and the share of the error of those beside a place
// where the surface touches itself.
constexpr int max_rounds_at_least = 3;
constexpr double touching_share = 0x1p-5;
// How much larger than that of a facet which fails a tolerance beside it may be.
constexpr double max_growth = 2;
// Down to which share of the error tolerances are made smaller for whole owners.
constexpr double whole_share = 0x1p-4;

// Is there a border? Refuses what has no two sides.
bool has_border(const Tessellation& mesh) {
  const TriangleSides sides = sides_of(mesh.triangles);
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

class HullMaker {
 public:
  HullMaker(const LimitSurface& surface, const HullOptions& options, bool inner, const Run& run)
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

  // Moves triangles until nothing is wrong, or nothing can be done about it.
  OneHull run(OwnContacts& contacts, int asked_from) {
    for (int round = 0;; ++round) {
      end_round();
      LocalTessellation made = tessellate(surface_, tolerances_, {.normals = false}, run_);
      begin_round(made);
      if (round == 0) {
        faces_.border = has_border(mesh_);
        faces_.inward = !faces_.border && is_inward(mesh_, scale_);
      }
      move_vertices(made.errors);
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
    // Oriented outward.
    for (Names& t : mesh_.triangles) {
      if (faces_.inward) std::swap(t[1], t[2]);
    }
    return {{std::move(facets_.positions), std::move(mesh_.triangles), std::move(mesh_.owners), facets_.gap},
            !faces_.border,
            std::move(problems_)};
  }

 private:
  // Did the budget allow for all triangles?
  [[nodiscard]] bool whole_mesh() const { return mesh_.outcome == Outcome::complete; }
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
  void move_vertices(std::span<const double> errors) {
    HullVertices vertices({.mesh = mesh_,
                           .around = *around_,
                           .scale = scale_,
                           .sign = inner_ != faces_.inward ? -1.0 : 1.0,
                           .errors = errors,
                           .allowed = allowed_},
                          options_, run_);
    blame_moved(vertices, errors);
    facets_.positions = vertices.take_positions();
  }
  // Facets that are too far from the surface, or turned.
  void blame_moved(const HullVertices& vertices, std::span<const double> errors) {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Names& names = mesh_.triangles[t];
      const auto moved = [&](std::uint32_t v) { return vertices.moved(v); };
      const double most = std::max({moved(names[0]), moved(names[1]), moved(names[2])});
      // Parameter by parameter: the facet from its triangle, this from the surface.
      const double gap =
          most == INFINITY ? INFINITY : rounded_up(unscaled_up(most, scale_.inverse()) + errors[t]);
      facets_.gap = std::max(facets_.gap, gap);
      if (gap <= *options_.error) {
        // Most of these meet others, and finding them is cheap.
        if (allowed_[t] > turned_share * *options_.error && vertices.is_turned(t)) {
          blame(HullFault::meets_itself, t, mesh_.positions[names[0]]);
          facets_.any_turned = true;
        }
        continue;
      }
      const std::size_t k = static_cast<std::size_t>(
          std::max_element(names.begin(), names.end(), [&](auto a, auto b) { return moved(a) < moved(b); }) -
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

}  // namespace

OneHull make_hull(const LimitSurface& surface, const HullOptions& options, bool inner, OwnContacts& contacts,
                  int asked_from, const Run& run) {
  return HullMaker(surface, options, inner, run).run(contacts, asked_from);
}

}  // namespace snug
