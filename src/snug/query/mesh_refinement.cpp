#include <snug/query/mesh_refinement.h>

#include <cmath>
#include <utility>

#include <snug/bounds/enclosure.h>
#include <snug/geometry/rounding.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/unscale.h>
#include <support/contract.h>
#include <support/error.h>
#include <support/parallel.h>
#include <support/run.h>
#include <support/system_files.h>

namespace snug {
namespace {

// The error of a piece's quadratic that is no hindrance, as a part of the tolerance.
constexpr double tolerable_share = 0.25;
// One of less need not be known better.
constexpr double sufficient_share = 0x1p-4;
constexpr unsigned deepest_level = 40;
constexpr double shortest_side = 0x1p-46;  // in parameters
// Whatever the budget is: edges, also those that were split, have 31 bits.
constexpr std::uint64_t triangle_limit = std::uint64_t{1} << 29;

// Triangles that are examined at once: each may take room for a quadratic.
constexpr std::size_t batch_size = 8192;

// Results of so many triangles have tens of megabytes.
constexpr std::size_t large_count = 100'000;

constexpr std::array<std::uint8_t, 8> number_of_bits{0, 1, 1, 2, 1, 2, 2, 3};

// Of a whole piece, from its corners.
PiecePath path_of(const std::array<TriangleParameter, 6>& at) {
  const double along = at[1].u - at[0].u;
  const bool turned = along < 0;
  const int level = -std::ilogb(along);
  const auto place = [&](double parameter) {
    return static_cast<std::uint64_t>(std::ldexp(parameter, level)) - (turned ? 1 : 0);
  };
  return {static_cast<unsigned>(level), turned, place(at[0].u), place(at[0].v)};
}

}  // namespace

// Limit points and patches, for one thread; what comes together should be asked for together.
class MeshRefinement::Worker {
 public:
  explicit Worker(const LimitSurface& surface) : surface_(&surface) {}

  // The patch of a piece.
  const Patch& patch(Index root, const PiecePath& path) {
    if (root != root_ || chain_.empty()) {
      root_ = root;
      if (chain_.empty()) chain_.emplace_back();
      surface_->patch(PatchId(root), chain_[0]);
      length_ = 0;
    }
    unsigned level = 0;
    while (level < std::min(length_, path.level()) && path.digit(level) == digits_[level]) ++level;
    for (; level < path.level(); ++level) {
      if (chain_.size() <= level + 1) chain_.emplace_back();
      snug::split(chain_[level], path.digit(level), chain_[level + 1]);
      digits_[level] = path.digit(level);
      length_ = level + 1;
    }
    return chain_[path.level()];
  }

  // The evaluator of a patch, or of the quad that it is half of.
  LimitEvaluator& evaluator(Index patch) {
    const Index first = surface_->rules().triangular() ? patch : patch & ~Index{1};
    if (first != first_) {
      surface_->patch(PatchId(first), quad_);
      evaluator_.reset(quad_);
      first_ = first;
    }
    return evaluator_;
  }
  [[nodiscard]] bool same_quad(Index a, Index b) const {
    return surface_->rules().triangular() ? a == b : (a | 1) == (b | 1);
  }

  BoundingPoints hull;
  std::array<Place, 64> at;
  std::array<BoundedPoint, 64> points;

 private:
  const LimitSurface* surface_;
  Index root_ = UINT32_MAX, first_ = UINT32_MAX;
  std::vector<Patch> chain_;  // the root patch and pieces of pieces down to the last one
  std::array<unsigned, deepest_level + 1> digits_{};
  unsigned length_ = 0;
  Patch quad_;
  LimitEvaluator evaluator_;
};

void MeshRefinement::place_roots() {
  const std::vector<PatchId>& roots = complex_.root_patches();
  constexpr std::array<TriangleParameter, 3> corners{{{0, 0}, {1, 0}, {0, 1}}};
  std::vector<OnPatch> places(complex_.vertex_count());
  facets_.resize(roots.size());
  for (std::size_t t = 0; t < roots.size(); ++t) {
    facets_[t].patch = roots[t].value();
    for (std::size_t k = 0; k < 3; ++k) {
      at_.push_back(corners[k]);
      OnPatch& place = places[complex_.corner(t, k)];
      if (place.patch == UINT32_MAX) place = {roots[t].value(), corners[k]};
    }
  }
  evaluate(0, places);
}

// The number that is written, and its error.
double MeshRefinement::finish(Index v, const BoundedPoint& point) {
  Point3 written = back().apply(point.position);
  if (options_.single_precision) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto rounded = static_cast<float>(written[a]);
      if (!std::isfinite(rounded)) {
        throw InputError(InputProblem::unrepresentable,
                         "tessellate: a coordinate does not fit a float; scale the mesh down, or write a "
                         "format that holds doubles");
      }
      written[a] = static_cast<double>(rounded);
    }
  }
  written_[v] = require_representable(written);
  const Vector3 moved = surface_.scale().apply(written) - point.position;
  return enlarged(point.error + max_abs(moved));
}

