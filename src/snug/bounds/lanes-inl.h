// Included after geometry/vector_code-inl.h: no #pragma once, since each instruction set reads it again.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/geometry.h>
#include <snug/geometry/rounding.h>
#include <snug/mesh.h>
#include <snug/scheme/stencils.h>

#if defined(SNUG_BOUNDS_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SNUG_BOUNDS_LANES_INL_H
#undef SNUG_BOUNDS_LANES_INL_H
#else
#define SNUG_BOUNDS_LANES_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {

/// Points, a lane a patch: three coordinates of each in a row.
template <class T>
struct LanesOf {
  T* first;
  std::size_t lanes;
  [[nodiscard]] T* at(std::size_t i, std::size_t axis) const { return first + (3 * i + axis) * lanes; }
};
using Lanes = LanesOf<double>;

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> load(D d, const LanesOf<hn::TFromD<D>>& points, std::size_t i) {
  return {hn::Load(d, points.at(i, 0)), hn::Load(d, points.at(i, 1)), hn::Load(d, points.at(i, 2))};
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store(D d, const Vec3<V>& p, const LanesOf<hn::TFromD<D>>& points, std::size_t i) {
  hn::Store(p.x, d, points.at(i, 0));
  hn::Store(p.y, d, points.at(i, 1));
  hn::Store(p.z, d, points.at(i, 2));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> zero3(D d) {
  return {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE void add_scaled(D d, hn::TFromD<D> weight, const Vec3<V>& p, Vec3<V>& sum) {
  sum = add(sum, scaled(hn::Set(d, weight), p));
}

/// A number in all lanes, rounded to nearest.
template <class D>
HWY_INLINE hn::Vec<D> number(D d, double x) {
  return hn::Set(d, static_cast<hn::TFromD<D>>(x));
}
/// Above, whatever its rounding: of bounds that are not near the ends of the range.
template <class D>
HWY_INLINE hn::Vec<D> above(D d, double x) {
  return number(d, x * (1 + 8 * roundoff_of<hn::TFromD<D>>));
}

/// A row times points, of which source i is number name(i).
template <class D, class Rows, class Name, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> product(D d, const Rows& rows, std::size_t r, const LanesOf<hn::TFromD<D>>& control,
                           const Name& name) {
  const auto row = rows.row(r);
  const auto source = [&](std::size_t i) HWY_ATTR {
    const hn::TFromD<D>* const at = control.first + 3 * hn::Lanes(d) * name(row.sources[i]);
    return Vec3<V>{hn::Load(d, at), hn::Load(d, at + hn::Lanes(d)), hn::Load(d, at + 2 * hn::Lanes(d))};
  };
  Vec3<V> sum = scaled(hn::Set(d, row.weights[0]), source(0));
  for (std::size_t i = 1; i < row.sources.size(); ++i) add_scaled(d, row.weights[i], source(i), sum);
  return sum;
}
template <class D, class Rows, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> product(D d, const Rows& rows, std::size_t r, const LanesOf<hn::TFromD<D>>& control) {
  return product(d, rows, r, control, [](std::uint32_t source) { return source; });
}

/// Doubles to numbers of another type, rounded to nearest, and back: as many as a vector of doubles has.
template <class D, class T, class V = hn::Vec<D>>
HWY_INLINE void store_as(D d, V v, T* to) {
  if constexpr (sizeof(T) == sizeof(double)) {
    hn::Store(v, d, to);
  } else {
    const hn::Rebind<T, D> other;
    hn::Store(hn::DemoteTo(other, v), other, to);
  }
}
template <class D, class T, class V = hn::Vec<D>>
HWY_INLINE V load_as(D d, const T* from) {
  if constexpr (sizeof(T) == sizeof(double)) {
    return hn::Load(d, from);
  } else {
    return hn::PromoteTo(d, hn::Load(hn::Rebind<T, D>(), from));
  }
}

/// A block of numbers for vectors, as large as it ever was on this thread.
template <class T = double>
T* aligned_memory(std::size_t count) {
  thread_local std::vector<T> memory;
  memory.resize(std::max(memory.size(), count + HWY_MAX_BYTES / sizeof(T)));
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(memory.data());
  return memory.data() + (HWY_MAX_BYTES - address % HWY_MAX_BYTES) % HWY_MAX_BYTES / sizeof(T);
}

/// Control points [from, to) of the next `lanes` patches, for vectors with a patch a lane: coordinate a of
/// control point i of patch l at out[(3 (i - from) + a) lanes + l]. Lanes beyond the `here` patches that are
/// left repeat the last one.
///
/// Requires:  control: `count` vertices a patch, from the first of these patches on; 0 < here <= lanes.
HWY_INLINE void gather_lanes(std::span<const Point3> points, const VertexId* control, std::size_t count,
                             std::size_t from, std::size_t to, std::size_t here, std::size_t lanes,
                             double* HWY_RESTRICT out) {
  const auto of_lane = [&](std::size_t l) { return control + count * std::min(l, here - 1); };
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t l = 0; l < lanes; ++l) {
    const VertexId* const index = of_lane(l);
    double* at = out + l;
    for (std::size_t i = from; i < to; ++i) {
      const Point3& p = points[index[i].index()];
      at[0] = p.x;
      at[lanes] = p.y;
      at[2 * lanes] = p.z;
      at += 3 * lanes;
    }
  }
#else
  const hn::FixedTag<double, 2> d;
  for (std::size_t l = 0; l < lanes; l += 2) {
    const VertexId *const even = of_lane(l), *const odd = of_lane(l + 1);
    double* at = out + l;
    for (std::size_t i = from; i < to; ++i) {
      const double* const p = &points[even[i].index()].x;
      const double* const q = &points[odd[i].index()].x;
      const auto xy = hn::LoadU(d, p), other_xy = hn::LoadU(d, q);
      hn::Store(hn::InterleaveLower(d, xy, other_xy), d, at);
      hn::Store(hn::InterleaveUpper(d, xy, other_xy), d, at + lanes);
      hn::Store(hn::InterleaveLower(d, hn::Set(d, p[2]), hn::Set(d, q[2])), d, at + 2 * lanes);
      at += 3 * lanes;
    }
  }
#endif
}

/// Answers from lanes: coordinate a of corner k of patch l at lane[(3 k + a) lanes + l], radii, roundings.
HWY_INLINE void scatter_lanes(const double* lane, std::size_t lanes, std::span<OffsetTriangle> out) {
  for (std::size_t l = 0; l < out.size(); ++l) {
    const double* from = lane + l;
    for (Point3& corner : out[l].base) {
      corner = {from[0], from[lanes], from[2 * lanes]};
      from += 3 * lanes;
    }
    out[l].radius = from[0];
    out[l].rounding = from[lanes];
  }
}

/// The same from vectors: three corners, radii, roundings.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void hand_out(D d, const Vec3<V>* corner, V radius, V rounding, std::span<OffsetTriangle> out) {
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN double lane[11 * HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t k = 0; k < 3; ++k) {
    hn::Store(corner[k].x, d, lane + 3 * k * lanes);
    hn::Store(corner[k].y, d, lane + (3 * k + 1) * lanes);
    hn::Store(corner[k].z, d, lane + (3 * k + 2) * lanes);
  }
  hn::Store(radius, d, lane + 9 * lanes);
  hn::Store(rounding, d, lane + 10 * lanes);
  scatter_lanes(lane, lanes, out);
}

}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
