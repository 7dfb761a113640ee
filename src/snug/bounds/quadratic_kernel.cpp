#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/quadratic_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <cmath>

#include <snug/bounds/fit_kernels.h>
#include <snug/geometry/rounding.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

// Squared length of point r less the weighted sum.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V apart_sq(D d, const Coordinates& points, const double* weights, std::size_t rows,
                      const std::array<Vector3, 6>& q, std::size_t r) {
  Vec3<V> rest{hn::LoadU(d, points.x + r), hn::LoadU(d, points.y + r), hn::LoadU(d, points.z + r)};
  for (std::size_t k = 0; k < 6; ++k) {
    const V w = hn::LoadU(d, weights + k * rows + r);
    rest.x = hn::Sub(rest.x, hn::Mul(w, hn::Set(d, q[k].x)));
    rest.y = hn::Sub(rest.y, hn::Mul(w, hn::Set(d, q[k].y)));
    rest.z = hn::Sub(rest.z, hn::Mul(w, hn::Set(d, q[k].z)));
  }
  return dot(rest, rest);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE double farthest_with(D d, const Coordinates& points, const double* weights, std::size_t rows,
                                const std::array<Vector3, 6>& q) {
  const std::size_t lanes = hn::Lanes(d);
  V most = hn::Zero(d), probe = hn::Zero(d);
  const auto take = [&](std::size_t r) HWY_ATTR {
    const V sq = apart_sq(d, points, weights, rows, q, r);
    most = hn::Max(most, sq);
    probe = hn::Add(probe, hn::Sub(sq, sq));  // stays 0 unless one is not finite
  };
  std::size_t r = 0;
  for (; r + lanes <= rows; r += lanes) take(r);
  if (r < rows) take(rows - lanes);
  if (!hn::AllTrue(d, hn::Eq(probe, hn::Zero(d)))) return INFINITY;
  return std::sqrt(hn::GetLane(hn::MaxOfLanes(d, most)) + 8 * underflow_error);
}

double FarthestFromQuadratic(const Coordinates& points, const double* weights,
                             const std::array<Vector3, 6>& q) {
  const hn::ScalableTag<double> wide;
  const std::size_t rows = points.count;
  if (rows >= hn::Lanes(wide)) return farthest_with(wide, points, weights, rows, q);
  return farthest_with(hn::CappedTag<double, 1>(), points, weights, rows, q);
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(FarthestFromQuadratic);

double farthest_from_quadratic(const Coordinates& points, const double* weights,
                               const std::array<Vector3, 6>& quadratic) {
  return HWY_DYNAMIC_DISPATCH(FarthestFromQuadratic)(points, weights, quadratic);
}

}  // namespace snug::kernels
#endif
