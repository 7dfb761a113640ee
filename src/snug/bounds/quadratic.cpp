#include <snug/bounds/quadratic.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <snug/base/contract.h>
#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/hull_points.h>
#include <snug/bounds/lasting_layout.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>

namespace snug {
namespace {

// Corners and then middles of the edges 01, 12, 20, relative to a patch's origin.
using Quadratic = std::array<Vector3, 6>;
using Restriction = std::array<QuadraticWeights, 6>;

// What squares, products and sums lose by underflow is less.
constexpr double tiny = 0x1p-500;
// Place of each of the six among the Bezier points u^i v^j of degree 2.
constexpr std::array<std::array<std::size_t, 2>, 6> places{{{0, 0}, {2, 0}, {0, 2}, {1, 0}, {1, 1}, {0, 1}}};

Restriction restriction_to(const ParameterTriangle& piece) {
  Restriction weights;
  for (std::size_t k = 0; k < 6; ++k) weights[k] = raised_quadratic(piece, 2, places[k][0], places[k][1]);
  return weights;
}

Quadratic restricted(const Quadratic& q, const Restriction& weights) {
  Quadratic result;
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t i = 0; i < 6; ++i) result[k] = result[k] + weights[k][i] * q[i];
  }
  return result;
}

Quadratic turned(const Quadratic& q, std::size_t first) {
  Quadratic result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = q[(k + first) % 3];
    result[3 + k] = q[3 + (k + first) % 3];
  }
  return result;
}

double largest_of(const Quadratic& q) {
  double largest = 0;
  for (const Vector3& p : q) largest = std::max(largest, max_abs(p));
  return largest;
}

// From the middle of the quadratic's corners.
double by_hulls(const Patch& net, const Quadratic& q) {
  const Vector3 middle = (1.0 / 3) * (q[0] + q[1] + q[2]);
  double patch_sq = 0, quadratic_sq = 0;
  for (const Vector3& p : net.points) patch_sq = std::max(patch_sq, length_sq(p - middle));
  for (const Vector3& p : q) quadratic_sq = std::max(quadratic_sq, length_sq(p - middle));
  const double roundings = 16 * unit_roundoff * (net.largest + largest_of(q)) + tiny;
  return enlarged(std::sqrt(patch_sq) + std::sqrt(quadratic_sq) + spatial_error(net.error + roundings));
}

// Levels of the rows that say where the limit points of a layout are, and how large basis functions.
constexpr unsigned frame_levels = 8;
// How often the net of a piece that is no polynomial is split before what is left of it ends it.
constexpr unsigned most_levels = 16;
// How much nets may add before they are split.
constexpr double notable_excess = 0.02;
constexpr double corner_weight = 3;
// The same for kinds that few share: one of a passing kind, and at a crowded corner.
constexpr unsigned passing_levels = 5, crowded_levels = 12;

// Rows of one level end in a net only at irregular corners (bound_rows.h).
bool has_irregular_corner(const Kind& kind) {
  return !kind.regular_corner(0) || !kind.regular_corner(1) || !kind.regular_corner(2);
}

// Corners of the convex hull, up to rounding.
std::vector<LayoutPoint> convex_hull(std::vector<LayoutPoint> points) {
  std::sort(points.begin(), points.end());
  std::vector<LayoutPoint> hull;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t fixed = hull.size();
    for (; begin != end; ++begin) {
      while (hull.size() > fixed + 1) {
        const LayoutPoint &p = hull[hull.size() - 2], &q = hull.back();
        if ((q[0] - p[0]) * ((*begin)[1] - p[1]) - (q[1] - p[1]) * ((*begin)[0] - p[0]) > 0) break;
        hull.pop_back();
      }
      hull.push_back(*begin);
    }
    hull.pop_back();
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

// x of the positive definite system A x = b, by elimination.
void solve(std::array<std::array<double, 6>, 6> a, std::array<double, 6>& b) {
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t r = k + 1; r < 6; ++r) {
      const double factor = a[r][k] / a[k][k];
      for (std::size_t c = k; c < 6; ++c) a[r][c] -= factor * a[k][c];
      b[r] -= factor * b[k];
    }
  }
  for (std::size_t k = 6; k-- > 0;) {
    for (std::size_t c = k + 1; c < 6; ++c) b[k] -= a[k][c] * b[c];
    b[k] /= a[k][k];
  }
}

}  // namespace

std::size_t QuadraticRows::bytes() const {
  return rows_.bytes() + nets_.size() * sizeof(Net) + (fit_.size() + largest_.size()) * sizeof(double) +
         (layout_.size() + offsets_.size()) * sizeof(LayoutPoint);
}

