#include <snug/search/piece_cut.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <snug/bounds/bounding_points.h>
#include <snug/geometry/rounding.h>
#include <support/contract.h>
#include <support/direction.h>

namespace snug {
namespace {

// Factor that covers a few roundings of a bound.
constexpr double safely = 1 + 0x1p-30;
// Slopes above this are not worth a bound; sines of the angle between pieces below that are none.
constexpr double max_slope = 0.5, min_cut_sine = 1e-5, direction_error = 1e-9;
// The share of its distance from a zero that a step may leave, and how many are made.
constexpr double max_contraction = 0.9;
constexpr unsigned max_steps = 80;
// Largest box in which ends of arcs are not separated.
constexpr double max_end_box = 0x1p-24;

Vector3 mean(const std::vector<Vector3>& vectors) {
  Vector3 sum;
  for (const Vector3& v : vectors) sum = sum + v;
  return (1 / static_cast<double>(vectors.size())) * sum;
}

double longest(const std::vector<Vector3>& vectors, double error) {
  double largest = 0;
  for (const Vector3& v : vectors) largest = std::max(largest, length(v));
  return enlarged(largest * safely + spatial_error(error));
}

// Upper bound of |dot(w, v) - target| over the hull of vectors that are off by `error` a coordinate.
double widest(const std::vector<Vector3>& vectors, double error, const Vector3& w, double target) {
  double found = 0, largest = 0;
  for (const Vector3& v : vectors) {
    found = std::max(found, std::fabs(dot(w, v) - target));
    largest = std::max(largest, max_abs(v));
  }
  return enlarged(found + length(w) * (2 * error + 16 * unit_roundoff * largest) +
                  4 * unit_roundoff * std::fabs(target)) *
         safely;
}

Extent extent_of_net(const std::vector<Vector3>& points, double error, const BoundedPoint& origin,
                     const Vector3& w) {
  Extent extent;
  double largest = max_abs(origin.position - Point3{});
  for (const Vector3& p : points) {
    extent.add(dot(w, p));
    largest = std::max(largest, max_abs(p));
  }
  const double from = dot(w, origin.position - Point3{});
  const double reach = enlarged(length(w) * (2 * (error + origin.error) + 32 * unit_roundoff * largest));
  if (!std::isfinite(reach) || !std::isfinite(extent.lower) || !std::isfinite(extent.upper)) return unbounded;
  return {extent.lower + from - reach, extent.upper + from + reach};
}

bool parted(const Extent& a, const Extent& b) { return a.upper < b.lower || b.upper < a.lower; }

// A straight line in the parameters of a piece.
struct Path {
  TriangleParameter from, to;
  std::vector<Vector3> tangents;  // their hull holds the derivative along it
  [[nodiscard]] TriangleParameter at(double t) const {
    return {from.u + t * (to.u - from.u), from.v + t * (to.v - from.v)};
  }
};

Path edge_of(const PlacedPiece& piece, std::size_t k) {
  constexpr std::array<TriangleParameter, 3> corners{{{0, 0}, {1, 0}, {0, 1}}};
  return {corners[k], corners[(k + 1) % 3], piece.derivatives().edge[k]};
}

// Through a piece from border to border, across the line between two parameters and halfway; nothing where there is
// no such line.
std::optional<Path> path_between(const PlacedPiece& piece, TriangleParameter p, TriangleParameter q) {
  const TriangleParameter middle{(p.u + q.u) / 2, (p.v + q.v) / 2}, along{p.v - q.v, q.u - p.u};
  double low = -INFINITY, high = INFINITY;
  // Where the line leaves the half planes u >= 0, v >= 0, 1 - u - v >= 0.
  const std::array<std::array<double, 2>, 3> sides{
      {{middle.u, along.u}, {middle.v, along.v}, {1 - middle.u - middle.v, -along.u - along.v}}};
  for (const auto& [value, rate] : sides) {
    if (rate > 0) low = std::max(low, -value / rate);
    if (rate < 0) high = std::min(high, -value / rate);
  }
  if (!(low < high && std::isfinite(high - low))) return std::nullopt;
  Path path;
  path.from = {middle.u + low * along.u, middle.v + low * along.v};
  path.to = {middle.u + high * along.u, middle.v + high * along.v};
  const auto& [along_u, along_v, along_edges, error] = piece.derivatives();
  for (std::size_t i = 0; i < along_u.size(); ++i) {
    path.tangents.push_back((path.to.u - path.from.u) * along_u[i] + (path.to.v - path.from.v) * along_v[i]);
  }
  return path;
}

}  // namespace

PlacedPiece::PlacedPiece(BoundsCache& library, const Patch& patch, const PlacedFrame& frame) {
  if (patch.kind->polynomial()) {
    origin_ = {frame.apply(patch.origin), frame.apply_error(patch.origin)};
    take_polynomial(patch, frame);
    bound_slope();
  } else {
    take_hull(library, patch, frame);
  }
  bound_box();
}

void PlacedPiece::take_polynomial(const Patch& patch, const PlacedFrame& frame) {
  const BezierRows& form = patch.kind->form();
  const std::size_t n = form.degree, count = bezier_count(n);
  net_ = {std::vector<Vector3>(form.parts * count), n, form.parts};
  double largest = 0;
  for (std::size_t i = 0; i < net_.points.size(); ++i) {
    const Vector3 p = form.rows.apply<Vector3>(i, patch.points);
    net_.points[i] = frame.scale * times(frame.rows, p);
    largest = std::max(largest, std::max(max_abs(net_.points[i]), frame.scale * max_abs(p)));
  }
  // Rows of R have absolute sums below 2.
  const double net_error = enlarged(2 * frame.scale * form.rows.result_error(patch.largest, patch.error) +
                                    16 * unit_roundoff * largest) +
                           8 * underflow_error;
  error_ = enlarged(net_error + gamma_bound(96) * largest);
  const auto degree = static_cast<double>(n);
  derivatives_.error = enlarged(degree * (4 * net_error + 16 * unit_roundoff * largest));
  const auto at = [&](std::size_t part, std::size_t i, std::size_t j) {
    return net_.points[part * count + bezier_index(n, i, j)];
  };
  for (std::size_t part = 0; part < net_.parts; ++part) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i + j < n; ++i) {
        const Vector3 first = degree * (at(part, i + 1, j) - at(part, i, j)),
                      second = degree * (at(part, i, j + 1) - at(part, i, j));
        // The parts' corners are 0, 1, m and m, 1, 2 with m the middle of 0 and 2.
        derivatives_.u.push_back(part == 0 ? first : first + second);
        derivatives_.v.push_back(net_.parts == 1 ? second : 2 * second);
      }
    }
  }
  const auto add_edge = [&](std::size_t edge, double share, const auto& point) {
    for (std::size_t t = 0; t <= n; ++t) {
      edge_[edge].push_back(point(t));
      if (t > 0) derivatives_.edge[edge].push_back((degree / share) * (point(t) - point(t - 1)));
    }
  };
  const std::size_t last = net_.parts - 1;
  add_edge(0, 1, [&](std::size_t t) { return at(0, t, 0); });
  add_edge(1, 1, [&](std::size_t t) { return at(last, n - t, t); });
  if (net_.parts == 2) add_edge(2, 0.5, [&](std::size_t t) { return at(1, 0, n - t); });
  add_edge(2, net_.parts == 2 ? 0.5 : 1, [&](std::size_t t) { return at(0, 0, n - t); });
}

