#include <snug/bounds/quadratic.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <snug/bounds/bounding_points.h>
#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/invariant_layout.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <support/contract.h>
#include <support/direction.h>
#include <support/ordering.h>

namespace snug {
namespace {

// Corners and then middles of the edges 01, 12, 20, relative to a patch's origin.
using Quadratic = std::array<Vector3, 6>;
using Restriction = QuadraticRows::Restriction;

// Above the losses of squares, products and sums by underflow.
constexpr double tiny = 0x1p-500;
// Place of each of the six among the Bezier points u^i v^j of degree 2.
constexpr std::array<std::array<std::size_t, 2>, 6> places{{{0, 0}, {2, 0}, {0, 2}, {1, 0}, {1, 1}, {0, 1}}};

Restriction restriction_to(const ParameterTriangle& piece) {
  const RaisedQuadratic quadratic(piece, 2);
  Restriction weights;
  for (std::size_t k = 0; k < 6; ++k) weights[k] = quadratic.point(places[k][0], places[k][1]);
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
Apart by_hulls(const Patch& net, const Quadratic& q, const Vector3& normal) {
  const Vector3 middle = (1.0 / 3) * (q[0] + q[1] + q[2]);
  double patch_sq = 0, quadratic_sq = 0, patch_along = 0, quadratic_along = 0;
  const auto take = [&](const Vector3& p, double& sq, double& along) {
    const Vector3 v = p - middle;
    sq = std::max(sq, length_sq(v));
    along = std::max(along, std::fabs(dot(normal, v)));
  };
  for (const Vector3& p : net.points) take(p, patch_sq, patch_along);
  for (const Vector3& p : q) take(p, quadratic_sq, quadratic_along);
  const double roundings = 16 * unit_roundoff * (net.largest + largest_of(q)) + tiny;
  const double off = spatial_error(net.error + roundings);
  return {enlarged(std::sqrt(patch_sq) + std::sqrt(quadratic_sq) + off),
          enlarged(patch_along + quadratic_along + off)};
}

// Levels of the rows that say where the limit points of a layout are, and how large basis functions.
constexpr unsigned frame_levels = 8;
// How often the net of a piece that is no polynomial is split before what is left of it ends it.
constexpr unsigned max_levels = 16;
// How much nets may add before they are split.
constexpr double notable_excess = 0.05;
constexpr double corner_weight = 3;
// Layouts whose limit points are farther from their parameters are no lattices.
constexpr double max_lattice_error = 1e-12;
// Points of a lattice with smaller basis functions are bounded one by one.
constexpr double light_weight = 1.0 / 16;

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

// Least squares over the Bezier points of the children; the patch's own corners count as several.
QuarterRows make_quarter_rows() {
  QuarterRows rows{};
  std::array<std::array<double, 6>, 6> gram{};
  const auto weight = [](std::size_t child, std::size_t i) { return child == i ? corner_weight : 1.0; };
  for (std::size_t child = 0; child < 4; ++child) {
    const Restriction& to = rows.to_child[child] = restriction_to(child_of(whole_patch, child));
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t l = 0; l < 6; ++l) {
        for (std::size_t i = 0; i < 6; ++i) gram[k][l] += weight(child, i) * to[i][k] * to[i][l];
      }
    }
  }
  for (std::size_t child = 0; child < 4; ++child) {
    for (std::size_t i = 0; i < 6; ++i) {
      std::array<double, 6> column = rows.to_child[child][i];
      for (double& entry : column) entry *= weight(child, i);
      solve(gram, column);
      for (std::size_t k = 0; k < 6; ++k) rows.from_child[child][k][i] = column[k];
    }
  }
  return rows;
}

}  // namespace

const QuarterRows& quarter_rows() {
  static const QuarterRows rows = make_quarter_rows();
  return rows;
}

namespace {

bool comes_again(const Kind& kind) {
  const std::vector<KindChild>& children = kind.children();
  return std::any_of(children.begin(), children.end(),
                     [&](const KindChild& child) { return child.kind == &kind; });
}

// Is it a curved polynomial, or does it come again, or do its parts, so many levels down?
bool is_common(const Kind& kind, unsigned levels) {
  if (kind.polynomial()) return kind.form().degree > 1;
  if (kind.transient() || !has_quadratic_rows(kind)) return false;
  if (comes_again(kind)) return true;
  const std::vector<KindChild>& children = kind.children();
  return levels > 0 && std::all_of(children.begin(), children.end(), [&](const KindChild& child) {
           return is_common(*child.kind, levels - 1);
         });
}

}  // namespace