// Vertices from `first` on; those without a patch have no triangles.
void MeshRefinement::evaluate(std::size_t first, std::span<const OnPatch> places) {
  std::atomic<double> largest{vertex_error_};
  parallel_for_with(
      places.size(), run_.threads, [&] { return Worker(surface_); },
      [&](Worker& worker, std::size_t begin, std::size_t end) {
        monitor_of(run_).checkpoint();
        double most = 0;
        for (std::size_t i = begin; i < end;) {
          const Index patch = places[i].patch;
          if (patch == UINT32_MAX) {
            ++i;
            continue;
          }
          std::size_t count = 0;
          while (i + count < end && count < worker.at.size() && places[i + count].patch != UINT32_MAX &&
                 worker.same_quad(patch, places[i + count].patch)) {
            const OnPatch& place = places[i + count];
            worker.at[count++] = place_of(surface_, PatchId(place.patch), place.at);
          }
          worker.evaluator(patch).points({worker.at.data(), count}, {worker.points.data(), count});
          for (std::size_t k = 0; k < count; ++k) {
            most = std::max(most, finish(static_cast<Index>(first + i + k), worker.points[k]));
          }
          i += count;
        }
        for (double known = largest; known < most && !largest.compare_exchange_weak(known, most);) {
        }
      });
  vertex_error_ = largest;
}

MeshRefinement::FacetPlaces MeshRefinement::places(Index t) const {
  FacetPlaces at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = at_[complex_.sites(t)[k]];
  for (std::size_t k = 0; k < 3; ++k) {
    const TriangleParameter a = at[k], b = at[(k + 1) % 3];
    at[3 + k] = {0.5 * (a.u + b.u), 0.5 * (a.v + b.v)};
  }
  return at;
}

FlatTriangle MeshRefinement::flat(Index t) const {
  FlatTriangle triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    const Index site = complex_.sites(t)[k];
    triangle.corner[k] = scaled(complex_.vertex_at(site));
    triangle.at[k] = at_[site];
  }
  return triangle;
}

void MeshRefinement::mark_sides(Index t) {
  for (std::size_t k = 0; k < 3; ++k) complex_.mark(complex_.edge_of(t, k));
}

// Of a triangle as near to the eye as a ball around it; at the eye itself, what the arithmetic can do.
double MeshRefinement::seen_tolerance(Index t) const {
  const Triangle triangle = flat(t).corner;
  const Point3 middle = triangle[0] + 0.5 * (triangle[1] - triangle[0]);
  double radius = 0;
  for (const Point3& p : triangle) radius = std::max(radius, distance(p, middle));
  const double nearest = (distance(middle, limits_.eye) - radius) * (1 - 0x1p-40) - 0x1p-45;
  return std::max(limits_.slope * (1 - 0x1p-40) * nearest, min_tolerance);
}

// The longest side of the boxes of its interval triangle.
double MeshRefinement::thickness(const Patch& patch, const BoundingPoints& hull) {
  const IntervalTriangle boxes = interval_simplex<3>(hull, limit_corners(patch));
  double longest = 0;
  for (const Box3& box : boxes.corner) longest = std::max(longest, longest_side(box));
  return longest;
}

