// Included after geometry/vector_code-inl.h: no #pragma once, since each instruction set reads it again.
#include <cstddef>

#include <snug/geometry/rounding.h>

#if defined(SNUG_BOUNDS_PLANAR_TRIANGLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SNUG_BOUNDS_PLANAR_TRIANGLE_INL_H
#undef SNUG_BOUNDS_PLANAR_TRIANGLE_INL_H
#else
#define SNUG_BOUNDS_PLANAR_TRIANGLE_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {

template <class V>
HWY_INLINE V hypotenuse_sq(V a, V b) {
  return hn::Add(hn::Mul(a, a), hn::Mul(b, b));
}
template <class V>
HWY_INLINE V max3(V a, V b, V c) {
  return hn::Max(a, hn::Max(b, c));
}

// A triangle in a frame (t1, t2, n) of its own: corners (0, 0), (l0, 0), (xc, yc), counter-clockwise. Names
// and the error terms are those of derivations/rounding.md, "Distance in the triangle's plane".
template <class V>
struct PlanarTriangle {
  Vec3<V> a, t1, t2, n;
  V l0, l1, l2;  // lengths of the edges ab, bc, ca
  V xc, yc;
  V d1x, d1y, d2x, d2y;  // directions of bc and of ac
  V longest;
  V deviation;  // of the true corners from those in the plane
  V amplify;    // 2 / the least sine of an angle: at least 1 / sin of half the sharpest angle
  V stretch;    // of lengths by the frame, at most
};

// Of l0, xc, yc.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void find_edges(D d, PlanarTriangle<V>& t) {
  const V one = hn::Set(d, hn::TFromD<D>(1)), bx = hn::Sub(t.xc, t.l0);
  t.l1 = hn::Sqrt(hypotenuse_sq(bx, t.yc));
  t.l2 = hn::Sqrt(hypotenuse_sq(t.xc, t.yc));
  const V over_l1 = hn::Div(one, t.l1), over_l2 = hn::Div(one, t.l2);
  t.d1x = hn::Mul(bx, over_l1);
  t.d1y = hn::Mul(t.yc, over_l1);
  t.d2x = hn::Mul(t.xc, over_l2);
  t.d2y = hn::Mul(t.yc, over_l2);
  t.longest = max3(t.l0, t.l1, t.l2);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE PlanarTriangle<V> planar_triangle(D d, const Vec3<V>& a, const Vec3<V>& b, const Vec3<V>& c) {
  PlanarTriangle<V> t;
  const V one = hn::Set(d, 1.0);
  const Vec3<V> eb = sub(b, a), ec = sub(c, a);
  const Vec3<V> area = cross(eb, ec);
  t.a = a;
  t.n = scaled(hn::Div(one, hn::Sqrt(dot(area, area))), area);
  t.t1 = scaled(hn::Div(one, hn::Sqrt(dot(eb, eb))), eb);
  t.t2 = cross(t.n, t.t1);
  t.l0 = dot(t.t1, eb);
  t.xc = dot(t.t1, ec);
  t.yc = dot(t.t2, ec);
  find_edges(d, t);
  const V off_b = hn::Add(hn::Abs(dot(t.t2, eb)), hn::Abs(dot(t.n, eb)));
  t.deviation =
      hn::Add(hn::Max(off_b, hn::Abs(dot(t.n, ec))), hn::Mul(hn::Set(d, 16 * unit_roundoff), t.longest));
  const V products = max3(hn::Mul(t.l0, t.l1), hn::Mul(t.l1, t.l2), hn::Mul(t.l2, t.l0));
  t.amplify = hn::Div(hn::Add(products, products), hn::Mul(t.l0, t.yc));
  const V diagonal = max3(hn::Abs(hn::Sub(dot(t.t1, t.t1), one)), hn::Abs(hn::Sub(dot(t.t2, t.t2), one)),
                          hn::Abs(hn::Sub(dot(t.n, t.n), one)));
  const V mixed =
      hn::Add(hn::Add(hn::Abs(dot(t.t1, t.t2)), hn::Abs(dot(t.t1, t.n))), hn::Abs(dot(t.t2, t.n)));
  t.stretch = hn::Add(hn::Add(diagonal, mixed), hn::Set(d, 16 * unit_roundoff));
  return t;
}

// False for needles and whatever is not finite. Of a needle in a coordinate plane rounding may turn the
// normal round: then the third corner's yc, and with it `amplify`, is negative.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> well_shaped(D d, const PlanarTriangle<V>& t) {
  const V zero = hn::Zero(d);
  const auto turned = hn::And(hn::Gt(t.amplify, zero), hn::Gt(t.l0, zero));
  const auto round = hn::And(hn::Le(t.amplify, hn::Set(d, 64.0)), turned);
  return hn::And(round, hn::Le(t.stretch, hn::Set(d, 0x1p-40)));
}

// A point in the triangle's frame, and the signed distances of its foot from the edges, positive outside.
template <class V>
struct Foot {
  V x, y, height_sq;
  V s0, s1, s2;
};