std::vector<double> quadratic_fit(BoundsCache& library, const Kind& kind) {
  if (kind.polynomial() || kind.transient() || !has_quadratic_rows(kind)) return {};
  if (comes_again(kind)) {
    const double* const own = library.quadratic_rows(kind).fit();
    return {own, own + 6 * kind.control_count()};
  }
  const std::vector<KindChild>& children = kind.children();
  if (!std::all_of(children.begin(), children.end(),
                   [](const KindChild& c) { return is_common(*c.kind, 1); })) {
    return {};
  }
  std::vector<double> fit(6 * kind.control_count(), 0.0);
  for (std::size_t child = 0; child < children.size(); ++child) {
    const auto& [of, first, step, control] = children[child];
    const double* const own = library.quadratic_rows(*of).fit();
    const Restriction& back = quarter_rows().from_child[child];
    for (std::size_t i = 0; i < control.size(); ++i) {
      std::array<double, 6> weights{};  // of this control point in the whole
      for (std::size_t k = 0; k < 6; ++k) {
        // Corner k of the child's kind is corner k + first of the child.
        const std::size_t to = k < 3 ? (k + first) % 3 : 3 + (k + first) % 3;
        for (std::size_t q = 0; q < 6; ++q) weights[q] += back[q][to] * own[6 * i + k];
      }
      const Stencils::Row row = step->row(control[i]);
      for (std::size_t s = 0; s < row.sources.size(); ++s) {
        double* const column = fit.data() + std::size_t{6} * row.sources[s];
        for (std::size_t q = 0; q < 6; ++q) column[q] += row.weights[s] * weights[q];
      }
    }
  }
  return fit;
}

std::size_t QuadraticRows::bytes() const {
  return (to_nets_.size() + to_level_nets_.size()) * sizeof(Restriction) +
         (fit_.size() + largest_.size()) * sizeof(double) +
         (layout_.size() + offsets_.size()) * sizeof(LayoutPoint);
}

// Least squares: of all quadratics the one whose Bezier points, raised, are nearest to those of the patch;
// the corners count as several.
void QuadraticRows::make_fit(const BoundingRows& deep) {
  const std::size_t count = deep.bezier_count();
  std::vector<double> weight_of(count, 1.0);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t r = 0; r < count; ++r) {
      if (deep.quadratic(k)[r] == 1) weight_of[r] = corner_weight;
    }
  }
  // Six sums at a time, which do not wait for each other.
  std::vector<std::array<double, 6>> weighted(count);
  std::array<std::array<double, 6>, 6> gram{};
  for (std::size_t r = 0; r < count; ++r) {
    for (std::size_t k = 0; k < 6; ++k) weighted[r][k] = weight_of[r] * deep.quadratic(k)[r];
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t l = 0; l < 6; ++l) gram[k][l] += weighted[r][k] * deep.quadratic(l)[r];
    }
  }
  for (std::size_t c = 0; c < deep.control_count(); ++c) {
    const double* const weights = deep.column(c);
    std::array<double, 6> column{};
    for (std::size_t r = 0; r < count; ++r) {
      for (std::size_t k = 0; k < 6; ++k) column[k] += weighted[r][k] * weights[r];
    }
    solve(gram, column);
    fit_.insert(fit_.end(), column.begin(), column.end());
  }
}

