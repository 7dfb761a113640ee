#include <snug/query/tessellate.h>
#include <snug/search/surface_data.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <deque>
#include <string>
#include <utility>

#include <snug/bounds/enclosure.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/limit_evaluator.h>
#include <snug/query/piece_quadratic.h>
#include <snug/query/triangle_complex.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/unscale.h>
#include <support/contract.h>
#include <support/error.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {
namespace {

using Index = TriangleComplex::Index;

// Tolerances below these, for coordinates from 1 to 2, are refused: rounding would take too much of them.
constexpr double min_tolerance = 0x1p-41, min_single_tolerance = 0x1p-21;
// The error of a piece's quadratic that is no hindrance, as a part of the tolerance.
constexpr double tolerable_share = 0.25;
// One of less need not be known better.
constexpr double sufficient_share = 0x1p-4;
constexpr unsigned deepest_level = 40;
constexpr double shortest_side = 0x1p-46;  // in parameters
// Whatever the budget is: edges, also those that were split, have 31 bits.
constexpr std::uint64_t triangle_limit = std::uint64_t{1} << 29;

constexpr std::array<std::uint8_t, 8> number_of_bits{0, 1, 1, 2, 1, 2, 2, 3};

struct Vertex {
  Point3 written;  // in mesh units
  TriangleParameter at;
  double error = 0;          // a coordinate, in scaled units
  Index patch = UINT32_MAX;  // that it lies on
};

// A piece of a root patch by splits in four. Where its quadratic is `coarse` only the triangle of the whole
// piece is proved, and it is split in four or not at all.
struct Tile {
  PiecePath path;
  Index patch;
  Index quadratic = UINT32_MAX;  // unless coarse, once it is known
  bool known = false, coarse = false, thick = false;
};

// The quadratics of pieces that have one, by number.
class Quadratics {
 public:
  [[nodiscard]] PieceQuadratic& operator[](Index i) { return all_[i]; }
  [[nodiscard]] const PieceQuadratic& operator[](Index i) const { return all_[i]; }
  // Room for one.
  [[nodiscard]] Index add() {
    if (free_.empty()) {
      all_.emplace_back();
      return static_cast<Index>(all_.size() - 1);
    }
    const Index i = free_.back();
    free_.pop_back();
    return i;
  }
  void drop(Index i) { free_.push_back(i); }

 private:
  std::deque<PieceQuadratic> all_;
  std::vector<Index> free_;
};

// A triangle of the mesh, on a piece.
struct Facet {
  std::array<TriangleParameter, 3> at;
  Index piece;
  double error = INFINITY;  // upper bound of its distance from the surface, either way

  // Corner k, or the middle of the side that begins at corner k - 3.
  [[nodiscard]] TriangleParameter point(std::size_t k) const {
    if (k < 3) return at[k];
    const TriangleParameter a = at[k - 3], b = at[(k - 2) % 3];
    return {0.5 * (a.u + b.u), 0.5 * (a.v + b.v)};
  }
};

// The limits of a run, in scaled units.
struct Limits {
  double tolerance = INFINITY, max_edge = INFINITY, max_thickness = INFINITY;
  std::vector<double> of_owner{};  // tolerances of owners instead of that; or none
  double min_cosine = -2;          // of normals; -2 for none
  Point3 eye;
  double slope = INFINITY;   // of a triangle's tolerance over its distance from the eye
  double shortest_turn = 0;  // triangles without a longer side are not split for their normals
};

// Limit points and patches, for one thread; what comes together should be asked for together.
class Worker {
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
      split(chain_[level], path.digit(level), chain_[level + 1]);
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

class MeshRefinement {
 public:
  MeshRefinement(const LimitSurface& surface, const TessellateOptions& options, const Limits& limits,
                 const Run& run)
      : surface_(surface),
        options_(options),
        limits_(limits),
        run_(run),
        complex_(surface),
        vertices_(complex_.vertex_count()) {}

