#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/geometry/quadratic_distance.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <cmath>

#include <snug/geometry/quadratic_distance.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

using Flat = hn::CappedTag<float, 8>;
using F = hn::Vec<Flat>;

constexpr std::size_t triangles = 16;
constexpr float side = 0.25F;
// The first corner of each triangle, and whether its sides lead from there along the parameters or against them.
HWY_ALIGN constexpr float first_u[triangles] = {0,     0.25F, 0.5F,  0.75F, 0,     0.25F, 0.5F, 0,
                                                0.25F, 0,     0.25F, 0.5F,  0.75F, 0.25F, 0.5F, 0.25F};
HWY_ALIGN constexpr float first_v[triangles] = {0,    0,     0,     0,     0.25F, 0.25F, 0.25F, 0.5F,
                                                0.5F, 0.75F, 0.25F, 0.25F, 0.25F, 0.5F,  0.5F,  0.75F};
HWY_ALIGN constexpr float along[triangles] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1, -1};

HWY_INLINE F times(Flat d, float a, F b) { return hn::Mul(hn::Set(d, a), b); }
HWY_INLINE Vec3<F> combined(const Vec3<F>& a, F s, const Vec3<F>& b, F t, const Vec3<F>& c) {
  return {hn::Add(hn::Add(a.x, hn::Mul(s, b.x)), hn::Mul(t, c.x)),
          hn::Add(hn::Add(a.y, hn::Mul(s, b.y)), hn::Mul(t, c.y)),
          hn::Add(hn::Add(a.z, hn::Mul(s, b.z)), hn::Mul(t, c.z))};
}
// To [0, 1]; what is not a number becomes 0.
HWY_INLINE F to_unit(Flat d, F t) {
  return hn::IfThenElseZero(hn::Gt(t, hn::Zero(d)), hn::Min(t, hn::Set(d, 1.0F)));
}

// A coordinate of the quadratic less the point's, in powers: c + c_u u + c_v v + c_uu u u + c_uv u v + c_vv v v.
struct Powers {
  float c, u, v, uu, uv, vv;
  Powers(const float* net, std::size_t axis, float point) {
    const auto q = [&](std::size_t k) { return net[3 * k + axis]; };
    c = q(0) - point;
    u = 2 * (q(3) - q(0));
    v = 2 * (q(5) - q(0));
    uu = (q(0) - q(3)) + (q(1) - q(3));
    vv = (q(0) - q(5)) + (q(2) - q(5));
    uv = 2 * ((q(0) - q(3)) + (q(4) - q(5)));
  }
};

// Of some of the triangles: the plane's height, the distance of a point, and its weights.
struct Found {
  F low, far, b, c;
};

