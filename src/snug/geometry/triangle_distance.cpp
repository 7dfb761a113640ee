#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/geometry/triangle_distance.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>

// Searches over the edges and corners of two triangles, four at once; the same bits on every instruction set.

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

using Tag = hn::CappedTag<double, 4>;
using V = hn::Vec<Tag>;
using Corners = std::array<Vector3, 3>;

// a + s b and a - s b.
HWY_INLINE Vec3<V> plus(const Vec3<V>& a, V s, const Vec3<V>& b) {
  return {hn::Add(a.x, hn::Mul(s, b.x)), hn::Add(a.y, hn::Mul(s, b.y)), hn::Add(a.z, hn::Mul(s, b.z))};
}
HWY_INLINE Vec3<V> minus(const Vec3<V>& a, V s, const Vec3<V>& b) {
  return {hn::Sub(a.x, hn::Mul(s, b.x)), hn::Sub(a.y, hn::Mul(s, b.y)), hn::Sub(a.z, hn::Mul(s, b.z))};
}
HWY_INLINE Vec3<V> all(Tag d, const Vector3& v) {
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

// To [0, 1]; a NaN becomes 0.
HWY_INLINE V clamped(Tag d, V t) {
  return hn::IfThenElseZero(hn::Gt(t, hn::Zero(d)), hn::Min(t, hn::Set(d, 1.0)));
}

HWY_INLINE hn::Mask<Tag> in_triangle(Tag d, V b, V c) {
  const V zero = hn::Zero(d);
  return hn::And(hn::And(hn::Ge(b, zero), hn::Ge(c, zero)), hn::Le(hn::Add(b, c), hn::Set(d, 1.0)));
}

// A triangle whose corners and edges are taken one by one, and a lane each.
struct Prepared {
  Vector3 corner[3], edge[3];
  Vector3 side;  // from the first corner to the last
  Vector3 normal;

  HWY_INLINE explicit Prepared(const Corners& c)
      : corner{c[0], c[1], c[2]},
        edge{c[1] - c[0], c[2] - c[1], c[0] - c[2]},
        side(c[2] - c[0]),
        normal(snug::cross(edge[0], side)) {}
};

// Corner i + from in lane i, counted round. Made in registers: wide loads have to wait for narrow stores.
HWY_INLINE Vec3<V> corners(Tag d, std::size_t at, const Prepared& t, std::size_t from) {
  static constexpr double number[4] = {0, 1, 2, 3};
  const V lane = hn::LoadU(d, number + at);
  const auto second = hn::Eq(lane, hn::Set(d, 1.0)), third = hn::Eq(lane, hn::Set(d, 2.0));
  const Vector3 &c0 = t.corner[from], &c1 = t.corner[(from + 1) % 3], &c2 = t.corner[(from + 2) % 3];
  const auto pick = [&](double x0, double x1, double x2) HWY_ATTR {
    return hn::IfThenElse(second, hn::Set(d, x1), hn::IfThenElse(third, hn::Set(d, x2), hn::Set(d, x0)));
  };
  return {pick(c0.x, c1.x, c2.x), pick(c0.y, c1.y, c2.y), pick(c0.z, c1.z, c2.z)};
}
HWY_INLINE Vec3<V> edges(Tag d, std::size_t at, const Prepared& t) {
  return sub(corners(d, at, t, 1), corners(d, at, t, 0));
}

constexpr std::size_t width = 4;  // lanes, in one vector or several; the last is the first again

// Barycentrics of points in a triangle's plane, as products with these vectors; not finite if it has no area.
struct Dual {
  Vector3 b, c;
  explicit Dual(const Prepared& t) {
    const double inverse = 1 / length_sq(t.normal);
    b = inverse * snug::cross(t.side, t.normal);
    c = inverse * snug::cross(t.normal, t.edge[0]);
  }
};

// Is the other triangle on one side of this one's plane?
HWY_INLINE bool on_one_side(Tag d, const Prepared& plane, const Prepared& other) {
  bool above = true, below = true;
  for (std::size_t at = 0; at < width; at += hn::Lanes(d)) {
    const V height = dot(all(d, plane.normal), sub(corners(d, at, other, 0), all(d, plane.corner[0])));
    above &= hn::AllTrue(d, hn::Gt(height, hn::Zero(d)));
    below &= hn::AllTrue(d, hn::Lt(height, hn::Zero(d)));
  }
  return above || below;
}

// Where a triangle's edges pass through the inside of a face; `along` is below zero for those that do not.
struct Piercing {
  double along[width], b[width], c[width];
};
HWY_INLINE bool pierce(Tag d, const Prepared& from, const Prepared& face, Piercing& out) {
  const Vec3<V> e1 = all(d, face.edge[0]), e2 = all(d, face.side);
  bool any = false;
  for (std::size_t at = 0; at < width; at += hn::Lanes(d)) {
    const Vec3<V> e = edges(d, at, from);
    const Vec3<V> s = sub(corners(d, at, from, 0), all(d, face.corner[0]));
    const Vec3<V> h = cross(e, e2), q = cross(s, e1);
    const V det = dot(e1, h);  // 0 for parallel ones: quotients are not finite then
    const V b = hn::Div(dot(s, h), det), c = hn::Div(dot(e, q), det), t = hn::Div(dot(e2, q), det);
    const auto on_edge = hn::And(hn::Ge(t, hn::Zero(d)), hn::Le(t, hn::Set(d, 1.0)));
    const auto through = hn::And(on_edge, in_triangle(d, b, c));
    any |= !hn::AllFalse(d, through);
    hn::StoreU(hn::IfThenElse(through, t, hn::Set(d, -1.0)), d, out.along + at);
    hn::StoreU(b, d, out.b + at);
    hn::StoreU(c, d, out.c + at);
  }
  return any;
}

Barycentric on_edge(std::size_t edge, double t) {
  if (edge == 0) return {t, 0};
  if (edge == 1) return {1 - t, t};
  return {0, 1 - t};
}

HWY_INLINE void find_crossings(Tag d, const Prepared& a, const Prepared& b, Crossings& out) {
  Piercing of_a, of_b;
  const bool some_of_a = pierce(d, a, b, of_a), some_of_b = pierce(d, b, a, of_b);
  out.count = 0;
  if (!some_of_a && !some_of_b) return;
  for (std::size_t i = 0; i < 3; ++i) {
    if (of_a.along[i] >= 0) out.points[out.count++] = {on_edge(i, of_a.along[i]), {of_a.b[i], of_a.c[i]}};
    if (of_b.along[i] >= 0) out.points[out.count++] = {{of_b.b[i], of_b.c[i]}, on_edge(i, of_b.along[i])};
  }
}

struct PointV {
  V b, c;
};

// Points of a and of b, and the square of their distance.
struct Best {
  V distance_sq;
  PointV on_a, on_b;

  // A NaN is never taken, and what came first stays.
  HWY_INLINE void offer(const Best& other) {
    const auto nearer = hn::Lt(other.distance_sq, distance_sq);
    distance_sq = hn::IfThenElse(nearer, other.distance_sq, distance_sq);
    on_a = {hn::IfThenElse(nearer, other.on_a.b, on_a.b), hn::IfThenElse(nearer, other.on_a.c, on_a.c)};
    on_b = {hn::IfThenElse(nearer, other.on_b.b, on_b.b), hn::IfThenElse(nearer, other.on_b.c, on_b.c)};
  }
};

// The points of two edges.
struct BestOnEdges {
  V distance_sq, s, t;

  HWY_INLINE void offer(const BestOnEdges& other) {
    const auto nearer = hn::Lt(other.distance_sq, distance_sq);
    distance_sq = hn::IfThenElse(nearer, other.distance_sq, distance_sq);
    s = hn::IfThenElse(nearer, other.s, s);
    t = hn::IfThenElse(nearer, other.t, t);
  }
};

// Foot of corners in the plane of a face, with the square of the distance: infinite where it is not inside.
struct FootV {
  V distance_sq;
  PointV at;
};
HWY_INLINE FootV foot_inside(Tag d, const Vec3<V>& corners, const Prepared& face, const Dual& dual) {
  const Vec3<V> r = sub(corners, all(d, face.corner[0]));
  const V b = dot(all(d, dual.b), r), c = dot(all(d, dual.c), r);
  const Vec3<V> w = minus(minus(r, b, all(d, face.edge[0])), c, all(d, face.side));
  return {hn::IfThenElse(in_triangle(d, b, c), dot(w, w), hn::Set(d, INFINITY)), {b, c}};
}

// Edges q + t f with their squared lengths and the inverses of those.
struct Edges {
  Vec3<V> q, f;
  V ff, inverse;
};

// One edge p + s e of a and edges of b.
HWY_INLINE BestOnEdges nearest_on_edges(Tag d, const Vec3<V>& p, const Vec3<V>& e, V inverse_e,
                                        const Edges& b) {
  const Vec3<V> r = sub(p, b.q);
  const V ee = dot(e, e), ef = dot(e, b.f), er = dot(e, r), fr = dot(b.f, r);
  const V t_at_p = clamped(d, hn::Mul(fr, b.inverse));
  const Vec3<V> from_p = minus(r, t_at_p, b.f);
  BestOnEdges best{dot(from_p, from_p), hn::Zero(d), t_at_p};
  const V s_at_q = clamped(d, hn::Mul(hn::Neg(er), inverse_e));
  const Vec3<V> from_q = plus(r, s_at_q, e);
  best.offer({dot(from_q, from_q), s_at_q, hn::Zero(d)});
  // Of parallel edges this is any pair of points.
  const V across = hn::Sub(hn::Mul(ee, b.ff), hn::Mul(ef, ef));
  const V s = clamped(d, hn::Div(hn::Sub(hn::Mul(ef, fr), hn::Mul(er, b.ff)), across));
  const V t = clamped(d, hn::Mul(hn::Add(hn::Mul(ef, s), fr), b.inverse));
  const Vec3<V> between = minus(plus(r, s, e), t, b.f);
  best.offer({dot(between, between), s, t});
  return best;
}

HWY_INLINE void search(Tag d, const Prepared& a, const Prepared& b, PairOfPoints& out) {
  const Dual dual_a(a), dual_b(b);
  double inverse[width];
  for (std::size_t at = 0; at < width; at += hn::Lanes(d)) {
    const Vec3<V> e = edges(d, at, a);
    hn::StoreU(hn::Div(hn::Set(d, 1.0), dot(e, e)), d, inverse + at);
  }
  double distance_sq[width], a_b[width], a_c[width], b_b[width], b_c[width];
  static constexpr double edge_b[2][width] = {{0, 1, 0, 0}, {1, -1, 0, 1}};  // on_edge() as a product
  static constexpr double edge_c[2][width] = {{0, 0, 1, 0}, {0, 1, -1, 0}};
  for (std::size_t at = 0; at < width; at += hn::Lanes(d)) {
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
    const V from_b = hn::LoadU(d, edge_b[0] + at), along_b = hn::LoadU(d, edge_b[1] + at);
    const V from_c = hn::LoadU(d, edge_c[0] + at), along_c = hn::LoadU(d, edge_c[1] + at);
    const auto on_edges_of_b = [&](V t) HWY_ATTR {
      return PointV{hn::Add(from_b, hn::Mul(t, along_b)), hn::Add(from_c, hn::Mul(t, along_c))};
    };
    const Vec3<V> q = corners(d, at, b, 0), f = edges(d, at, b);
    const V ff = dot(f, f);
    const Edges of_b{q, f, ff, hn::Div(one, ff)};
    const auto with_edge = [&](std::size_t i) HWY_ATTR {
      return nearest_on_edges(d, all(d, a.corner[i]), all(d, a.edge[i]), hn::Set(d, inverse[i]), of_b);
    };
    const BestOnEdges e0 = with_edge(0), e1 = with_edge(1), e2 = with_edge(2);
    Best best{e0.distance_sq, {e0.s, zero}, on_edges_of_b(e0.t)};
    best.offer({e1.distance_sq, {hn::Sub(one, e1.s), e1.s}, on_edges_of_b(e1.t)});
    best.offer({e2.distance_sq, {zero, hn::Sub(one, e2.s)}, on_edges_of_b(e2.t)});
    const FootV on_b = foot_inside(d, corners(d, at, a, 0), b, dual_b), on_a = foot_inside(d, q, a, dual_a);
    best.offer({on_b.distance_sq, {from_b, from_c}, on_b.at});
    best.offer({on_a.distance_sq, on_a.at, {from_b, from_c}});
    hn::StoreU(best.distance_sq, d, distance_sq + at);
    hn::StoreU(best.on_a.b, d, a_b + at);
    hn::StoreU(best.on_a.c, d, a_c + at);
    hn::StoreU(best.on_b.b, d, b_b + at);
    hn::StoreU(best.on_b.c, d, b_c + at);
  }
  std::size_t lane = distance_sq[1] < distance_sq[0] ? 1 : 0;
  lane = distance_sq[2] < distance_sq[lane] ? 2 : lane;
  out = {{a_b[lane], a_c[lane]}, {b_b[lane], b_c[lane]}};
}

Vector3 point_at(const Prepared& t, Barycentric p) { return t.corner[0] + (p.b * t.edge[0] + p.c * t.side); }

// Is it a crossing? Of edges along a face, where quotients are of roundings, points may be anywhere.
bool coincide(const Prepared& a, const Prepared& b, const PairOfPoints& crossing) {
  const Vector3 on_b = point_at(b, crossing.on_b);
  const Vector3 apart = on_b - point_at(a, crossing.on_a);
  // Corners are relative to the first one of a.
  const double size_sq =
      length_sq(on_b) + length_sq(b.edge[0]) + length_sq(b.side) + length_sq(a.edge[0]) + length_sq(a.side);
  return length_sq(apart) <= 0x1p-60 * size_sq;
}

void AllCrossings(const Corners& first, const Corners& second, Crossings& out) {
  const Prepared a(first), b(second);
  find_crossings(Tag(), a, b, out);
  const auto end =
      std::remove_if(out.points.begin(), out.points.begin() + static_cast<std::ptrdiff_t>(out.count),
                     [&](const PairOfPoints& p) { return !coincide(a, b, p); });
  out.count = static_cast<std::size_t>(end - out.points.begin());
}

// Nearest points in double precision, or the first of the crossings if there are any; true then. b >= 0, c >=
// 0 and b + c <= 1 of both points, in doubles. Corners and edges, insides of edges, and corners and faces are
// tried each on their own, without branches.
bool Nearest(const Corners& first, const Corners& second, PairOfPoints& out) {
  const Tag d;
  const Prepared a(first), b(second);
  if (!on_one_side(d, a, b) && !on_one_side(d, b, a)) {
    Crossings found;
    find_crossings(d, a, b, found);
    for (std::size_t i = 0; i < found.count; ++i) {
      if (!coincide(a, b, found.points[i])) continue;
      out = found.points[i];
      return true;
    }
  }
  search(d, a, b, out);
  return false;
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug {
namespace kernels {

HWY_EXPORT(AllCrossings);
HWY_EXPORT(Nearest);

}  // namespace kernels

using namespace kernels;  // for their dispatch

namespace {

using Corners = std::array<Vector3, 3>;

Vector3 at(const Corners& c, Barycentric p) { return c[0] + p.b * (c[1] - c[0]) + p.c * (c[2] - c[0]); }

// Largest coordinate of all corners. No branches on signs, which are as good as random.
double reach_of(const Corners& a, const Corners& b) {
  double reach = 0;
  for (const Corners* corners : {&a, &b}) {
    for (const Vector3& p : *corners) {
      reach = std::max(reach, std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z))));
    }
  }
  return reach;
}

// Lower bound of the distance along the direction w.
double supporting_gap(const Corners& a, const Corners& b, Vector3 w, double reach) {
  // Where squares underflow, w gets shorter.
  const double size = std::sqrt(length_sq(w) + 8 * underflow_error);
  if (!(size > 0) || !std::isfinite(1 / size)) return 0;
  w = (1 / size) * w;
  double highest_a = -INFINITY, lowest_b = INFINITY;
  for (std::size_t k = 0; k < 3; ++k) {
    highest_a = std::max(highest_a, dot(w, a[k]));
    lowest_b = std::min(lowest_b, dot(w, b[k]));
  }
  // |w| <= 1 + 6 u; two dot products of sum |w_i| |x_i| <= 2 reach and a difference.
  const double gap =
      (lowest_b - highest_a) * (1 - 16 * unit_roundoff) - 24 * unit_roundoff * reach - 16 * underflow_error;
  return std::isfinite(gap) ? std::max(0.0, gap) : 0.0;
}

}  // namespace