// Finds the quadratic of a piece that is still one triangle, for which there is room; where it is coarse, the triangle's error.
void MeshRefinement::learn(Worker& worker, Index t, Index room) {
  Facet& facet = facets_[t];
  const PiecePath path = path_of(places(t));
  const Patch& patch = worker.patch(facet.patch, path);
  BoundsCache& library = surface_.library();
  if (limits_.max_thickness < INFINITY) {
    bounding_points(library, patch, worker.hull);
  } else if (patch.kind->cacheable()) {
    bounding_points(library.rows(*patch.kind), patch, worker.hull);
  }
  const double most = tolerable_share * tolerance(t);
  const bool whole = limits_.whole_errors || !(most < INFINITY) || path.level() >= deepest_level;
  const ErrorUse use =
      whole ? ErrorUse{} : ErrorUse{.sufficient = sufficient_share * tolerance(t), .useless = most};
  const QuadraticTriangle near = quadratic_triangle(library, patch, worker.hull, use);
  const bool thick =
      limits_.max_thickness < INFINITY && thickness(patch, worker.hull) > limits_.max_thickness;
  if (!thick && near.error <= most && near.error < INFINITY) {
    facet.quadratic = room;
    quadratics_[room] = PieceQuadratic(near, path);
    return;
  }
  facet.quadratic = thick ? Facet::thick : Facet::coarse;
  const FlatTriangle triangle = flat(t);
  double error = near.error < INFINITY ? PieceQuadratic(near, path).flatness(triangle).error : INFINITY;
  // Where the quadratic itself is too far away there is nothing to be gained.
  if (error > tolerance(t) && !(error - 2 * near.error > tolerance(t))) {
    const ErrorUse use_here = whole ? ErrorUse{} : ErrorUse{.useless = tolerance(t)};
    error = std::min(error, distance_to_triangle(library, patch, worker.hull, triangle.corner, use_here));
  }
  facet.bound = float_up(error);
}

// Of up to eight triangles.
void MeshRefinement::prove(std::span<const Index> triangles, bool mark) {
  std::array<Index, PieceQuadratic::max_lanes> fine{};
  std::array<const PieceQuadratic*, PieceQuadratic::max_lanes> pieces{};
  std::array<FlatTriangle, PieceQuadratic::max_lanes> flats;
  std::array<Flatness, PieceQuadratic::max_lanes> found{};
  std::size_t count = 0;
  for (const Index t : triangles) {
    if (facets_[t].is_coarse()) {
      if (mark) mark_coarse(t);
      continue;
    }
    fine[count] = t;
    pieces[count] = &quadratics_[facets_[t].quadratic];
    flats[count++] = flat(t);
  }
  if (count == 0) return;
  PieceQuadratic::flatness({pieces.data(), count}, {flats.data(), count}, {found.data(), count});
  for (std::size_t i = 0; i < count; ++i) {
    Facet& facet = facets_[fine[i]];
    facet.bound = float_up(found[i].error);
    if (mark && facet.error() > tolerance(fine[i])) mark_bent(fine[i], found[i]);
  }
}

void MeshRefinement::mark_coarse(Index t) {
  const Facet& facet = facets_[t];
  if (facet.quadratic != Facet::thick && !(facet.error() > tolerance(t))) return;
  if (path_of(places(t)).level() >= deepest_level) return stuck_.store(true, std::memory_order_relaxed);
  mark_sides(t);
}

// Sides that are bent beyond what is left of the tolerance, or the most bent one.
void MeshRefinement::mark_bent(Index t, const Flatness& flatness) {
  const PieceQuadratic& quadratic = quadratics_[facets_[t].quadratic];
  const double taken = quadratic.error() + flatness.corner_gap,
               left = std::max(tolerance(t) - taken, tolerance(t) / 4);
  const FacetPlaces at = places(t);
  std::array<double, 3> bow_sq;
  for (std::size_t k = 0; k < 3; ++k) bow_sq[k] = length_sq(quadratic.bow(at[k], at[(k + 1) % 3]));
  const auto most = static_cast<std::size_t>(std::max_element(bow_sq.begin(), bow_sq.end()) - bow_sq.begin());
  const TriangleParameter a = at[most], b = at[(most + 1) % 3];
  if (std::max(std::fabs(a.u - b.u), std::fabs(a.v - b.v)) <= shortest_side) {
    return stuck_.store(true, std::memory_order_relaxed);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (k == most || bow_sq[k] > left * left) complex_.mark(complex_.edge_of(t, k));
  }
}