// Least squares: of all quadratics the one whose Bezier points, raised, are nearest to those of the patch;
// the corners count as several.
void QuadraticRows::make_fit(const BoundRows& deep) {
  const std::size_t count = deep.bezier_count();
  std::vector<double> weight_of(count, 1.0);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t r = 0; r < count; ++r) {
      if (deep.quadratic(k)[r] == 1) weight_of[r] = corner_weight;
    }
  }
  std::array<std::array<double, 6>, 6> gram{};
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t l = 0; l < 6; ++l) {
      for (std::size_t r = 0; r < count; ++r)
        gram[k][l] += weight_of[r] * deep.quadratic(k)[r] * deep.quadratic(l)[r];
    }
  }
  for (std::size_t c = 0; c < deep.control_count(); ++c) {
    std::array<double, 6> column{};
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t r = 0; r < count; ++r)
        column[k] += weight_of[r] * deep.quadratic(k)[r] * deep.weight(r, c);
    }
    solve(gram, column);
    fit_.insert(fit_.end(), column.begin(), column.end());
  }
}

void QuadraticRows::make_frame(const Kind& kind, const BoundRows& deep) {
  layout_ = lasting_layout(kind);
  if (layout_.empty()) return;
  double size = 0;
  for (const LayoutPoint& at : layout_) size = std::max({size, std::fabs(at[0]), std::fabs(at[1])});
  // Each point that convex_hull() leaves out moves what is left by less than eight roundoffs.
  const double error =
      enlarged(deep.result_error(size, 0) + gamma_bound(24 * deep.count() + 64) * (1 + size));
  if (!(error < 1e-9)) return layout_.clear();
  std::size_t corner = 0;
  while (kind.regular_corner(corner)) ++corner;
  const unsigned levels = std::min(frame_levels, tip_depth(kind.corner(corner), kind.scheme()));
  const double left = std::ldexp(1.0, -static_cast<int>(levels));
  largest_.assign(layout_.size(), 0.0);
  std::vector<LayoutPoint> offsets;
  for (std::size_t r = 0; r < deep.count(); ++r) {
    LayoutPoint at{0, 0};
    for (std::size_t c = 0; c < layout_.size(); ++c) {
      const double weight = deep.weight(r, c);
      largest_[c] = std::max(largest_[c], std::fabs(weight));
      for (std::size_t a = 0; a < 2; ++a) at[a] += weight * layout_[c][a];
    }
    if (r < deep.bezier_count()) {
      // The parameter itself is the quadratic with corners (0, 0), (1, 0), (0, 1) and the middles between.
      const double u = deep.quadratic(1)[r] + 0.5 * (deep.quadratic(3)[r] + deep.quadratic(4)[r]),
                   v = deep.quadratic(2)[r] + 0.5 * (deep.quadratic(4)[r] + deep.quadratic(5)[r]);
      offsets.push_back({at[0] - u, at[1] - v});
      continue;
    }
    // On the last piece at the corner it is anywhere.
    LayoutPoint ends[3]{{0, 0}, {left, 0}, {0, left}};
    for (const LayoutPoint& end : ends) {
      const double u = corner == 1 ? 1 - left : 0, v = corner == 2 ? 1 - left : 0;
      offsets.push_back({at[0] - (u + end[0]), at[1] - (v + end[1])});
    }
  }
  offsets_ = convex_hull(std::move(offsets));
  offset_error_ = error;
  for (double& largest : largest_) largest = enlarged(largest + deep.entry_error());
}

// Of the layout's image under the affine map l that takes its limit corners to those of the patch, as
// computed: patch - l = sum d_i N_i with d_i = c_i - l(layout_i), and l less the quadratic is what the layout
// is off the parameters, and a quadratic.
double QuadraticRows::distance(const Kind& kind, const Patch& patch, const Quadratic& q) const {
  if (layout_.empty()) return INFINITY;
  std::array<Vector3, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) corner[k] = kind.corner_limits().apply<Vector3>(k, patch.points);
  const Vector3 along_u = corner[1] - corner[0], along_v = corner[2] - corner[0];
  double size = std::max(patch.largest, largest_of(q));
  for (const Vector3& c : corner) size = std::max(size, max_abs(c));
  double by_functions = 0;
  for (std::size_t i = 0; i < layout_.size(); ++i) {
    const auto [u, v] = layout_[i];
    const Vector3 off = patch.points[i] - (corner[0] + u * along_u + v * along_v);
    const double roundings = 16 * unit_roundoff * (1 + std::fabs(u) + std::fabs(v)) * size;
    by_functions += largest_[i] * (length(off) + spatial_error(patch.error + roundings) + tiny);
  }
  double by_layout_sq = 0;
  for (const auto& [u, v] : offsets_) {
    by_layout_sq = std::max(by_layout_sq, length_sq(u * along_u + v * along_v));
  }
  double linear_sq = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    linear_sq = std::max({linear_sq, length_sq(corner[k] - q[k]),
                          length_sq(0.5 * (corner[k] + corner[(k + 1) % 3]) - q[3 + k])});
  }
  const double roundings = 8 * (offset_error_ + 64 * unit_roundoff) * size;
  return enlarged(by_functions + std::sqrt(by_layout_sq) + std::sqrt(linear_sq) + roundings + tiny);
}