void PlacedPiece::take_hull(BoundsCache& library, const Patch& patch, const PlacedFrame& frame) {
  thread_local BoundingPoints points;
  bounding_points(library, patch, points);
  origin_ = {frame.apply(points.origin), frame.apply_error(points.origin)};
  net_.points.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    net_.points[i] = frame.scale * times(frame.rows, points.at(i));
  const double largest = 2 * frame.scale * points.largest;
  error_ = enlarged(2 * frame.scale * points.error + 16 * unit_roundoff * largest) + 8 * underflow_error;
}

void PlacedPiece::bound_slope() {
  const auto& [along_u, along_v, along_edges, e] = derivatives_;
  const Vector3 u = mean(along_u), v = mean(along_v);
  const Vector3 normal = normalized(cross(u, v));
  if (normal == Vector3{}) return;
  // dual_u . u = 1, dual_u . v = 0, and likewise for v, up to what is measured.
  Vector3 dual_u = cross(v, normal), dual_v = cross(normal, u);
  dual_u = (1 / dot(dual_u, u)) * dual_u;
  dual_v = (1 / dot(dual_v, v)) * dual_v;
  const double uu = widest(along_u, e, dual_u, 1), uv = widest(along_v, e, dual_u, 0),
               vu = widest(along_u, e, dual_v, 0), vv = widest(along_v, e, dual_v, 1);
  const double determinant = (1 - uu) * (1 - vv) - uv * vu;
  if (!(uu < 0.75 && vv < 0.75 && determinant > 0.0625)) return;
  const double length_u = length(dual_u), length_v = length(dual_v);
  const double max_u = (length_u * (1 - vv) + uv * length_v) / determinant,
               max_v = (length_v * (1 - uu) + vu * length_u) / determinant;
  const double slope =
      safely * (max_u * widest(along_u, e, normal, 0) + max_v * widest(along_v, e, normal, 0)) + 0x1p-46;
  if (!(slope < max_slope)) return;
  normal_ = normal;
  slope_ = slope;
}