HWY_INLINE Found compare(std::size_t at, const Powers* powers) {
  const Flat d;
  const F u = hn::Load(d, first_u + at), v = hn::Load(d, first_v + at), sign = hn::Load(d, along + at);
  const F step = times(d, side, sign);
  F corner[3], ab[3], ac[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const Powers& p = powers[k];
    const F by_u = hn::Add(hn::Set(d, p.u), hn::Add(times(d, p.uu, u), times(d, p.uv, v)));
    const F by_v = hn::Add(hn::Set(d, p.v), times(d, p.vv, v));
    corner[k] = hn::Add(hn::Set(d, p.c), hn::Add(hn::Mul(u, by_u), hn::Mul(v, by_v)));
    ab[k] = hn::Add(hn::Mul(step, hn::Add(by_u, times(d, p.uu, u))), hn::Set(d, side * side * p.uu));
    ac[k] = hn::Add(hn::Mul(step, hn::Add(hn::Add(by_v, times(d, p.vv, v)), times(d, p.uv, u))),
                    hn::Set(d, side * side * p.vv));
  }
  const Vec3<F> a{corner[0], corner[1], corner[2]}, e{ab[0], ab[1], ab[2]}, f{ac[0], ac[1], ac[2]};
  const F ee = dot(e, e), ff = dot(f, f), ef = dot(e, f);
  const F by_e = hn::Neg(dot(e, a)), by_f = hn::Neg(dot(f, a));
  const F zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  // Squared distances less that of the corner.
  const auto on_side = [&](F t, F by, F sq)
                           HWY_ATTR { return hn::Mul(t, hn::Sub(hn::Mul(t, sq), hn::Add(by, by))); };
  const F gg = hn::Add(hn::Sub(ee, hn::Add(ef, ef)), ff),
          by_g = hn::Add(hn::Sub(by_f, by_e), hn::Sub(ee, ef));
  const F eeff = hn::Mul(ee, ff), det = hn::Sub(eeff, hn::Mul(ef, ef));
  // Four quotients by two divisions. Where products underflow points are not the nearest ones, and bounds hold.
  const F over_sides = hn::Div(one, eeff), over_others = hn::Div(one, hn::Mul(gg, det));
  const F on_e = to_unit(d, hn::Mul(by_e, hn::Mul(ff, over_sides))),
          on_f = to_unit(d, hn::Mul(by_f, hn::Mul(ee, over_sides)));
  F b = on_e, c = zero, least = on_side(on_e, by_e, ee);
  const F by_side = on_side(on_f, by_f, ff);
  const auto second = hn::Lt(by_side, least);
  least = hn::IfThenElse(second, by_side, least);
  b = hn::IfThenZeroElse(second, b);
  c = hn::IfThenElse(second, on_f, c);
  const F on_g = to_unit(d, hn::Mul(by_g, hn::Mul(det, over_others)));
  const F from_end = hn::Add(hn::Sub(ee, hn::Add(by_e, by_e)), on_side(on_g, by_g, gg));
  const auto third = hn::Lt(from_end, least);
  b = hn::IfThenElse(third, hn::Sub(one, on_g), b);
  c = hn::IfThenElse(third, on_g, c);
  const F over_det = hn::Mul(gg, over_others);
  const F in_b = hn::Mul(hn::Sub(hn::Mul(ff, by_e), hn::Mul(ef, by_f)), over_det),
          in_c = hn::Mul(hn::Sub(hn::Mul(ee, by_f), hn::Mul(ef, by_e)), over_det);
  const auto inside =
      hn::And(hn::And(hn::Ge(in_b, zero), hn::Ge(in_c, zero)), hn::Le(hn::Add(in_b, in_c), one));
  b = hn::IfThenElse(inside, in_b, b);
  c = hn::IfThenElse(inside, in_c, c);
  // A point of the triangle, wherever it is; and the plane across the way there, beyond which all of it lies.
  const Vec3<F> to = combined(a, b, e, c, f);
  const F far = hn::Sqrt(dot(to, to));
  const F height = hn::Add(dot(to, a), hn::Min(zero, hn::Min(dot(to, e), dot(to, f))));
  const F low = hn::IfThenElse(hn::Gt(far, hn::Set(d, 0x1p-60F)), hn::Div(height, far), zero);
  return {low, far, b, c};
}

FlattenedDistance Flattened(const float* net, const float* point) {
  const Flat d;
  const std::size_t lanes = hn::Lanes(d);
  const Powers powers[3] = {{net, 0, point[0]}, {net, 1, point[1]}, {net, 2, point[2]}};
  HWY_ALIGN float fars[triangles], bs[triangles], cs[triangles];
  F low = hn::Set(d, INFINITY), far = low;
  for (std::size_t at = 0; at < triangles; at += lanes) {
    const Found found = compare(at, powers);
    low = hn::Min(low, found.low);
    far = hn::Min(far, found.far);
    hn::Store(found.far, d, fars + at);
    hn::Store(found.b, d, bs + at);
    hn::Store(found.c, d, cs + at);
  }
  const F nearest = hn::MinOfLanes(d, far);
  std::size_t t = 0;
  for (std::size_t at = triangles; at > 0;) {
    at -= lanes;
    const std::intptr_t first = hn::FindFirstTrue(d, hn::Eq(hn::Load(d, fars + at), nearest));
    if (first >= 0) t = at + static_cast<std::size_t>(first);
  }
  const float step = side * along[t];
  return {hn::GetLane(hn::MinOfLanes(d, low)),
          hn::GetLane(nearest),
          {static_cast<double>(first_u[t] + step * bs[t]), static_cast<double>(first_v[t] + step * cs[t])}};
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug {
namespace kernels {

HWY_EXPORT(Flattened);

}  // namespace kernels

FlattenedDistance flattened_distance(const float* net, const float point[3]) {
  using namespace kernels;
  return HWY_DYNAMIC_DISPATCH(Flattened)(net, point);
}

}  // namespace snug
#endif
