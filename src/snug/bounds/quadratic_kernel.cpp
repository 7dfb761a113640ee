#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/quadratic_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <cmath>

#include <snug/bounds/fit_kernels.h>
#include <snug/geometry/rounding.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

// Point r less the weighted sum.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> difference(D d, const Coordinates& points, const double* weights, std::size_t rows,
                              const std::array<Vector3, 6>& q, std::size_t r) {
  Vec3<V> rest{hn::LoadU(d, points.x + r), hn::LoadU(d, points.y + r), hn::LoadU(d, points.z + r)};
  for (std::size_t k = 0; k < 6; ++k) {
    const V w = hn::LoadU(d, weights + k * rows + r);
    rest.x = hn::Sub(rest.x, hn::Mul(w, hn::Set(d, q[k].x)));
    rest.y = hn::Sub(rest.y, hn::Mul(w, hn::Set(d, q[k].y)));
    rest.z = hn::Sub(rest.z, hn::Mul(w, hn::Set(d, q[k].z)));
  }
  return rest;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Apart farthest_with(D d, const Coordinates& points, const double* weights, std::size_t rows,
                               const std::array<Vector3, 6>& q, const Vector3& direction) {
  const std::size_t lanes = hn::Lanes(d);
  const Vec3<V> n{hn::Set(d, direction.x), hn::Set(d, direction.y), hn::Set(d, direction.z)};
  V most = hn::Zero(d), along = hn::Zero(d), probe = hn::Zero(d);
  const auto take = [&](std::size_t r) HWY_ATTR {
    const Vec3<V> rest = difference(d, points, weights, rows, q, r);
    const V sq = dot(rest, rest);
    most = hn::Max(most, sq);
    along = hn::Max(along, hn::Abs(dot(rest, n)));
    probe = hn::Add(probe, hn::Sub(sq, sq));  // stays 0 unless one is not finite
  };
  std::size_t r = 0;
  for (; r + lanes <= rows; r += lanes) take(r);
  if (r < rows) take(rows - lanes);
  if (!hn::AllTrue(d, hn::Eq(probe, hn::Zero(d)))) return {INFINITY, INFINITY};
  return {std::sqrt(hn::GetLane(hn::MaxOfLanes(d, most)) + 8 * underflow_error),
          hn::GetLane(hn::MaxOfLanes(d, along))};
}

Apart FarthestFromQuadratic(const Coordinates& points, const double* weights, const std::array<Vector3, 6>& q,
                            const Vector3& direction) {
  const hn::ScalableTag<double> wide;
  const std::size_t rows = points.count;
  if (rows >= hn::Lanes(wide)) return farthest_with(wide, points, weights, rows, q, direction);
  return farthest_with(hn::CappedTag<double, 1>(), points, weights, rows, q, direction);
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(FarthestFromQuadratic);

Apart farthest_from_quadratic(const Coordinates& points, const double* weights,
                              const std::array<Vector3, 6>& quadratic, const Vector3& direction) {
  return HWY_DYNAMIC_DISPATCH(FarthestFromQuadratic)(points, weights, quadratic, direction);
}

}  // namespace snug::kernels
#endif
