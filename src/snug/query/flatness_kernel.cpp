#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/query/flatness_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <snug/geometry/rounding.h>
#include <snug/query/flatness_kernel.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

// Squares, products and sums lose less than this by underflow.
constexpr double tiny = 0x1p-500;

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> load(D d, const FlatnessLanes::Row* row, std::size_t l) {
  return {hn::Load(d, row[0] + l), hn::Load(d, row[1] + l), hn::Load(d, row[2] + l)};
}

template <class V>
HWY_INLINE V max_abs(const Vec3<V>& a) {
  return hn::Max(hn::Max(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
}

// The difference is a quadratic over the triangle with the Bezier points gap_k and, between them, the middle of
// two gaps less twice the bow of the side: the middle of its chord less its curve. Split once in four it lies in the hull of the points below.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void flatness_from(D d, FlatnessLanes& flat, std::size_t l) {
  const Vec3<V> origin = load(d, flat.origin, l), u = load(d, flat.u, l), v = load(d, flat.v, l),
                uu = load(d, flat.uu, l), uv = load(d, flat.uv, l), vv = load(d, flat.vv, l);
  const auto times = [&](double s, V x) HWY_ATTR { return hn::Mul(hn::Set(d, s), x); };
  // Of the coefficients' terms, whose roundings are in them.
  V size = hn::Add(hn::Add(hn::Add(times(9, hn::Add(max_abs(u), max_abs(v))), max_abs(uu)), max_abs(vv)),
                   times(4, max_abs(uv)));
  // Not a number where one of these is not finite: maxima may pass over that.
  const auto total = [](const Vec3<V>& a) HWY_ATTR { return hn::Add(hn::Add(a.x, a.y), a.z); };
  V sum = total(add(add(add(origin, u), add(v, uu)), add(uv, vv)));
  V at_u[3], at_v[3], gap_sq = hn::Zero(d);
  Vec3<V> gap[3], middle[3], middles;
  for (std::size_t k = 0; k < 3; ++k) {
    at_u[k] = hn::Load(d, flat.at[k][0] + l);
    at_v[k] = hn::Load(d, flat.at[k][1] + l);
    const Vec3<V> off = sub(load(d, flat.corner[k], l), origin);
    size = hn::Max(size, max_abs(off));
    sum = hn::Add(sum, total(off));
    const Vec3<V> curve = add(scaled(at_u[k], add(add(u, scaled(at_u[k], uu)), scaled(at_v[k], uv))),
                              scaled(at_v[k], add(v, scaled(at_v[k], vv))));
    gap[k] = sub(curve, off);
    gap_sq = hn::Max(gap_sq, dot(gap[k], gap[k]));
  }
  const V half = hn::Set(d, 0.5), quarter = hn::Set(d, 0.25);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const V du = hn::Sub(at_u[next], at_u[k]), dv = hn::Sub(at_v[next], at_v[k]);
    const Vec3<V> bow_twice = scaled(half, add(add(scaled(hn::Mul(du, du), uu), scaled(hn::Mul(du, dv), uv)),
                                               scaled(hn::Mul(dv, dv), vv)));
    middle[k] = sub(scaled(half, add(gap[k], gap[next])), bow_twice);
    middles = k == 0 ? middle[0] : add(middles, middle[k]);
  }
  V sq = gap_sq;
  const auto see = [&](V share, const Vec3<V>& a, const Vec3<V>& b) HWY_ATTR {
    const Vec3<V> point = scaled(share, add(a, b));
    sq = hn::Max(sq, dot(point, point));
  };
  for (std::size_t k = 0; k < 3; ++k) {
    see(half, gap[k], middle[k]);
    see(half, gap[k], middle[(k + 2) % 3]);
    see(quarter, gap[k], middles);
  }
  hn::Store(hn::Sqrt(gap_sq), d, flat.corner_gap + l);
  const V rounding = hn::Add(times(spatial_error(gamma_bound(64) * 4), size), hn::Set(d, tiny)),
          error = hn::Add(hn::Add(hn::Sqrt(sq), hn::Load(d, flat.error + l)),
                          hn::Add(rounding, hn::Sub(sum, sum)));
  // As enlarged().
  hn::Store(hn::Add(times(1 + 0x1p-42, error), hn::Set(d, underflow_error)), d, flat.error + l);
}

void Flatness(FlatnessLanes& flat) {
  const hn::CappedTag<double, FlatnessLanes::count> d;
  for (std::size_t l = 0; l < FlatnessLanes::count; l += hn::Lanes(d)) flatness_from(d, flat, l);
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(Flatness);

void flatness(FlatnessLanes& flat) { HWY_DYNAMIC_DISPATCH(Flatness)(flat); }

}  // namespace snug::kernels
#endif