void MeshRefinement::mark_long(Worker& worker, Index t) {
  if (limits_.max_edge < INFINITY) {
    const std::array<Point3, 3> corner = flat(t).corner;
    for (std::size_t k = 0; k < 3; ++k) {
      if (enlarged(distance(corner[k], corner[(k + 1) % 3])) > limits_.max_edge) {
        complex_.mark(complex_.edge_of(t, k));
      }
    }
  }
  if (limits_.min_cosine >= -1) mark_turning(worker, t);
}

void MeshRefinement::mark_turning(Worker& worker, Index t) {
  const Index patch = facets_[t].patch;
  const FacetPlaces at = places(t);
  std::array<std::optional<Vector3>, 3> normal;
  for (std::size_t k = 0; k < 3; ++k) {
    normal[k] = worker.evaluator(patch).frame(place_of(surface_, PatchId(patch), at[k])).normal;
  }
  const std::array<Point3, 3> corner = flat(t).corner;
  bool turns = false;
  std::size_t longest = 0;
  std::array<double, 3> side;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    turns = turns || (normal[k] && normal[next] && dot(*normal[k], *normal[next]) < limits_.min_cosine);
    side[k] = distance(corner[k], corner[next]);
    if (side[k] > side[longest]) longest = k;
  }
  // Not the sides that turn: slivers along a fold would be split for ever.
  if (turns && side[longest] > limits_.shortest_turn) complex_.mark(complex_.edge_of(t, longest));
}

void MeshRefinement::examine(std::span<const Index> triangles, bool mark) {
  for (std::size_t begin = 0; begin < triangles.size(); begin += batch_size) {
    examine_batch(triangles.subspan(begin, std::min(batch_size, triangles.size() - begin)), mark);
  }
  refuse_if_stuck();
}

void MeshRefinement::examine_batch(std::span<const Index> triangles, bool mark) {
  std::vector<Index> rooms(triangles.size(), Facet::unknown);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (facets_[triangles[i]].quadratic == Facet::unknown) rooms[i] = quadratics_.add();
  }
  parallel_for_with(
      triangles.size(), run_.threads, [&] { return Worker(surface_); },
      [&](Worker& worker, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end;) {
          if ((i - begin) % 256 == 0) monitor_of(run_).checkpoint();
          const std::size_t next = std::min(end, i + PieceQuadratic::max_lanes);
          const std::span<const Index> some = triangles.subspan(i, next - i);
          for (; i < next; ++i) {
            if (rooms[i] != Facet::unknown) learn(worker, triangles[i], rooms[i]);
          }
          prove(some, mark);
          for (const Index t : some) {
            if (mark) mark_long(worker, t);
          }
        }
      });
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!facets_[triangles[i]].is_coarse()) continue;
    coarse_.push_back(triangles[i]);
    if (rooms[i] != Facet::unknown) quadratics_.drop(rooms[i]);
  }
}

void MeshRefinement::mark_rest_of_coarse() {
  for (bool more = true; more;) {
    more = false;
    for (const Index t : coarse_) {
      const unsigned marks = complex_.marks(t);
      if (marks == 0 || marks == 7) continue;
      mark_sides(t);
      more = true;
    }
  }
}

std::uint64_t MeshRefinement::count_after() const {
  std::uint64_t count = triangle_count();
  for (Index t = 0; t < triangle_count(); ++t) count += number_of_bits[complex_.marks(t)];
  return count;
}