void PlacedPiece::bound_box() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vector3 w;
    w[axis] = 1;
    const Extent extent = this->extent(w);
    box_.lower[axis] = extent.lower;
    box_.upper[axis] = extent.upper;
  }
}

Extent PlacedPiece::extent(const Vector3& w) const { return extent_of_net(net_.points, error_, origin_, w); }

Vector3 PlacedPiece::Net::at(TriangleParameter at) const {
  SNUG_EXPECT(parts > 0);
  double u = at.u, v = at.v;
  std::size_t part = 0;
  if (parts == 2) {
    // 0 = 2 m - 2, as points, on the one half; 2 = 2 m - 0 on the other one.
    part = 1 - u - 2 * v >= 0 ? 0 : 1;
    v = part == 0 ? 2 * v : 2 * v + u - 1;
  }
  const double w = 1 - u - v;
  std::array<Vector3, bezier_count(max_degree)> net;
  const std::size_t count = bezier_count(degree);
  std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(part * count), count, net.begin());
  for (std::size_t n = degree; n > 0; --n) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i + j < n; ++i) {
        net[bezier_index(n - 1, i, j)] = w * net[bezier_index(n, i, j)] + u * net[bezier_index(n, i + 1, j)] +
                                         v * net[bezier_index(n, i, j + 1)];
      }
    }
  }
  return net[0];
}

namespace {

// (t, u, v): along an edge of one piece, and on the other piece.
struct CurvePlace {
  double t, u, v;
};
double max_abs(const CurvePlace& p) { return std::max({std::fabs(p.t), std::fabs(p.u), std::fabs(p.v)}); }

CurvePlace clamped_place(const CurvePlace& p) {
  CurvePlace result{std::clamp(p.t, 0.0, 1.0), std::max(p.u, 0.0), std::max(p.v, 0.0)};
  if (const double excess = (result.u + result.v - 1) / 2; excess > 0) {
    result.u = std::clamp(result.u - excess, 0.0, 1.0);
    result.v = std::max(0.0, 1 - result.u - 0x1p-52);
  }
  return result;
}
// The ends of a path that was computed may be off the border by some roundings.
bool outside(const CurvePlace& p, double radius) {
  return p.t < -radius - 0x1p-45 || p.t > 1 + radius + 0x1p-45 || p.u < -radius || p.v < -radius ||
         p.u + p.v > 1 + 2 * radius + 0x1p-50;
}
bool inside(const CurvePlace& p, double radius) {
  return p.t > radius && p.t < 1 - radius && p.u > radius && p.v > radius &&
         p.u + p.v < 1 - 2 * radius - 0x1p-50;
}

// A path on one piece against another piece: zeros of path(t) - piece(u, v), all of which a step of Newton's method with
// one and the same matrix brings nearer to each other.
class PathAgainstPiece {
 public:
  PathAgainstPiece(const PlacedPiece& from, const Path& path, const PlacedPiece& piece)
      : from_(from), path_(path), piece_(piece) {
    const auto& [along_u, along_v, along_edges, f] = piece.derivatives();
    const Vector3 t = mean(path.tangents), u = mean(along_u), v = mean(along_v);
    const Vector3 across = cross(u, v);
    const double inverse = 1 / dot(t, across);
    if (!std::isfinite(inverse)) return;
    rows_ = {inverse * across, -inverse * cross(v, t), -inverse * cross(t, u)};
    const double e = 4 * from.derivatives().error;
    contraction_ = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      contraction_ = std::max(contraction_, safely * (widest(path.tangents, e, rows_[i], i == 0 ? 1 : 0) +
                                                      widest(along_u, f, rows_[i], i == 1 ? -1 : 0) +
                                                      widest(along_v, f, rows_[i], i == 2 ? -1 : 0)));
    }
    error_ = enlarged(from.error() + piece.error() + from.origin().error + piece.origin().error);
    origins_ = from.origin().position - piece.origin().position;
  }