  // Refines until all limits hold; false if that would take more than `most` triangles.
  bool run(std::uint64_t most);
  // After a run that was ended: of triangles whose errors are not known but for being too large.
  void find_errors();
  [[nodiscard]] std::size_t triangle_count() const { return complex_.triangle_count(); }
  // Upper bound over all triangles, in mesh units.
  [[nodiscard]] double error_bound() const;
  // Also the errors of triangles, in mesh units, if asked for. Nothing may be asked afterwards.
  [[nodiscard]] Tessellation take_result(std::vector<double>* errors = nullptr);

 private:
  struct Cut {
    Index triangle, first_new, first_edge;
    Index first_piece;  // the children of a coarse one
  };

  void place_roots();
  void evaluate(std::size_t begin, std::size_t end);
  void examine(const std::vector<Index>& triangles, bool mark);
  void examine(Worker& worker, Index t, bool mark);
  void make_room_for_quadratics(const std::vector<Index>& triangles);
  void prove(Worker& worker, Index t, bool mark);
  [[nodiscard]] double seen_tolerance(Index t) const;
  [[nodiscard]] static double thickness(const Patch& patch, const BoundingPoints& hull);
  void learn(Worker& worker, Index t);
  void mark_bent(Index t, const Flatness& flatness);
  void mark_long(Worker& worker, Index t);
  void mark_turning(Worker& worker, Index t);
  void mark_sides(Index t);
  void mark_rest_of_coarse();
  [[nodiscard]] std::uint64_t count_after() const;
  void split(std::vector<Index>& parts);
  std::vector<Cut> plan_cuts();
  void carry_out(const Cut& cut);
  [[nodiscard]] std::size_t choose(Index t, unsigned marks) const;
  [[nodiscard]] FlatTriangle flat(Index t) const;
  [[nodiscard]] const Tile& piece_of(std::size_t t) const { return pieces_[facets_[t].piece]; }
  [[nodiscard]] Tile& piece_of(std::size_t t) { return pieces_[facets_[t].piece]; }
  [[nodiscard]] double tolerance(Index t) const {
    if (limits_.slope < INFINITY) return std::min(limits_.tolerance, seen_tolerance(t));
    if (limits_.of_owner.empty()) return limits_.tolerance;
    return limits_.of_owner[surface_.place(PatchId(piece_of(t).patch)).owner];
  }
  [[nodiscard]] PowerOfTwo back() const { return surface_.scale().inverse(); }
  [[nodiscard]] Point3 scaled(Index v) const { return surface_.scale().apply(vertices_[v].written); }
  void finish(Vertex& vertex, const BoundedPoint& point) const;
  void refuse_if_stuck() const;
  void add_normals(Tessellation& result, const std::vector<Index>& order) const;