void QuadraticRows::make_frame(const Kind& kind, const BoundingRows& deep) {
  layout_ = invariant_layout(kind);
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

// A lattice lasts where a step makes of it lattices again, each in its place, and points of polynomial pieces at their
// parameters: then its limit points are at their parameters, up to what all levels err by.
void QuadraticRows::make_lattice(BoundsCache& library, const Kind& kind) {
  const std::vector<LayoutPoint> layout = lattice_layout(kind);
  if (layout.empty()) return;
  struct Piece {
    std::vector<LayoutPoint> layout;
    std::vector<double> largest;
    double sum = 0;  // of `largest`
  };
  std::vector<Piece> pieces;
  double below = 0;
  const BoundingRows* const direct = library.direct_rows(kind);
  const BoundingRows rows = direct ? *direct : make_bounding_rows(kind, 1);
  for (const BoundingRows::Net& net : rows.nets()) {
    if (!net.kind->transient() || !has_quadratic_rows(*net.kind)) return;
    const QuadraticRows& piece = library.quadratic_rows(*net.kind);
    if (!piece.lattice_) return;
    below = std::max(below, piece.offset_error_);
    pieces.push_back({piece.layout_, piece.largest_});
    for (const double weight : piece.largest_) pieces.back().sum += weight;
  }
  double size = 1, error = 0;
  for (const LayoutPoint& at : layout) size = std::max({size, std::fabs(at[0]), std::fabs(at[1])});
  const auto expect = [&](std::size_t r, double u, double v) {
    LayoutPoint at{0, 0};
    for (std::size_t c = 0; c < layout.size(); ++c) {
      for (std::size_t a = 0; a < 2; ++a) at[a] += rows.weight(r, c) * layout[c][a];
    }
    error = std::max({error, std::fabs(at[0] - u), std::fabs(at[1] - v)});
  };
  std::vector<double> largest(layout.size(), 0.0);
  for (std::size_t r = 0; r < rows.bezier_count(); ++r) {
    expect(r, rows.quadratic(1)[r] + 0.5 * (rows.quadratic(3)[r] + rows.quadratic(4)[r]),
           rows.quadratic(2)[r] + 0.5 * (rows.quadratic(4)[r] + rows.quadratic(5)[r]));
    for (std::size_t c = 0; c < layout.size(); ++c) {
      largest[c] = std::max(largest[c], std::fabs(rows.weight(r, c)) + rows.entry_error());
    }
  }
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const BoundingRows::Net& net = rows.nets()[n];
    const Piece& piece = pieces[n];
    for (std::size_t i = 0; i < piece.layout.size(); ++i) {
      const LayoutPoint at = piece.layout[i];
      const auto place = [&](std::size_t k) {
        return (1 - at[0] - at[1]) * net.place[0][k] + at[0] * net.place[1][k] + at[1] * net.place[2][k];
      };
      expect(net.begin + i, place(1), place(2));
    }
    for (std::size_t c = 0; c < layout.size(); ++c) {
      double most = 0, sum = 0;
      for (std::size_t i = 0; i < piece.layout.size(); ++i) {
        const double weight = std::fabs(rows.weight(net.begin + i, c));
        most = std::max(most, weight);
        sum += weight * piece.largest[i];
      }
      largest[c] =
          std::max(largest[c], std::min(most + rows.entry_error(), sum + rows.entry_error() * piece.sum));
    }
  }
  const double all = enlarged(error + rows.result_error(size, 0) + gamma_bound(32) * size + below);
  if (!(all < max_lattice_error)) return;
  layout_ = layout;
  offset_error_ = all;
  lattice_ = true;
  largest_ = std::move(largest);
  for (double& weight : largest_) weight = enlarged(weight);
}

// With l the affine map of parameters to the quadratic's corners and d_i = c_i - l(layout_i), patch - q is
// sum d_i N_i + (l - q): a convex combination of the d_i plus one of Bezier points. Control points beyond a sharp crease
// are far off l, but their basis functions are small: these are bounded one by one, with zero in their place.
Apart QuadraticRows::distance_on_lattice(const Patch& patch, const Quadratic& q,
                                         const Vector3& normal) const {
  const Vector3 along_u = q[1] - q[0], along_v = q[2] - q[0];
  const double size = std::max(patch.largest, largest_of(q));
  // Bezier points of l less q; those at corners are zero.
  std::array<Vector3, 4> linear;
  for (std::size_t k = 0; k < 3; ++k) linear[k] = 0.5 * (q[k] + q[(k + 1) % 3]) - q[3 + k];
  struct Most {
    double sq = 0, along = 0;
    void add(const Vector3& v, const Vector3& n) { add({length_sq(v), std::fabs(dot(n, v))}); }
    void add(const Most& other) {
      sq = std::max(sq, other.sq);
      along = std::max(along, other.along);
    }
  } all, heavy;
  Apart light;
  double reach = 1;
  for (const Vector3& b : linear) heavy.add(b, normal);
  for (std::size_t i = 0; i < layout_.size(); ++i) {
    const auto [u, v] = layout_[i];
    const Vector3 off = patch.points[i] - (q[0] + u * along_u + v * along_v);
    reach = std::max(reach, 1 + std::fabs(u) + std::fabs(v));
    Most here;
    for (const Vector3& b : linear) here.add(off + b, normal);
    all.add(here);
    if (largest_[i] > light_weight) {
      heavy.add(here);
    } else {
      light.any += largest_[i] * length(off);
      light.along += largest_[i] * std::fabs(dot(normal, off));
    }
  }
  const double doubt = spatial_error(2 * reach * (patch.error + 16 * unit_roundoff * size)) +
                       8 * (offset_error_ + 64 * unit_roundoff) * size + tiny;
  return {enlarged(std::min(std::sqrt(all.sq), std::sqrt(heavy.sq) + light.any) + doubt),
          enlarged(std::min(all.along, heavy.along + light.along) + doubt)};
}