  enum class State : std::uint8_t {
    none,    // there is no zero
    one,     // there is one, in the inside
    border,  // none, or one at the border of a domain
    unsure,
  };
  struct Found {
    State state = State::unsure;
    CurvePlace at{};
    double doubt = 0;  // a zero is no farther from there
  };
  [[nodiscard]] Found find() const {
    if (!(contraction_ < max_contraction)) return {};
    Found found;
    CurvePlace x{0.5, 1.0 / 3, 1.0 / 3};
    double far = 2.0 / 3 * safely;  // a zero is no farther from x
    for (unsigned i = 0; i < max_steps; ++i) {
      const auto [step, blur] = step_at(x);
      const CurvePlace next{x.t - step.t, x.u - step.u, x.v - step.v};
      const double size = max_abs(step), ball = safely * (size + blur) / (1 - contraction_);
      if (!(ball < INFINITY)) break;
      if (inside(x, ball) && (found.state == State::unsure || ball < found.doubt)) {
        found = {State::one, x, ball};
      }
      if (found.state == State::one && size <= 2 * blur) return found;
      const double radius = safely * (contraction_ * far + blur) + 0x1p-50 * (1 + size);
      if (found.state == State::unsure && outside(next, radius)) return {.state = State::none};
      x = clamped_place(next);
      const double moved = max_abs(CurvePlace{next.t - x.t, next.u - x.u, next.v - x.v});
      far = std::min(safely * (radius + moved), 1.0);
      if (found.state == State::unsure && far <= safely * 8 * (blur + 0x1p-50) / (1 - contraction_)) {
        return {State::border, x, far};
      }
    }
    return found;
  }

  // Is there a plane between an edge and the piece: along the piece, or across it and along one of its edges?
  [[nodiscard]] bool apart(std::size_t edge) const {
    const auto parts = [&](const Vector3& w) {
      return w != Vector3{} &&
             parted(extent_of_net(from_.edge(edge), from_.error(), from_.origin(), w), piece_.extent(w));
    };
    if (parts(piece_.normal())) return true;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::vector<Vector3>& side = piece_.edge(k);
      if (parts(normalized(cross(piece_.normal(), side.back() - side.front())))) return true;
    }
    return parts(normalized(cross(piece_.normal(), from_.normal()))) || parts(from_.normal());
  }

 private:
  struct Step {
    CurvePlace by;
    double blur;  // upper bound of what each coordinate is off
  };
  [[nodiscard]] Step step_at(const CurvePlace& x) const {
    const Vector3 p = from_.at(path_.at(x.t)), q = piece_.at({x.u, x.v});
    const Vector3 gap = origins_ + (p - q);
    const double error =
        error_ + 8 * unit_roundoff * (snug::max_abs(origins_) + snug::max_abs(p) + snug::max_abs(q));
    Step step{{dot(rows_[0], gap), dot(rows_[1], gap), dot(rows_[2], gap)}, 0};
    for (const Vector3& row : rows_) {
      step.blur = std::max(
          step.blur, enlarged(length(row) * (2 * error + 16 * unit_roundoff * snug::max_abs(gap))) * safely);
    }
    return step;
  }

  const PlacedPiece& from_;
  const Path& path_;
  const PlacedPiece& piece_;
  std::array<Vector3, 3> rows_;
  double contraction_ = INFINITY, error_ = 0;
  Vector3 origins_;
};
using Found = PathAgainstPiece::Found;
using State = PathAgainstPiece::State;

CutEnd end_at(const PlacedPiece& from, const Path& path, const Found& found) {
  CutEnd end{.side = 0,
             .edge = 0,
             .along = found.at.t,
             .at = {found.at.u, found.at.v},
             .doubt = found.doubt,
             .sure = found.state == State::one,
             .point = {},
             .error = 0};
  const Vector3 p = from.at(path.at(end.along));
  end.point = from.origin().position + p;
  const double error = from.error() + from.origin().error + 4 * unit_roundoff * max_abs(end.point - Point3{});
  end.error = enlarged(found.doubt * longest(path.tangents, 4 * from.derivatives().error) * safely +
                       spatial_error(error));
  return end;
}