  const LimitSurface& surface_;
  const TessellateOptions& options_;
  Limits limits_;
  Run run_;
  TriangleComplex complex_;
  std::vector<Vertex> vertices_;
  std::deque<Facet> facets_;  // without room to spare, which would be most of the memory
  std::vector<Tile> pieces_;
  Quadratics quadratics_;
  std::vector<Index> coarse_;  // triangles of whole pieces that are split in four or not at all
  bool errors_whole_ = false;  // also those above the tolerance
  std::atomic<bool> stuck_{false};
};

void MeshRefinement::place_roots() {
  const std::vector<PatchId>& roots = complex_.root_patches();
  constexpr std::array<TriangleParameter, 3> corners{{{0, 0}, {1, 0}, {0, 1}}};
  pieces_.reserve(roots.size());
  for (std::size_t t = 0; t < roots.size(); ++t) {
    facets_.push_back({corners, static_cast<Index>(t)});
    pieces_.push_back({{}, roots[t].value()});
    for (std::size_t k = 0; k < 3; ++k) {
      Vertex& vertex = vertices_[complex_.corners(t)[k]];
      if (vertex.patch == UINT32_MAX) vertex = {{}, corners[k], 0, roots[t].value()};
    }
  }
  evaluate(0, vertices_.size());
}

// The number that is written, and its error.
void MeshRefinement::finish(Vertex& vertex, const BoundedPoint& point) const {
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
  vertex.written = require_representable(written);
  const Vector3 moved = surface_.scale().apply(written) - point.position;
  vertex.error = enlarged(point.error + max_abs(moved));
}

void MeshRefinement::evaluate(std::size_t begin, std::size_t end) {
  parallel_for_with(
      end - begin, run_.threads, [&] { return Worker(surface_); },
      [&](Worker& worker, std::size_t from, std::size_t to) {
        monitor_of(run_).checkpoint();
        for (std::size_t i = begin + from; i < begin + to;) {
          if (vertices_[i].patch == UINT32_MAX) {
            ++i;
            continue;
          }
          const Index patch = vertices_[i].patch;
          std::size_t count = 0;
          while (i + count < begin + to && count < worker.at.size() &&
                 vertices_[i + count].patch != UINT32_MAX &&
                 worker.same_quad(patch, vertices_[i + count].patch)) {
            const Vertex& vertex = vertices_[i + count];
            worker.at[count++] = place_of(surface_, PatchId(vertex.patch), vertex.at);
          }
          worker.evaluator(patch).points({worker.at.data(), count}, {worker.points.data(), count});
          for (std::size_t k = 0; k < count; ++k) finish(vertices_[i + k], worker.points[k]);
          i += count;
        }
      });
}

FlatTriangle MeshRefinement::flat(Index t) const {
  const std::array<Index, 3>& corners = complex_.corners(t);
  return {{scaled(corners[0]), scaled(corners[1]), scaled(corners[2])}, facets_[t].at};
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

// Finds the quadratic of a piece that is still one triangle; where it is coarse, the triangle's error.
void MeshRefinement::learn(Worker& worker, Index t) {
  Tile& piece = piece_of(t);
  const Patch& patch = worker.patch(piece.patch, piece.path);
  BoundsCache& library = surface_.library();
  if (patch.kind->cacheable() || limits_.max_thickness < INFINITY)
    bounding_points(library, patch, worker.hull);
  const double most = tolerable_share * tolerance(t);
  const bool whole = errors_whole_ || !(most < INFINITY) || piece.path.level() >= deepest_level;
  const ErrorUse use =
      whole ? ErrorUse{} : ErrorUse{.sufficient = sufficient_share * tolerance(t), .useless = most};
  const QuadraticTriangle near = quadratic_triangle(library, patch, worker.hull, use);
  piece.known = true;
  if (limits_.max_thickness < INFINITY) piece.thick = thickness(patch, worker.hull) > limits_.max_thickness;
  piece.coarse = piece.thick || !(near.error <= most) || !(near.error < INFINITY);
  if (!piece.coarse) {
    quadratics_[piece.quadratic] = PieceQuadratic(near, piece.path);
    return;
  }
  const FlatTriangle triangle = flat(t);
  double& error = facets_[t].error;
  error = near.error < INFINITY ? PieceQuadratic(near, piece.path).flatness(triangle).error : INFINITY;
  // Where the quadratic itself is too far away there is nothing to be gained.
  if (error > tolerance(t) && !(error - 2 * near.error > tolerance(t))) {
    const ErrorUse use_here = whole ? ErrorUse{} : ErrorUse{.useless = tolerance(t)};
    error = std::min(error, distance_to_triangle(library, patch, worker.hull, triangle.corner, use_here));
  }
}

void MeshRefinement::prove(Worker& worker, Index t, bool mark) {
  Tile& piece = piece_of(t);
  if (!piece.known) learn(worker, t);
  if (!piece.coarse) {
    const Flatness flatness = quadratics_[piece.quadratic].flatness(flat(t));
    facets_[t].error = flatness.error;
    if (mark && flatness.error > tolerance(t)) mark_bent(t, flatness);
  } else if (mark && (piece.thick || facets_[t].error > tolerance(t))) {
    if (piece.path.level() >= deepest_level) return stuck_.store(true, std::memory_order_relaxed);
    mark_sides(t);
  }
}

// Sides that are bent beyond what is left of the tolerance, or the most bent one.
void MeshRefinement::mark_bent(Index t, const Flatness& flatness) {
  const double taken = quadratics_[piece_of(t).quadratic].error() + flatness.corner_gap,
               left = std::max(tolerance(t) - taken, tolerance(t) / 4);
  std::array<double, 3> bow_sq;
  for (std::size_t k = 0; k < 3; ++k) bow_sq[k] = length_sq(flatness.bow[k]);
  const auto most = static_cast<std::size_t>(std::max_element(bow_sq.begin(), bow_sq.end()) - bow_sq.begin());
  const TriangleParameter a = facets_[t].at[most], b = facets_[t].at[(most + 1) % 3];
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
  const Index patch = piece_of(t).patch;
  std::array<std::optional<Vector3>, 3> normal;
  for (std::size_t k = 0; k < 3; ++k) {
    normal[k] = worker.evaluator(patch).frame(place_of(surface_, PatchId(patch), facets_[t].at[k])).normal;
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

void MeshRefinement::examine(Worker& worker, Index t, bool mark) {
  prove(worker, t, mark);
  if (mark) mark_long(worker, t);
}

void MeshRefinement::examine(const std::vector<Index>& triangles, bool mark) {
  make_room_for_quadratics(triangles);
  parallel_for_with(
      triangles.size(), run_.threads, [&] { return Worker(surface_); },
      [&](Worker& worker, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          if (i % 256 == 0) monitor_of(run_).checkpoint();
          examine(worker, triangles[i], mark);
        }
      });
  refuse_if_stuck();
  for (const Index t : triangles) {
    Tile& piece = piece_of(t);
    if (!piece.coarse) continue;
    coarse_.push_back(t);
    if (piece.quadratic != UINT32_MAX) quadratics_.drop(std::exchange(piece.quadratic, UINT32_MAX));
  }
}

// For pieces that are not known yet, each of which may turn out to have one.
void MeshRefinement::make_room_for_quadratics(const std::vector<Index>& triangles) {
  for (const Index t : triangles) {
    Tile& piece = piece_of(t);
    if (!piece.known && piece.quadratic == UINT32_MAX) piece.quadratic = quadratics_.add();
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
  const Tile& piece = piece_of(t);
  const std::size_t choices = split_count(marks);
  if (piece.coarse || choices == 1) return 0;
  std::array<TriangleParameter, 6> at;
  std::array<Point3, 6> point;
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = facets_[t].point(k);
    at[3 + k] = facets_[t].point(3 + k);
    point[k] = scaled(complex_.corners(t)[k]);
    const TriangleComplex::Edge& edge = complex_.edge(complex_.edge_of(t, k));
    if (edge.halves != TriangleComplex::none) point[3 + k] = scaled(complex_.edge(edge.halves).to);
  }
  const double slight = limits_.tolerance < INFINITY ? limits_.tolerance / 4 : 0;
  const auto bend = [&](std::size_t p, std::size_t q) {
    return std::max(slight, length(quadratics_[piece.quadratic].bow(at[p], at[q])));
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

std::vector<MeshRefinement::Cut> MeshRefinement::plan_cuts() {
  std::vector<Cut> cuts;
  const std::size_t old = triangle_count();
  std::size_t triangles = 0, edges = 0, pieces = pieces_.size();
  for (Index t = 0; t < old; ++t) {
    const std::size_t marks = number_of_bits[complex_.marks(t)];
    if (marks == 0) continue;
    const bool coarse = piece_of(t).coarse;
    cuts.push_back({t, static_cast<Index>(old + triangles), static_cast<Index>(complex_.edge_count() + edges),
                    static_cast<Index>(pieces)});
    triangles += marks;
    edges += marks;
    pieces += coarse ? 4 : 0;
  }
  complex_.extend(triangles, edges);
  facets_.resize(old + triangles);
  pieces_.resize(pieces);
  return cuts;
}

void MeshRefinement::carry_out(const Cut& cut) {
  const unsigned marks = complex_.marks(cut.triangle);
  SNUG_EXPECT(marks == 7 || !piece_of(cut.triangle).coarse);
  const TriangleSplit shape = split_of(marks, choose(cut.triangle, marks));
  complex_.cut(cut.triangle, shape, cut.first_new, cut.first_edge);
  const Facet whole = facets_[cut.triangle];
  const Tile& parent = pieces_[whole.piece];
  for (unsigned i = 0; i < shape.count; ++i) {
    const Index t = i == 0 ? cut.triangle : cut.first_new + i - 1;
    const auto& [p, q, r] = shape.triangles[i];
    facets_[t] = {{whole.point(p), whole.point(q), whole.point(r)}, whole.piece};
    if (!parent.coarse) continue;
    facets_[t].piece = cut.first_piece + i;
    piece_of(t) = {parent.path.child(i), parent.patch};
  }
}

// Splits what is marked; the parts, whose sides have no marks.
void MeshRefinement::split(std::vector<Index>& parts) {
  const std::size_t old = vertices_.size();
  complex_.number_middles([&](std::size_t t, std::size_t k) {
    vertices_.push_back({{}, facets_[t].point(3 + k), 0, piece_of(t).patch});
  });
  evaluate(old, vertices_.size());
  const std::vector<Cut> cuts = plan_cuts();
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
  std::erase_if(coarse_, [&](Index t) { return !piece_of(t).coarse; });
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
  errors_whole_ = true;
  std::vector<Index> unknown;
  for (Index t = 0; t < triangle_count(); ++t) {
    Tile& piece = piece_of(t);
    if (facets_[t].error < INFINITY || !piece.coarse) continue;
    piece.known = false;
    unknown.push_back(t);
  }
  examine(unknown, false);
}

double MeshRefinement::error_bound() const {
  double largest = 0;
  for (const Facet& facet : facets_) largest = std::max(largest, facet.error);
  return unscaled_up(largest, back());
}

void MeshRefinement::refuse_if_stuck() const {
  if (!stuck_.load()) return;
  double largest = 0;
  for (const Facet& facet : facets_) {
    if (pieces_[facet.piece].path.level() >= deepest_level) largest = std::max(largest, facet.error);
  }
  char text[160];
  std::snprintf(
      text, sizeof text, "tessellate: rounding leaves more than the error on this mesh; take %.3g or more",
      4 * unscaled_up(std::max(largest, std::min(limits_.tolerance, limits_.max_thickness)), back()));
  refuse_value(text);
}

void MeshRefinement::add_normals(Tessellation& result, const std::vector<Index>& order) const {
  result.normals.resize(order.size());
  parallel_for_with(
      order.size(), run_.threads, [&] { return Worker(surface_); },
      [&](Worker& worker, std::size_t begin, std::size_t end) {
        monitor_of(run_).checkpoint();
        for (std::size_t i = begin; i < end; ++i) {
          const LimitFrame frame = worker.evaluator(vertices_[order[i]].patch).frame(result.parameters[i]);
          result.normals[i] = frame.normal.value_or(Vector3{});
        }
      });
}

// What is needed no more goes before the result comes: both are largest now.
Tessellation MeshRefinement::take_result(std::vector<double>* errors) {
  Tessellation result;
  result.error_bound = error_bound();
  const std::size_t count = triangle_count();
  std::vector<Index> patches(pieces_.size());
  for (std::size_t i = 0; i < patches.size(); ++i) patches[i] = pieces_[i].patch;
  pieces_ = std::vector<Tile>();
  quadratics_ = {};
  std::vector<std::array<Index, 3>> corners = complex_.take_corners();
  // Patch by patch.
  std::vector<std::size_t> begins(surface_.patch_count() + 1, 0);
  for (const Facet& facet : facets_) ++begins[patches[facet.piece] + 1];
  for (std::size_t p = 1; p < begins.size(); ++p) begins[p] += begins[p - 1];
  result.triangles.resize(count);
  result.owners.resize(count);
  if (errors != nullptr) errors->resize(count);
  if (options_.corners) result.corners.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    const Facet& facet = facets_[t];
    const PatchId patch(patches[facet.piece]);
    const std::size_t place = begins[patch.value()]++;
    result.triangles[place] = corners[t];
    result.owners[place] = surface_.place(patch).owner;
    if (errors != nullptr) (*errors)[place] = unscaled_up(facet.error, back());
    if (!options_.corners) continue;
    for (std::size_t k = 0; k < 3; ++k) result.corners[place][k] = place_of(surface_, patch, facet.at[k]);
  }
  facets_ = {};
  corners = std::vector<std::array<Index, 3>>();
  // Vertices in the order in which triangles name them.
  std::vector<Index> number(vertices_.size(), UINT32_MAX), order;
  order.reserve(vertices_.size());
  result.positions.reserve(vertices_.size());
  result.parameters.reserve(vertices_.size());
  double position_error = 0;
  for (std::array<Index, 3>& triangle : result.triangles) {
    for (Index& v : triangle) {
      if (number[v] == UINT32_MAX) {
        number[v] = static_cast<Index>(order.size());
        order.push_back(v);
        const Vertex& vertex = vertices_[v];
        result.positions.push_back(vertex.written);
        result.parameters.push_back(place_of(surface_, PatchId(vertex.patch), vertex.at));
        position_error = std::max(position_error, vertex.error);
      }
      v = number[v];
    }
  }
  result.position_error = unscaled_up(position_error, back());
  if (options_.normals) add_normals(result, order);
  return result;
}

void require_positive(const std::optional<double>& value, const char* message) {
  require_value(!value || (*value > 0 && std::isfinite(*value)), message);
}

Limits limits_of(const LimitSurface& surface, const TessellateOptions& options) {
  require_value(options.error || options.max_edge || options.max_angle || options.max_triangles ||
                    options.view || options.max_thickness,
                "tessellate: give error, max_edge, max_angle, max_triangles, view or max_thickness");
  require_positive(options.error, "tessellate: the error must be finite and positive");
  require_positive(options.max_edge, "tessellate: the longest edge must be finite and positive");
  require_positive(options.max_thickness, "tessellate: the thickness must be finite and positive");
  require_value(!options.max_angle || (*options.max_angle > 0 && *options.max_angle <= 180),
                "tessellate: the largest angle must be above 0 and at most 180 degrees");
  require_value(!options.max_triangles || *options.max_triangles > 0,
                "tessellate: the number of triangles must be positive");
  const PowerOfTwo scale = surface.scale(), back = scale.inverse();
  const double least = options.single_precision ? min_single_tolerance : min_tolerance;
  const auto scaled = [&](const std::optional<double>& length, const char* what) {
    if (!length) return double{INFINITY};
    const double result = scale.apply(*length);
    if (!(result >= least)) {
      char text[200];
      std::snprintf(
          text, sizeof text,
          "tessellate: %s of %g is too small for coordinates as large as these%s; take %.4g or more", what,
          *length, options.single_precision ? " in single precision" : "",
          rounded_up(unscaled_up(least, back) * (1 + 1e-3)));
      refuse_value(text);
    }
    return result;
  };
  Limits limits;
  limits.tolerance = scaled(options.error, "an error");
  limits.max_edge = scaled(options.max_edge, "a longest edge");
  limits.max_thickness = scaled(options.max_thickness, "a thickness");
  if (options.view) {
    require_value(is_finite(options.view->eye),
                  "tessellate: a coordinate of the eye is not finite; give three numbers");
    require_value(options.view->angle > 0 && options.view->angle < 90,
                  "tessellate: the angle under which errors are seen must be above 0 and below 90 degrees");
    limits.eye = scale.apply(options.view->eye);
    limits.slope = std::sin(options.view->angle * 3.14159265358979323846 / 180);
  }
  if (options.max_angle) limits.min_cosine = std::cos(*options.max_angle * 3.14159265358979323846 / 180);
  limits.shortest_turn =
      std::isfinite(limits.tolerance) ? limits.tolerance : 1e-6 * scale.apply(surface.size());
  return limits;
}

// The smallest error that is found for at most so many triangles, by tolerances in between.
class CountSearch {
 public:
  CountSearch(const LimitSurface& surface, const TessellateOptions& options, const Limits& limits,
              const Run& run)
      : surface_(surface),
        options_(options),
        limits_(limits),
        run_(run),
        monitor_(monitor_of(run)),
        max_splits_(run.max_splits.value_or(default_splits::tessellate)),
        max_triangles_(std::min(*options.max_triangles, max_splits_)) {}

  Tessellation run() {
    const double wanted = limits_.tolerance;
    if (std::isfinite(wanted) && attempt(wanted)) return finished(true);
    if (!attempt(INFINITY)) refuse_number();
    // So many triangles are too many at `low`; at `high` they are enough.
    double low = std::isfinite(wanted) ? wanted : 0, high = error_;
    constexpr int max_bisections = 16;
    for (int i = 0; i < max_bisections && high > least() && high > 1.02 * low; ++i) {
      monitor_.report(i / static_cast<double>(max_bisections));
      const double guess = high * static_cast<double>(count_) / static_cast<double>(max_triangles_);
      double next = low > 0 ? std::sqrt(low * high) : guess / (i == 0 ? 1.0 : 2.0);
      next = std::max({next, least(), 1.01 * low});
      if (attempt(next)) {
        high = std::min(next, error_);
      } else {
        low = next;
      }
    }
    const bool spent = max_splits_ < *options_.max_triangles && high > least();
    return finished(!std::isfinite(wanted) && !spent);
  }

 private:
  [[nodiscard]] double least() const {
    return options_.single_precision ? min_single_tolerance : min_tolerance;
  }
  // Keeps the best.
  bool attempt(double tolerance) {
    limits_.tolerance = tolerance;
    const WorkMonitor quiet = stop_only(run_);
    MeshRefinement refinement(surface_, options_, limits_, {.threads = run_.threads, .monitor = &quiet});
    if (!refinement.run(max_triangles_) || refinement.triangle_count() > max_triangles_) return false;
    const double error = surface_.scale().apply(refinement.error_bound());
    if (!best_ || error < error_) {
      error_ = error;
      count_ = refinement.triangle_count();
      best_ = refinement.take_result();
    }
    return true;
  }
  Tessellation finished(bool reached) {
    best_->outcome = outcome_of(reached, true);
    return std::move(*best_);
  }
  // Names the number that is enough, if the budget allows to find it.
  [[noreturn]] void refuse_number() {
    limits_.tolerance = INFINITY;
    MeshRefinement refinement(surface_, options_, limits_, run_);
    const bool known = refinement.run(max_splits_);
    const std::uint64_t needed = refinement.triangle_count();
    std::string text = "tessellate: ";
    text += known && needed <= *options_.max_triangles
                ? "a budget of " + std::to_string(max_splits_) + " triangles is too small"
                : std::to_string(*options_.max_triangles) + " triangles are too few";
    text += " for this mesh and what else is asked for; ";
    if (known) {
      text += "take " + std::to_string(needed) + " or more";
      if (max_splits_ < needed && needed > *options_.max_triangles) text += ", with a budget as large";
    } else {
      text += "so is the budget of " + std::to_string(max_splits_) +
              "; give more of both, or longer edges, larger angles and thicknesses";
    }
    refuse_value(text.c_str());
  }

  const LimitSurface& surface_;
  const TessellateOptions& options_;
  Limits limits_;
  Run run_;
  const WorkMonitor& monitor_;
  std::uint64_t max_splits_;
  std::uint64_t max_triangles_;  // triangles of an attempt
  std::optional<Tessellation> best_;
  double error_ = INFINITY;  // of the best, in scaled units
  std::size_t count_ = 0;
};

}  // namespace

Tessellation tessellate(const Surface& handle, const TessellateOptions& options, const Run& run) {
  const LimitSurface& surface = handle.data()->limit();
  const Limits limits = limits_of(surface, options);
  if (options.max_triangles) return CountSearch(surface, options, limits, run).run();
  MeshRefinement refinement(surface, options, limits, run);
  const bool reached = refinement.run(run.max_splits.value_or(default_splits::tessellate));
  if (!reached) refinement.find_errors();
  Tessellation result = refinement.take_result();
  result.outcome = outcome_of(reached, true);
  return result;
}

LocalTessellation tessellate(const LimitSurface& surface, std::span<const double> tolerances,
                             const TessellateOptions& options, const Run& run) {
  Limits limits;
  limits.of_owner.reserve(tolerances.size());
  for (const double tolerance : tolerances) {
    limits.of_owner.push_back(std::max(surface.scale().apply(tolerance), min_tolerance));
  }
  limits.tolerance = *std::min_element(limits.of_owner.begin(), limits.of_owner.end());
  MeshRefinement refinement(surface, options, limits, run);
  const bool reached = refinement.run(run.max_splits.value_or(default_splits::tessellate));
  if (!reached) refinement.find_errors();
  LocalTessellation result;
  result.mesh = refinement.take_result(&result.errors);
  result.mesh.outcome = outcome_of(reached, true);
  return result;
}

}  // namespace snug