// Of the layout's image under the affine map l that takes its limit corners to those of the patch, as
// computed: patch - l = sum d_i N_i with d_i = c_i - l(layout_i), and l less the quadratic is what the layout
// is off the parameters, and a quadratic.
Apart QuadraticRows::distance(const Kind& kind, const Patch& patch, const Quadratic& q,
                              const Vector3& normal) const {
  if (layout_.empty()) return {INFINITY, INFINITY};
  if (lattice_) return distance_on_lattice(patch, q, normal);
  std::array<Vector3, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) corner[k] = kind.corner_limits().apply<Vector3>(k, patch.points);
  const Vector3 along_u = corner[1] - corner[0], along_v = corner[2] - corner[0];
  double size = std::max(patch.largest, largest_of(q));
  for (const Vector3& c : corner) size = std::max(size, max_abs(c));
  Vector3 by_functions;
  double reach = 0, functions_along = 0;
  for (std::size_t i = 0; i < layout_.size(); ++i) {
    const auto [u, v] = layout_[i];
    const Vector3 off = patch.points[i] - (corner[0] + u * along_u + v * along_v);
    for (std::size_t a = 0; a < 3; ++a) by_functions[a] += largest_[i] * std::fabs(off[a]);
    functions_along += largest_[i] * std::fabs(dot(normal, off));
    reach += largest_[i] * (1 + std::fabs(u) + std::fabs(v));
  }
  const double off_error = reach * (patch.error + 16 * unit_roundoff * size);
  Quadratic linear;  // less q
  for (std::size_t k = 0; k < 3; ++k) {
    linear[k] = corner[k] - q[k];
    linear[3 + k] = 0.5 * (corner[k] + corner[(k + 1) % 3]) - q[3 + k];
  }
  double rest_sq = 0, rest_along = 0;
  for (const auto& [u, v] : offsets_) {
    const Vector3 by_layout = u * along_u + v * along_v;
    for (const Vector3& b : linear) {
      rest_sq = std::max(rest_sq, length_sq(by_layout + b));
      rest_along = std::max(rest_along, std::fabs(dot(normal, by_layout + b)));
    }
  }
  const double roundings = 8 * (offset_error_ + 64 * unit_roundoff) * size;
  const double doubt = spatial_error(off_error) + roundings + tiny;
  return {enlarged(length(by_functions) + std::sqrt(rest_sq) + doubt),
          enlarged(functions_along + rest_along + doubt)};
}

QuadraticRows make_quadratic_rows(BoundsCache& library, const Kind& kind) {
  SNUG_EXPECT(has_quadratic_rows(kind));
  QuadraticRows result;
  if (kind.transient()) {
    result.make_lattice(library, kind);
    return result;
  }
  if (kind.polynomial()) {
    result.make_fit(library.rows(kind));
    return result;
  }
  for (const BoundingRows::Net& net : library.rows(kind).nets()) {
    result.to_nets_.push_back(restriction_to(net.place));
  }
  for (const BoundingRows::Net& net : library.level_rows(kind).nets()) {
    result.to_level_nets_.push_back(restriction_to(net.place));
  }
  if (!comes_again(kind)) result.fit_ = quadratic_fit(library, kind);
  if (!result.fit_.empty()) return result;
  const BoundingRows deep = make_bounding_rows(kind, frame_levels);
  result.make_fit(deep);
  result.make_frame(kind, deep);
  return result;
}