// The arc between two ends, along a direction that no chord of it is far from.
CutArc arc_between(const CutEnd& from, const CutEnd& to, const Vector3& along, double spread, double error) {
  CutArc arc{.ends = {from, to}, .deviation = 0, .box = {}};
  const Vector3 way = to.point - from.point;
  const double ahead = dot(way, along), aside = length(way - ahead * along);
  const double tangent = spread / std::sqrt(1 - spread * spread);
  arc.deviation =
      enlarged(safely * ((tangent * (ahead + 2 * error) + aside) / 2 + 3 * error) +
               8 * unit_roundoff * (max_abs(from.point - Point3{}) + max_abs(to.point - Point3{})));
  arc.box.add(from.point);
  arc.box.add(to.point);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    arc.box.lower[axis] = rounded_down(arc.box.lower[axis] - arc.deviation);
    arc.box.upper[axis] = rounded_up(arc.box.upper[axis] + arc.deviation);
  }
  return arc;
}

// Ends that are not separated along the direction of the curve.
struct EndGroup {
  std::vector<CutEnd> ends;
  double lower, upper;  // heights along the direction
  [[nodiscard]] bool sure() const { return ends.size() == 1 && ends[0].sure; }
  // Holds all their points.
  [[nodiscard]] Box3 box() const {
    Box3 box;
    const double around = enlarged(2 * (upper - lower) + 0x1p-48);
    for (const CutEnd& end : ends) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min(box.lower[axis], end.point[axis] - end.error - around);
        box.upper[axis] = std::max(box.upper[axis], end.point[axis] + end.error + around);
      }
    }
    return box;
  }
};

// Where they lie on the first piece.
TriangleParameter on_first(const PlacedPiece& first, const CutEnd& end) {
  return end.side == 0 ? edge_of(first, end.edge).at(end.along) : end.at;
}

// The common curve of two pieces; each plane across `along` meets it at most once.
class Transversal {
 public:
  Transversal(const PlacedPiece& a, const PlacedPiece& b, const Vector3& along, double spread)
      : a_(a), b_(b), along_(along), spread_(spread) {}