// Which way to cut: lines inside that are less bent, and where none is bent shorter ones.
std::size_t MeshRefinement::choose(Index t, unsigned marks) const {
  const Facet& facet = facets_[t];
  const std::size_t choices = split_count(marks);
  if (facet.is_coarse() || choices == 1) return 0;
  const FacetPlaces at = places(t);
  std::array<Point3, 6> point;
  for (std::size_t k = 0; k < 3; ++k) {
    point[k] = scaled(complex_.corner(t, k));
    if ((marks >> k) % 2 == 1) point[3 + k] = scaled(complex_.middle(t, k));
  }
  const double slight = limits_.tolerance < INFINITY ? limits_.tolerance / 4 : 0;
  const auto bend = [&](std::size_t p, std::size_t q) {
    return std::max(slight, length(quadratics_[facet.quadratic].bow(at[p], at[q])));
  };
  const auto size = [&](std::size_t p, std::size_t q) { return length_sq(point[p] - point[q]); };
  if (choices == 2) {
    const std::size_t k = marks == 3   ? 0
                          : marks == 6 ? 1
                                       : 2,
                      a = 3 + k, b = 3 + (k + 1) % 3, behind = (k + 2) % 3;
    const double first = bend(a, behind), second = bend(k, b);
    return first < second || (first == second && size(a, behind) <= size(k, b)) ? 0 : 1;
  }
  std::size_t best = 0;
  double least = 0.5;
  for (std::size_t k = 0; k < 3; ++k) {
    const double ratio = bend(k, 3 + (k + 1) % 3) / bend(3 + k, 3 + (k + 2) % 3);
    if (ratio < least) {
      least = ratio;
      best = k + 1;
    }
  }
  return best;
}

void MeshRefinement::carry_out(const Cut& cut) {
  const unsigned marks = complex_.marks(cut.triangle);
  const Facet whole = facets_[cut.triangle];
  SNUG_EXPECT(marks == 7 || !whole.is_coarse());
  const TriangleSplit shape = split_of(marks, choose(cut.triangle, marks));
  complex_.cut(cut, shape);
  for (unsigned i = 0; i < shape.count; ++i) {
    Facet& part = facets_[i == 0 ? cut.triangle : cut.first_new + i - 1];
    part = {whole.patch, whole.is_coarse() ? Facet::unknown : whole.quadratic};
  }
}

// Splits what is marked; the parts, whose sides have no marks.
void MeshRefinement::split(std::vector<Index>& parts) {
  const std::size_t old = written_.size();
  std::vector<OnPatch> places;
  const std::vector<Cut> cuts = complex_.split_edges([&](std::size_t t, std::size_t k) {
    at_.push_back(this->places(static_cast<Index>(t))[3 + k]);
    if (old + places.size() < complex_.vertex_count())
      places.push_back({facets_[t].patch, at_[at_.size() - 1]});
  });
  written_.resize(complex_.vertex_count());
  facets_.resize(triangle_count());
  evaluate(old, places);
  parallel_for(cuts.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) carry_out(cuts[i]);
  });
  parts.clear();
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const std::size_t end = i + 1 < cuts.size() ? cuts[i + 1].first_new : triangle_count();
    parts.push_back(cuts[i].triangle);
    for (std::size_t t = cuts[i].first_new; t < end; ++t) parts.push_back(static_cast<Index>(t));
  }
  complex_.clear_marks();
  std::erase_if(coarse_, [&](Index t) { return !facets_[t].is_coarse(); });
}

bool MeshRefinement::run(std::uint64_t most) {
  place_roots();
  std::vector<Index> active(triangle_count());
  for (Index t = 0; t < active.size(); ++t) active[t] = t;
  // First what makes the triangles a complex, whatever the limits are.
  while (true) {
    examine(active, false);
    complex_.mark_what_is_not_simple();
    if (count_after() == triangle_count()) break;
    mark_rest_of_coarse();
    split(active);
  }
  active.resize(triangle_count());
  for (Index t = 0; t < active.size(); ++t) active[t] = t;
  coarse_.clear();
  double done = 0;
  while (true) {
    examine(active, true);
    mark_rest_of_coarse();
    const std::uint64_t next = count_after();
    if (next == triangle_count()) return true;
    if (next > std::min(most, triangle_limit)) return false;
    done = std::max(done, 1 - static_cast<double>(active.size()) / static_cast<double>(next));
    monitor_of(run_).report(done);
    split(active);
  }
}

void MeshRefinement::find_errors() {
  limits_.whole_errors = true;
  std::vector<Index> unknown;
  for (Index t = 0; t < triangle_count(); ++t) {
    if (facets_[t].bound < INFINITY || !facets_[t].is_coarse()) continue;
    facets_[t].quadratic = Facet::unknown;
    unknown.push_back(t);
  }
  examine(unknown, false);
}

double MeshRefinement::error_bound() const {
  double largest = 0;
  for (std::size_t t = 0; t < facets_.size(); ++t) largest = std::max(largest, facets_[t].error());
  return unscaled_up(largest, back());
}