namespace {

// Bounds |patch - quadratic|: Bezier points of pieces, and nets that are split while they add notably.
class Comparison {
 public:
  // Of a patch in its kind's order, and its bounding points.
  [[nodiscard]] Apart distance(BoundsCache& library, const Patch& patch, const Quadratic& q,
                               const Vector3& normal, const BoundingPoints& hull, const ErrorUse& use) {
    library_ = &library;
    normal_ = normal;
    use_ = use;
    opened_ = 0;
    pending_.clear();
    farthest_ = {};
    const Kind& kind = *patch.kind;
    if (!kind.cacheable() || (kind.polynomial() && kind.form().degree == 1)) {
      add(patch, q, 0, 0);
      return resolve();
    }
    const BoundingRows& rows = library.rows(kind);
    const std::size_t tips = hull.tips().size();
    SNUG_EXPECT(hull.size() == hull.tips_end() + (tips > 0 ? rows.bezier_count() : rows.count()));
    const double size = std::max(hull.largest, largest_of(q));
    compare(hull.coordinates().from(hull.tips_end()), hull.error, rows, q, size, 0);
    if (useless()) return {INFINITY, INFINITY};
    for (std::size_t i = 0; i < rows.nets().size(); ++i) {
      Patch& piece = next_open().piece;
      if (tips > 0) {
        piece = hull.tips()[i];
      } else {
        hull.take_net(rows.nets()[i], rows.nets()[i].begin, piece);
      }
    }
    measure_from(0, library.quadratic_rows(kind).to_nets(), q, gamma_bound(16) * size, 1);
    return resolve();
  }

 private:
  // Bezier points of a patch and of a quadratic that is off by at most `given`, a coordinate; none of them larger
  // than `size`.
  void compare(const kernels::Coordinates& points, double error, const BoundingRows& rows, const Quadratic& q,
               double size, double given) {
    if (rows.bezier_count() == 0) return;
    take(kernels::farthest_from_quadratic(points.first(rows.bezier_count()), rows.quadratic(0), q, normal_),
         error + given + gamma_bound(32) * size);
  }

  // A piece in its kind's order.
  void add(const Patch& piece, const Quadratic& q, double given, unsigned level) {
    const Kind& kind = *piece.kind;
    if (!has_quadratic_rows(kind) || kind.transient()) return add_parts(piece, q, given, level);
    if (kind.polynomial() && kind.form().degree == 1) return add_plane(piece, q, given);
    const BoundingRows& rows = library_->level_rows(kind);
    const double size = add_points(rows, piece, q, given);
    if (rows.nets().empty() || useless()) return;
    const std::size_t first = opened_;
    for (const BoundingRows::Net& net : rows.nets()) points_.take_net(net, net.begin, next_open().piece);
    measure_from(first, library_->quadratic_rows(kind).to_level_nets(), q, given + gamma_bound(16) * size,
                 level + 1);
  }

  // All that a piece's rows have of it but its nets; what none of its points or those of q is larger than.
  double add_points(const BoundingRows& rows, const Patch& piece, const Quadratic& q, double given) {
    bounding_points(rows, piece, points_);
    const double size = std::max(points_.largest, largest_of(q));
    compare(points_.coordinates(), points_.error, rows, q, size, given);
    return size;
  }

  // Rows of a library may be gone once others are made, as this may do: nets come before it.
  void measure_from(std::size_t first, const std::vector<Restriction>& to_nets, const Quadratic& q,
                    double given, unsigned level) {
    for (std::size_t i = first; i < opened_; ++i) open_[i]->quadratic = restricted(q, to_nets[i - first]);
    for (std::size_t i = first; i < opened_; ++i) measure(*open_[i], given, level);
  }

