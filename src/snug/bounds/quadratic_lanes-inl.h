// Included after bounds/planar_triangle-inl.h: no #pragma once, since each instruction set reads it again.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#if defined(SNUG_BOUNDS_QUADRATIC_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SNUG_BOUNDS_QUADRATIC_LANES_INL_H
#undef SNUG_BOUNDS_QUADRATIC_LANES_INL_H
#else
#define SNUG_BOUNDS_QUADRATIC_LANES_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {

template <class V>
HWY_INLINE V largest_of(const Vec3<V>& v) {
  return max3(hn::Abs(v.x), hn::Abs(v.y), hn::Abs(v.z));
}

// Corners and middles of edges in the frame.
template <class V>
struct QuadraticV {
  Vec3<V> q[6];
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE QuadraticV<V> restricted(D d, const QuadraticV<V>& whole,
                                    const std::array<std::array<hn::TFromD<D>, 6>, 6>& weights) {
  QuadraticV<V> part;
  for (std::size_t k = 0; k < 6; ++k) {
    part.q[k] = zero3(d);
    for (std::size_t i = 0; i < 6; ++i) add_scaled(d, weights[k][i], whole.q[i], part.q[k]);
  }
  return part;
}

// Bounds of differences: whatever the direction, and along the one across the quadratic.
template <class V>
struct ApartV {
  V any, along;
};

// Numbers of parts or patches as lanes; lanes beyond them repeat the last.
template <class D, class Of, class V = hn::Vec<D>>
HWY_INLINE V lanes_of(D d, std::size_t here, const Of& of) {
  HWY_ALIGN double lane[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t l = 0; l < hn::Lanes(d); ++l) lane[l] = of(std::min(l, here - 1));
  return hn::Load(d, lane);
}
template <class D, class Of, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> lanes3_of(D d, std::size_t here, const Of& of) {
  HWY_ALIGN double lane[3 * HWY_MAX_BYTES / sizeof(double)];
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t l = 0; l < lanes; ++l) {
    const Vector3& v = of(std::min(l, here - 1));
    lane[l] = v.x;
    lane[lanes + l] = v.y;
    lane[2 * lanes + l] = v.z;
  }
  return {hn::Load(d, lane), hn::Load(d, lane + lanes), hn::Load(d, lane + 2 * lanes)};
}
template <class D, class To, class V = hn::Vec<D>>
HWY_INLINE void hand_out(D d, std::size_t here, V v, const To& to) {
  HWY_ALIGN double lane[HWY_MAX_BYTES / sizeof(double)];
  hn::Store(v, d, lane);
  for (std::size_t l = 0; l < here; ++l) to(l) = lane[l];
}
template <class D, class To, class V = hn::Vec<D>>
HWY_INLINE void hand_out(D d, std::size_t here, const Vec3<V>& v, const To& to) {
  HWY_ALIGN double lane[3 * HWY_MAX_BYTES / sizeof(double)];
  const std::size_t lanes = hn::Lanes(d);
  hn::Store(v.x, d, lane);
  hn::Store(v.y, d, lane + lanes);
  hn::Store(v.z, d, lane + 2 * lanes);
  for (std::size_t l = 0; l < here; ++l) to(l) = {lane[l], lane[lanes + l], lane[2 * lanes + l]};
}

// The control points of parts.
template <class PatchOf>
HWY_INLINE void gather(std::size_t here, const PatchOf& patch_of, const Lanes& to) {
  for (std::size_t l = 0; l < to.lanes; ++l) {
    double* at = to.first + l;
    for (const Vector3& p : patch_of(std::min(l, here - 1)).points) {
      at[0] = p.x;
      at[to.lanes] = p.y;
      at[2 * to.lanes] = p.z;
      at += 3 * to.lanes;
    }
  }
}

// Bounds of the points whose hull contains a part, in its patch's frame. `margin`: of distance_sq().
template <class D, class V = hn::Vec<D>>
class HullV {
 public:
  HWY_INLINE HullV(D d, const PlanarTriangle<V>& t, V axis_x, V axis_y, V middle, const Vec3<V>& across,
                   V margin)
      : direction(across), d_(d), t_(t), axis_x_(axis_x), axis_y_(axis_y), middle_(middle), margin_(margin) {
    far_sq = most_sq = most_along = hn::Zero(d);
    for (std::size_t a = 0; a < 3; ++a) {
      lower[a] = number(d, INFINITY);
      upper[a] = number(d, -INFINITY);
    }
  }
  // A Bezier point; `weight(k)`: of point k of the quadratic in that of the raised one.
  template <class Weight>
  HWY_INLINE void add(const Weight& weight, const QuadraticV<V>& quadratic, const Vec3<V>& p) {
    const Vec3<V> at = along_axes(p);
    lower[0] = hn::Min(lower[0], at.x), upper[0] = hn::Max(upper[0], at.x);
    lower[1] = hn::Min(lower[1], at.y), upper[1] = hn::Max(upper[1], at.y);
    lower[2] = hn::Min(lower[2], at.z), upper[2] = hn::Max(upper[2], at.z);
    far_sq = hn::Max(far_sq, distance_sq_of(p));
    Vec3<V> rest = p;
    for (std::size_t k = 0; k < 6; ++k) {
      rest = sub(rest, scaled(hn::Set(d_, weight(k)), quadratic.q[k]));
    }
    most_sq = hn::Max(most_sq, dot(rest, rest));
    most_along = hn::Max(most_along, hn::Abs(dot(direction, rest)));
  }

  // Along an axis in the plane, across it, along the normal.
  HWY_INLINE Vec3<V> along_axes(const Vec3<V>& p) const {
    return {hn::Add(hn::Mul(axis_x_, p.x), hn::Mul(axis_y_, p.y)),
            hn::Sub(hn::Mul(axis_x_, p.y), hn::Mul(axis_y_, p.x)), p.z};
  }
  HWY_INLINE V distance_sq_of(const Vec3<V>& p) const {
    return distance_sq(d_, t_, foot_of(d_, t_, p.x, p.y, hn::Sub(p.z, middle_)), margin_);
  }

  const Vec3<V> direction;
  V lower[3], upper[3];  // along_axes()
  V far_sq;              // from the base
  V most_sq, most_along;

 private:
  D d_;
  const PlanarTriangle<V>& t_;
  V axis_x_, axis_y_, middle_, margin_;
};

}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