void MeshRefinement::refuse_if_stuck() const {
  if (!stuck_.load()) return;
  double largest = 0;
  for (Index t = 0; t < facets_.size(); ++t) {
    const Facet& facet = facets_[t];
    const unsigned level =
        facet.is_coarse() ? path_of(places(t)).level() : quadratics_[facet.quadratic].level();
    if (level >= deepest_level) largest = std::max(largest, facet.error());
  }
  char text[160];
  std::snprintf(
      text, sizeof text, "tessellate: rounding leaves more than the error on this mesh; take %.3g or more",
      4 * unscaled_up(std::max(largest, std::min(limits_.tolerance, limits_.max_thickness)), back()));
  refuse_value(text);
}

void MeshRefinement::add_normals(Tessellation& result, const std::vector<Index>& patches) const {
  result.normals.resize(patches.size());
  parallel_for_with(
      patches.size(), run_.threads, [&] { return Worker(surface_); },
      [&](Worker& worker, std::size_t begin, std::size_t end) {
        monitor_of(run_).checkpoint();
        for (std::size_t i = begin; i < end; ++i) {
          const LimitFrame frame = worker.evaluator(patches[i]).frame(result.parameters[i]);
          result.normals[i] = frame.normal.value_or(Vector3{});
        }
      });
}

// Memory that is needed no more is given back before the result is made: both are largest now.
Tessellation MeshRefinement::take_result(LocalTessellation* local) {
  Tessellation result;
  result.error_bound = error_bound();
  result.position_error = unscaled_up(vertex_error_, back());
  const std::size_t count = triangle_count();
  quadratics_ = {};
  Blocks<std::array<Index, 3>> sites = complex_.take_sites();
  const bool large = count >= large_count;
  if (large) system_files::return_free_memory();
  // Patch by patch.
  std::vector<std::size_t> begins(surface_.patch_count() + 1, 0);
  for (std::size_t t = 0; t < count; ++t) ++begins[facets_[t].patch + 1];
  for (std::size_t p = 1; p < begins.size(); ++p) begins[p] += begins[p - 1];
  std::vector<Index> patch_of(complex_.site_count());
  result.triangles.resize(count);
  result.owners.resize(count);
  if (local != nullptr) {
    local->errors.resize(count);
    local->parts.resize(count);
  }
  if (options_.corners) result.corners.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    const Facet& facet = facets_[t];
    const PatchId patch(facet.patch);
    const std::size_t place = begins[patch.value()]++;
    result.triangles[place] = sites[t];
    result.owners[place] = surface_.place(patch).owner;
    if (local != nullptr) {
      local->errors[place] = unscaled_up(facet.error(), back());
      local->parts[place] = {patch, {at_[sites[t][0]], at_[sites[t][1]], at_[sites[t][2]]}};
    }
    for (std::size_t k = 0; k < 3; ++k) {
      patch_of[sites[t][k]] = patch.value();
      if (options_.corners) result.corners[place][k] = place_of(surface_, patch, at_[sites[t][k]]);
    }
  }
  facets_ = {};
  sites = {};
  if (large) system_files::return_free_memory();
  // Vertices in the order in which triangles name them, with the parameters of their first sites.
  std::vector<Index> first(complex_.vertex_count(), UINT32_MAX), number(first), patches;
  std::size_t used = 0;
  for (Index site = 0; site < complex_.site_count(); ++site) {
    Index& known = first[complex_.vertex_at(site)];
    if (known != UINT32_MAX) continue;
    known = site;
    ++used;
  }
  result.positions.reserve(used);
  result.parameters.reserve(used);
  if (options_.normals) patches.reserve(used);
  for (std::array<Index, 3>& triangle : result.triangles) {
    for (Index& site : triangle) {
      const Index v = complex_.vertex_at(site);
      if (number[v] == UINT32_MAX) {
        number[v] = static_cast<Index>(result.positions.size());
        const Index patch = patch_of[first[v]];
        result.positions.push_back(written_[v]);
        result.parameters.push_back(place_of(surface_, PatchId(patch), at_[first[v]]));
        if (options_.normals) patches.push_back(patch);
      }
      site = number[v];
    }
  }
  if (options_.normals) add_normals(result, patches);
  return result;
}

}  // namespace snug