TriangleParameter clamped(Barycentric weights) {
  const double b = std::clamp(weights.b, 0.0, 1.0);
  const double c = std::clamp(weights.c, 0.0, 1.0 - b);
  return {b, b + c > 1 ? 0 : c};
}

NearestTriangles nearest(const Triangle& first, const Triangle& second) {
  // Relative to one corner: triangles far from the coordinates' origin lose nothing. Each difference errs by
  // half a unit in its last place; the gap is lowered for it below.
  const Point3 origin = first[0];
  const Corners a{Vector3{}, first[1] - origin, first[2] - origin};
  const Corners b{second[0] - origin, second[1] - origin, second[2] - origin};
  PairOfPoints found;
  if (HWY_DYNAMIC_DISPATCH(Nearest)(a, b, found)) return {found.on_a, found.on_b, 0};
  const double reach = reach_of(a, b);
  const double gap = supporting_gap(a, b, at(b, found.on_b) - at(a, found.on_a), reach);
  return {found.on_a, found.on_b, std::max(0.0, gap - 4 * unit_roundoff * reach)};
}

std::optional<PairOfPoints> middle_of_contact(const Triangle& first, const Triangle& second) {
  const Point3 origin = first[0];
  const Corners a{Vector3{}, first[1] - origin, first[2] - origin};
  const Corners b{second[0] - origin, second[1] - origin, second[2] - origin};
  Crossings found;
  HWY_DYNAMIC_DISPATCH(AllCrossings)(a, b, found);
  if (found.count == 0) return std::nullopt;
  PairOfPoints sum;
  double weights = 0;
  for (std::size_t i = 0; i < found.count; ++i) {
    const auto& [on_a, on_b] = found.points[i];
    // Not quite the middle: that lies on lines where pieces are split more often than not.
    const double weight = i == 0 ? 1.0 : 1.1234567;
    sum.on_a = {sum.on_a.b + weight * on_a.b, sum.on_a.c + weight * on_a.c};
    sum.on_b = {sum.on_b.b + weight * on_b.b, sum.on_b.c + weight * on_b.c};
    weights += weight;
  }
  const double share = 1.0 / weights;
  return PairOfPoints{{share * sum.on_a.b, share * sum.on_a.c}, {share * sum.on_b.b, share * sum.on_b.c}};
}

}  // namespace snug
#endif