// Of a point with coordinates x, y, h in the frame.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Foot<V> foot_of(D d, const PlanarTriangle<V>& t, V x, V y, V h) {
  return {x,
          y,
          hn::Mul(h, h),
          hn::Sub(hn::Zero(d), y),
          hn::Sub(hn::Mul(hn::Sub(x, t.l0), t.d1y), hn::Mul(y, t.d1x)),
          hn::Sub(hn::Mul(y, t.d2x), hn::Mul(x, t.d2y))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Foot<V> foot(D d, const PlanarTriangle<V>& t, const Vec3<V>& p) {
  const Vec3<V> r = sub(p, t.a);
  return foot_of(d, t, dot(t.t1, r), dot(t.t2, r), dot(t.n, r));
}

// Squared distance in the plane from edge 0, 1 or 2.
template <std::size_t edge, class D, class V = hn::Vec<D>>
HWY_INLINE V aside_sq(D d, const PlanarTriangle<V>& t, const Foot<V>& f) {
  // How far the foot lies beyond either end of the edge.
  const V zero = hn::Zero(d), xb = hn::Sub(f.x, t.l0);
  if constexpr (edge == 0) return hypotenuse_sq(f.s0, max3(zero, xb, hn::Sub(zero, f.x)));
  if constexpr (edge == 1) {
    const V along = hn::Add(hn::Mul(xb, t.d1x), hn::Mul(f.y, t.d1y));
    return hypotenuse_sq(f.s1, max3(zero, hn::Sub(along, t.l1), hn::Sub(zero, along)));
  }
  const V along = hn::Add(hn::Mul(f.x, t.d2x), hn::Mul(f.y, t.d2y));
  return hypotenuse_sq(f.s2, max3(zero, hn::Sub(along, t.l2), hn::Sub(zero, along)));
}

// The square of the distance, but for the height's own error if place and edges are off by `margin` at most. By the edge that the foot is
// farthest outside of: any edge is right, this one nearest but for feet beyond obtuse corners.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V distance_sq(D d, const PlanarTriangle<V>& t, const Foot<V>& f, V margin) {
  const V zero = hn::Zero(d), within = hn::Sub(zero, margin);
  const V across = hn::Max(f.s1, f.s2), farthest = hn::Max(f.s0, across);
  const auto outside = hn::Gt(farthest, within);
  if (hn::AllFalse(d, outside)) return f.height_sq;
  const V along_one = hn::Add(hn::Mul(hn::Sub(f.x, t.l0), t.d1x), hn::Mul(f.y, t.d1y)),
          along_two = hn::Add(hn::Mul(f.x, t.d2x), hn::Mul(f.y, t.d2y));
  const auto one = hn::Gt(f.s1, f.s2), first = hn::Gt(f.s0, across);
  const V along = hn::IfThenElse(first, f.x, hn::IfThenElse(one, along_one, along_two)),
          length = hn::IfThenElse(first, t.l0, hn::IfThenElse(one, t.l1, t.l2));
  const V beyond = hn::Add(max3(hn::Sub(along, length), hn::Sub(zero, along), within), margin);
  return hn::Add(f.height_sq, hn::IfThenElseZero(outside, hypotenuse_sq(hn::Add(farthest, margin), beyond)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V distance_sq(D d, const PlanarTriangle<V>& t, const Foot<V>& f) {
  return distance_sq(d, t, f, hn::Zero(d));
}

// The same sooner for points that are rarely outside of other edges than one.
template <std::size_t edge, class D, class V = hn::Vec<D>>
HWY_INLINE V distance_sq_by_edge(D d, const PlanarTriangle<V>& t, const Foot<V>& f) {
  const V zero = hn::Zero(d);
  const V own = edge == 0 ? f.s0 : edge == 1 ? f.s1 : f.s2;
  const auto others = hn::Gt(hn::Max(edge == 0 ? f.s1 : f.s0, edge == 2 ? f.s1 : f.s2), zero);
  const V by_edge = hn::Add(f.height_sq, hn::IfThenElseZero(hn::Gt(own, zero), aside_sq<edge>(d, t, f)));
  if (hn::AllFalse(d, others)) return by_edge;
  return hn::IfThenElse(others, distance_sq(d, t, f), by_edge);
}

template <class V>
struct ReachV {
  V distance, rounding;
};

// `more`: what points and triangle are off by in the frame beside the roundings of the distance itself.
template <class D, class V = hn::Vec<D>>
HWY_INLINE ReachV<V> reach_of(D d, const PlanarTriangle<V>& t, V farthest_sq, V more) {
  const V far = hn::Sqrt(hn::Add(farthest_sq, hn::Set(d, 8 * underflow_error)));
  const V size = hn::Add(far, hn::Add(t.longest, t.longest));
  const V factor = hn::Add(hn::Set(d, 8.0), hn::Mul(hn::Set(d, 48.0), t.amplify));
  const V measuring = hn::Mul(hn::Mul(hn::Set(d, unit_roundoff), factor), size);
  const V rounding = hn::Add(hn::Add(t.deviation, more), measuring);
  const V one = hn::Set(d, 1.0);
  return {hn::Mul(hn::Add(far, rounding), hn::Add(one, t.stretch)), rounding};
}

}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