  [[nodiscard]] bool useless() const { return farthest_.any > use_.useless; }
  // Splits nets while they add notably to the largest distance, whatever its direction, and that is of use.
  [[nodiscard]] Apart resolve() {
    // The largest first: once that one adds little, none adds more.
    const auto smaller = [&](std::size_t x, std::size_t y) {
      return open_[x]->distance.any < open_[y]->distance.any;
    };
    Apart rest;
    std::size_t known = 0;
    while (!useless()) {
      for (; known < opened_; ++known) {
        pending_.push_back(known);
        ordering::push_heap(pending_.data(), pending_.size(), smaller);
      }
      if (pending_.empty()) break;
      ordering::pop_heap(pending_.data(), pending_.size(), smaller);
      const Open& open = *open_[pending_.back()];
      pending_.pop_back();
      const Kind& kind = *open.piece.kind;
      const unsigned limit = kind.cacheable()   ? max_levels
                             : kind.transient() ? transient_split_levels
                                                : high_valence_split_levels;
      const bool enough =
          open.distance.any <= std::max(use_.sufficient, (1 + notable_excess) * farthest_.any);
      if (enough || open.level >= limit) {
        rest.add(open.distance);
        if (rest.any > use_.useless) break;
      } else {
        add(open.piece, open.quadratic, open.given, open.level);
      }
    }
    rest.add(farthest_);
    if (rest.any > use_.useless) return {INFINITY, INFINITY};
    return rest;
  }
  struct Open {
    Patch piece;  // in its kind's order
    Quadratic quadratic;
    double given = 0;
    Apart distance;
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
    Apart apart{INFINITY, INFINITY};
    if (has_quadratic_rows(kind)) {
      apart = library_->quadratic_rows(kind).distance(kind, open.piece, open.quadratic, normal_);
    }
    if (apart.any == INFINITY) apart = by_hulls(open.piece, open.quadratic, normal_);
    open.distance = widened(apart, given);
  }
  // By an error of the difference, a coordinate, and what a product with the normal rounds.
  [[nodiscard]] static Apart widened(const Apart& apart, double error) {
    const double off = spatial_error(error) + tiny;
    return {enlarged(apart.any + off), enlarged(apart.along + off + 16 * unit_roundoff * apart.any)};
  }
  void take(const Apart& apart, double error) {
    const Apart most = widened(apart, error);
    const bool finite = std::isfinite(most.any) && std::isfinite(most.along);
    farthest_.add(finite ? most : Apart{INFINITY, INFINITY});
  }
  // Points of degree 1, raised.
  void add_plane(const Patch& piece, const Quadratic& q, double given) {
    const Stencils& rows = piece.kind->bezier();
    std::array<Vector3, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = rows.apply<Vector3>(k, piece.points);
    double sq = 0, along = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      for (const Vector3& off : {corner[k] - q[k], 0.5 * (corner[k] + corner[(k + 1) % 3]) - q[3 + k]}) {
        sq = std::max(sq, length_sq(off));
        along = std::max(along, std::fabs(dot(normal_, off)));
      }
    }
    take({std::sqrt(sq), along}, rows.result_error(piece.largest, piece.error) + given +
                                     8 * unit_roundoff * (piece.largest + largest_of(q)));
  }
  void add_parts(const Patch& piece, const Quadratic& q, double given, unsigned level) {
    const double off = given + gamma_bound(16) * largest_of(q);
    for (unsigned child = 0; child < 4 && !useless(); ++child) {
      Open& part = next_open();
      split(piece, child, part.piece);
      const Kind& kind = *part.piece.kind;
      part.quadratic = turned(restricted(q, quarter_rows().to_child[child]), part.piece.first);
      part.piece.first = 0;
      part.piece.path = {};
      // Those of a kind that few share are compared as they are where that is all of them.
      const BoundingRows* const direct = piece.kind->transient() ? library_->direct_rows(kind) : nullptr;
      if (!direct && !kind.polynomial()) {
        measure(part, off, level + 1);
        continue;
      }
      --opened_;
      if (!direct) {
        add(part.piece, part.quadratic, off, level + 1);
      } else {
        add_points(*direct, part.piece, part.quadratic, off);
      }
    }
  }

  BoundsCache* library_ = nullptr;
  BoundingPoints points_;
  std::vector<std::unique_ptr<Open>> open_;  // as many as there ever were
  std::size_t opened_ = 0;
  std::vector<std::size_t> pending_;
  Vector3 normal_;
  ErrorUse use_;
  Apart farthest_;
};