QuadraticRows make_quadratic_rows(const Kind& kind) {
  SNUG_EXPECT(kind.shared());
  QuadraticRows result;
  if (kind.polynomial()) {
    result.rows_ = make_bound_rows(kind);
    result.make_fit(result.rows_);
    return result;
  }
  result.rows_ = make_bound_rows(kind, 1);
  std::size_t begin = result.rows_.bezier_count();
  for (const std::size_t c : {std::size_t{3}, std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    const KindChild& child = kind.children()[c];
    if (!has_irregular_corner(*child.kind)) continue;
    result.nets_.push_back(
        {child.kind, begin, restriction_to(turned(child_of(whole_patch, c), child.first))});
    begin += child.kind->control_count();
  }
  SNUG_EXPECT(begin == result.rows_.count());
  const BoundRows deep = make_bound_rows(kind, frame_levels);
  result.make_fit(deep);
  result.make_frame(kind, deep);
  return result;
}

namespace {

// Bounds |patch - quadratic|: Bezier points of pieces, and nets that are split while they add notably.
class Comparison {
 public:
  // Of a patch in its kind's order.
  [[nodiscard]] double distance(BoundsCache& library, const Patch& patch, const Quadratic& q) {
    library_ = &library;
    opened_ = 0;
    farthest_ = 0;
    add(patch, q, 0, 0);
    return settle();
  }

 private:
  // A piece in its kind's order, whose quadratic is off by at most `given`, a coordinate.
  void add(const Patch& piece, const Quadratic& q, double given, unsigned level) {
    const Kind& kind = *piece.kind;
    if (!kind.shared()) return add_parts(piece, q, given, level);
    if (kind.polynomial() && kind.form().degree == 1) return add_plane(piece, q, given);
    const QuadraticRows& rows = library_->quadratic_rows(kind);
    points_.restart(piece.origin);
    points_.add(rows.rows(), piece);
    const kernels::Coordinates bezier = points_.coordinates().first(rows.rows().bezier_count());
    const double size = std::max(points_.largest, largest_of(q));
    take(kernels::farthest_from_quadratic(bezier, rows.rows().quadratic(0), q),
         points_.error + given + gamma_bound(32) * size);
    for (const QuadraticRows::Net& net : rows.nets()) {
      Open& open = next_open();
      take_net(net, piece.origin, open.piece);
      open.quadratic = restricted(q, net.restrict);
      measure(open, given + gamma_bound(16) * size, level + 1);
    }
  }

  // Splits nets while they add notably. The largest distance.
  [[nodiscard]] double settle() {
    double rest = 0;
    for (std::size_t next = 0; next < opened_; ++next) {
      Open& open = *open_[next];
      const Kind& kind = *open.piece.kind;
      const unsigned limit = kind.shared() ? most_levels : kind.passing() ? passing_levels : crowded_levels;
      if (open.distance <= (1 + notable_excess) * farthest_ || open.level >= limit) {
        rest = std::max(rest, open.distance);
      } else {
        add(open.piece, open.quadratic, open.given, open.level);
      }
    }
    return std::max(rest, farthest_);
  }
  struct Open {
    Patch piece;  // in its kind's order
    Quadratic quadratic;
    double given = 0, distance = 0;
    unsigned level = 0;
  };
  Open& next_open() {
    if (opened_ == open_.size()) open_.push_back(std::make_unique<Open>());
    return *open_[opened_++];
  }
  void measure(Open& open, double given, unsigned level) {
    const Kind& kind = *open.piece.kind;
    open.given = given;
    open.level = level;
    open.distance = by_hulls(open.piece, open.quadratic);
    if (kind.shared()) {
      open.distance =
          std::min(open.distance, library_->quadratic_rows(kind).distance(kind, open.piece, open.quadratic));
    }
    open.distance = enlarged(open.distance + spatial_error(given) + tiny);
  }
  void take(double distance, double error) {
    const double most = enlarged(distance + spatial_error(error) + tiny);
    farthest_ = std::isfinite(most) ? std::max(farthest_, most) : INFINITY;
  }
  void take_net(const QuadraticRows::Net& net, const Point3& origin, Patch& piece) const {
    piece.kind = net.kind;
    piece.first = 0;
    piece.origin = origin;
    piece.points.resize(net.kind->control_count());
    piece.largest = 0;
    for (std::size_t i = 0; i < piece.points.size(); ++i) {
      piece.points[i] = points_.at(net.begin + i);
      piece.largest = std::max(piece.largest, max_abs(piece.points[i]));
    }
    piece.error = points_.error;
  }
  // Points of degree 1, raised.
  void add_plane(const Patch& piece, const Quadratic& q, double given) {
    const Stencils& rows = piece.kind->bezier();
    std::array<Vector3, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = rows.apply<Vector3>(k, piece.points);
    double sq = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sq = std::max(
          {sq, length_sq(corner[k] - q[k]), length_sq(0.5 * (corner[k] + corner[(k + 1) % 3]) - q[3 + k])});
    }
    take(std::sqrt(sq), rows.result_error(piece.largest, piece.error) + given +
                            8 * unit_roundoff * (piece.largest + largest_of(q)));
  }
  void add_parts(const Patch& piece, const Quadratic& q, double given, unsigned level) {
    for (unsigned child = 0; child < 4; ++child) {
      Open part{split(piece, child), restricted(q, restriction_to(child_of(whole_patch, child)))};
      part.quadratic = turned(part.quadratic, part.piece.first);
      part.piece.first = 0;
      part.piece.path = {};
      const double off = given + gamma_bound(16) * largest_of(q);
      if (part.piece.kind->polynomial()) {
        add(part.piece, part.quadratic, off, level + 1);
      } else {
        measure(part, off, level + 1);
        next_open() = std::move(part);
      }
    }
  }

  BoundsCache* library_ = nullptr;
  HullPoints points_;
  std::vector<std::unique_ptr<Open>> open_;  // as many as there ever were
  std::size_t opened_ = 0;
  double farthest_ = 0;
};

// Through the limits of corners and of the middles of edges.
Quadratic through_limits(const Patch& patch) {
  const std::array<Vector3, 3> p = limit_corners(patch), m = limit_corners(split(patch, 3));
  Quadratic q{p[0], p[1], p[2]};
  for (std::size_t k = 0; k < 3; ++k) {
    q[3 + k] = 2.0 * m[(k + 2) % 3] - 0.5 * (p[k] + p[(k + 1) % 3]);
  }
  return q;
}

Quadratic fitted(const QuadraticRows& rows, const Patch& patch) {
  std::array<std::array<double, 6>, 3> c;
  kernels::apply_rows(rows.fit(), 6, patch.points, c[0].data(), c[1].data(), c[2].data());
  Quadratic q;
  for (std::size_t k = 0; k < 6; ++k) q[k] = {c[0][k], c[1][k], c[2][k]};
  return q;
}

// About the patch's origin, in the kind's order.
struct Fit {
  Quadratic quadratic;
  double error;
};

Fit fit_of(BoundsCache& library, const Patch& patch) {
  thread_local Comparison comparison;
  Patch whole = patch;
  whole.first = 0;
  whole.path = {};
  Fit fit{{}, 0};
  const Kind& kind = *patch.kind;
  if (!kind.shared()) {
    fit.quadratic = through_limits(whole);
  } else if (kind.polynomial() && kind.form().degree == 1) {
    for (std::size_t k = 0; k < 3; ++k) fit.quadratic[k] = kind.bezier().apply<Vector3>(k, patch.points);
    for (std::size_t k = 0; k < 3; ++k) {
      fit.quadratic[3 + k] = 0.5 * (fit.quadratic[k] + fit.quadratic[(k + 1) % 3]);
    }
  } else {
    fit.quadratic = fitted(library.quadratic_rows(kind), patch);
  }
  fit.error = comparison.distance(library, whole, fit.quadratic);
  return fit;
}

}  // namespace

QuadraticTriangle quadratic_triangle(BoundsCache& library, const Patch& patch) {
  const auto [quadratic, distance] = fit_of(library, patch);
  QuadraticTriangle result;
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    result.corners[k] = patch.origin + quadratic[patch.to_kind(k)];
    result.middles[k] = patch.origin + quadratic[3 + patch.to_kind(k)];
    for (const Point3& p : {result.corners[k], result.middles[k]}) {
      largest = std::max(largest, max_abs(p - Point3{}));
    }
  }
  const bool finite =
      std::all_of(patch.points.begin(), patch.points.end(), [](const Vector3& p) { return is_finite(p); }) &&
      largest < INFINITY && distance < INFINITY;
  result.error = finite ? enlarged(distance + spatial_error(2 * unit_roundoff * largest)) : double{INFINITY};
  return result;
}

}  // namespace snug