  [[nodiscard]] PieceCut cut() {
    if (!find_ends()) return {};
    if (groups_.empty()) return {PieceCut::State::apart, {}, {}};
    const bool sure = std::all_of(groups_.begin(), groups_.end(), [](const EndGroup& g) { return g.sure(); });
    if (sure && groups_.size() % 2 != 0) return {};
    PieceCut result{PieceCut::State::arcs, {}, {}};
    bool before = false;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      const bool last = i + 1 == groups_.size();
      const std::optional<bool> after = last ? false : sure ? i % 2 == 0 : arc_after(i);
      if (!after) return {};
      // Between two arcs there would have to be an end that is none.
      if (before && *after) return {};
      if (groups_[i].sure() && before == *after) return {};
      if (*after) {
        result.arcs.push_back(
            arc_between(groups_[i].ends[0], groups_[i + 1].ends[0], along_, spread_, doubt(i)));
        result.arcs.back().ends[0].sure = groups_[i].sure();
        result.arcs.back().ends[1].sure = groups_[i + 1].sure();
      }
      if (!groups_[i].sure()) {
        const Box3 box = groups_[i].box();
        if (!(longest_side(box) < max_end_box)) return {};
        result.end_boxes.push_back(box);
      }
      before = *after;
    }
    return result;
  }

 private:
  [[nodiscard]] double height(const CutEnd& end) const { return dot(along_, end.point - Point3{}); }

  bool find_ends() {
    std::vector<CutEnd> ends;
    for (std::size_t side = 0; side < 2; ++side) {
      const PlacedPiece &from = side == 0 ? a_ : b_, &piece = side == 0 ? b_ : a_;
      for (std::size_t edge = 0; edge < 3; ++edge) {
        const Path path = edge_of(from, edge);
        const PathAgainstPiece test(from, path, piece);
        const Found found = test.find();
        if (found.state == State::unsure && !test.apart(edge)) return false;
        if (found.state != State::one && found.state != State::border) continue;
        ends.push_back(end_at(from, path, found));
        ends.back().side = side;
        ends.back().edge = edge;
      }
    }
    std::sort(ends.begin(), ends.end(),
              [&](const CutEnd& x, const CutEnd& y) { return height(x) < height(y); });
    for (const CutEnd& end : ends) {
      const double middle = height(end), reach = safely * end.error + 0x1p-46;
      if (groups_.empty() || middle - reach > groups_.back().upper) {
        groups_.push_back({{}, middle - reach, middle + reach});
      }
      EndGroup& group = groups_.back();
      group.ends.push_back(end);
      group.lower = std::min(group.lower, middle - reach);
      group.upper = std::max(group.upper, middle + reach);
    }
    // A lower end may reach below what was closed before.
    for (std::size_t i = 0; i + 1 < groups_.size(); ++i) {
      if (!(groups_[i].upper < groups_[i + 1].lower)) return false;
    }
    return true;
  }

  // Is there an arc from group i to the next one? Looked for halfway, on a path that parts them in the first piece.
  [[nodiscard]] std::optional<bool> arc_after(std::size_t i) const {
    const EndGroup &low = groups_[i], &high = groups_[i + 1];
    const TriangleParameter p = on_first(a_, low.ends[0]), q = on_first(a_, high.ends[0]);
    const auto path = path_between(a_, p, q);
    if (!path) return std::nullopt;
    // All ends of each group on their side, by far.
    const TriangleParameter way{q.u - p.u, q.v - p.v}, middle{(p.u + q.u) / 2, (p.v + q.v) / 2};
    const double size = std::fabs(way.u) + std::fabs(way.v);
    for (const EndGroup* group : {&low, &high}) {
      for (const CutEnd& end : group->ends) {
        const TriangleParameter at = on_first(a_, end);
        const double ahead = (at.u - middle.u) * way.u + (at.v - middle.v) * way.v;
        const double least = size * (2 * end.doubt + 0x1p-45);
        if (!(group == &low ? ahead < -least : ahead > least)) return std::nullopt;
      }
    }
    const Found found = PathAgainstPiece(a_, *path, b_).find();
    if (found.state == State::none) return false;
    if (found.state != State::one) return std::nullopt;
    const CutEnd met = end_at(a_, *path, found);
    const double at = height(met), reach = safely * met.error + 0x1p-46;
    if (!(at - reach > low.upper && at + reach < high.lower)) return std::nullopt;
    return true;
  }

  // How far the exact ends of an arc may be from those that stand for their groups.
  [[nodiscard]] double doubt(std::size_t i) const {
    double found = 0;
    for (std::size_t k = i; k <= i + 1; ++k) {
      const CutEnd& first = groups_[k].ends[0];
      for (const CutEnd& end : groups_[k].ends) {
        found = std::max(found, safely * (length(end.point - first.point) + end.error));
      }
    }
    return found;
  }

  const PlacedPiece &a_, &b_;
  Vector3 along_;
  double spread_;
  std::vector<EndGroup> groups_;
};

}  // namespace

PieceCut cut(const PlacedPiece& a, const PlacedPiece& b) {
  if (common_box(a.box(), b.box()).empty()) return {PieceCut::State::apart, {}, {}};
  const auto parts = [&](const Vector3& w) { return w != Vector3{} && parted(a.extent(w), b.extent(w)); };
  if (parts(a.normal()) || parts(b.normal())) return {PieceCut::State::apart, {}, {}};
  if (!a.bounded_slope() || !b.bounded_slope()) return {};
  const Vector3 across = cross(a.normal(), b.normal());
  const double sine = length(across), cosine = std::fabs(dot(a.normal(), b.normal()));
  if (!(sine > min_cut_sine)) return {};
  const Vector3 along = normalized(across);
  if (parts(along)) return {PieceCut::State::apart, {}, {}};
  // The share of a chord of both pieces that is across `along`.
  const double s = a.slope(), t = b.slope();
  const double spread = safely * std::sqrt(s * s + t * t + 2 * s * t * cosine) / sine + direction_error;
  if (!(spread < max_slope)) return {};
  return Transversal(a, b, along, spread).cut();
}

Box3 common_box(const Box3& a, const Box3& b) {
  Box3 both;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    both.lower[axis] = std::max(a.lower[axis], b.lower[axis]);
    both.upper[axis] = std::min(a.upper[axis], b.upper[axis]);
    if (both.lower[axis] > both.upper[axis]) return {};
  }
  return both;
}

}  // namespace snug