// In the patch's order. Where there are direct rows they have them, and need no kinds of deeper levels.
std::array<Vector3, 3> corners_of(BoundsCache& library, const Patch& patch) {
  const BoundingRows* const rows = library.direct_rows(*patch.kind);
  if (!rows) return limit_corners(patch);
  std::array<Vector3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const double* const at_corner = rows->quadratic(patch.to_kind(k));
    const auto row =
        static_cast<std::size_t>(std::find(at_corner, at_corner + rows->count(), 1.0) - at_corner);
    SNUG_EXPECT(row < rows->count());
    for (std::size_t c = 0; c < patch.points.size(); ++c) {
      corners[k] = corners[k] + rows->weight(row, c) * patch.points[c];
    }
  }
  return corners;
}

// Through the limits of corners and of the middles of edges.
Quadratic through_limits(BoundsCache& library, const Patch& patch) {
  const std::array<Vector3, 3> p = corners_of(library, patch), m = corners_of(library, split(patch, 3));
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
  Vector3 normal;
  Apart apart;
};

Apart distance_to(BoundsCache& library, const Patch& patch, const Quadratic& q, const Vector3& normal,
                  const BoundingPoints& hull, const ErrorUse& use) {
  thread_local Comparison comparison;
  thread_local Patch whole;
  whole = patch;
  whole.first = 0;
  whole.path = {};
  return comparison.distance(library, whole, q, normal, hull, use);
}

Fit fit_of(BoundsCache& library, const Patch& patch, const BoundingPoints& hull, const ErrorUse& use) {
  Fit fit;
  const Kind& kind = *patch.kind;
  if (!kind.cacheable()) {
    Patch whole = patch;
    whole.first = 0;
    whole.path = {};
    fit.quadratic = through_limits(library, whole);
  } else if (kind.polynomial() && kind.form().degree == 1) {
    for (std::size_t k = 0; k < 3; ++k) fit.quadratic[k] = kind.bezier().apply<Vector3>(k, patch.points);
    for (std::size_t k = 0; k < 3; ++k) {
      fit.quadratic[3 + k] = 0.5 * (fit.quadratic[k] + fit.quadratic[(k + 1) % 3]);
    }
  } else {
    fit.quadratic = fitted(library.quadratic_rows(kind), patch);
  }
  const Quadratic& q = fit.quadratic;
  fit.normal = normalized(cross(q[1] - q[0], q[2] - q[0]));
  fit.apart = distance_to(library, patch, q, fit.normal, hull, use);
  return fit;
}

}  // namespace

QuadraticTriangle quadratic_triangle(BoundsCache& library, const Patch& patch, const BoundingPoints& hull,
                                     const ErrorUse& use) {
  const auto [quadratic, normal, apart] = fit_of(library, patch, hull, use);
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
      largest < INFINITY && apart.any < INFINITY;
  if (!finite) {
    result.error = INFINITY;
    return result;
  }
  const double moved = spatial_error(2 * unit_roundoff * largest);
  result.error = enlarged(apart.any + moved);
  result.normal = normal;
  result.normal_error = enlarged(apart.along + moved);
  return result;
}

QuadraticTriangle quadratic_triangle(BoundsCache& library, const Patch& patch, const ErrorUse& use) {
  thread_local BoundingPoints hull;
  if (patch.kind->cacheable()) bounding_points(library, patch, hull);
  return quadratic_triangle(library, patch, hull, use);
}

double distance_to_triangle(BoundsCache& library, const Patch& patch, const BoundingPoints& hull,
                            const Triangle& triangle, const ErrorUse& use) {
  Quadratic flat;
  for (std::size_t k = 0; k < 3; ++k) flat[patch.to_kind(k)] = triangle[k] - patch.origin;
  for (std::size_t k = 0; k < 3; ++k) flat[3 + k] = 0.5 * (flat[k] + flat[(k + 1) % 3]);
  const double largest = largest_of(flat);
  const bool finite =
      std::all_of(patch.points.begin(), patch.points.end(), [](const Vector3& p) { return is_finite(p); }) &&
      largest < INFINITY;
  if (!finite) return INFINITY;
  const double distance = distance_to(library, patch, flat, {}, hull, use).any;
  return enlarged(distance + spatial_error(2 * unit_roundoff * largest));
}

}  // namespace snug
