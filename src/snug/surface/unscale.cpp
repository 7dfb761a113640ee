#include <snug/surface/unscale.h>

#include <limits>

#include <snug/geometry/rounding.h>

namespace snug {

double unscaled_down(double x, PowerOfTwo back) {
  const double y = back.apply(x);
  if (std::isinf(y)) return y > 0 ? std::numeric_limits<double>::max() : y;
  return back.exact(x) ? y : rounded_down(y - underflow_error);
}

double unscaled_up(double x, PowerOfTwo back) {
  const double y = back.apply(x);
  return std::isinf(y) || back.exact(x) ? y : rounded_up(y + underflow_error);
}

Box3 unscaled(const Box3& box, PowerOfTwo back) {
  Box3 result;
  for (std::size_t a = 0; a < 3; ++a) {
    result.lower[a] = require_representable(unscaled_down(box.lower[a], back));
    result.upper[a] = require_representable(unscaled_up(box.upper[a], back));
  }
  return result;
}

BoundedPoint unscaled_exactly(const BoundedPoint& point, PowerOfTwo back) {
  return {require_representable(back.apply(point.position)),
          unscaled_up(enlarged(point.error), back) + underflow_error};
}

template <std::size_t N>
IntervalSimplex<N> unscaled(const IntervalSimplex<N>& simplex, PowerOfTwo back) {
  IntervalSimplex<N> result;
  for (std::size_t k = 0; k < N; ++k) result.corner[k] = unscaled(simplex.corner[k], back);
  return result;
}

template <std::size_t N>
OffsetSimplex<N> unscaled(const OffsetSimplex<N>& simplex, PowerOfTwo back) {
  OffsetSimplex<N> result;
  bool exact = true;
  for (std::size_t k = 0; k < N; ++k) {
    result.base[k] = require_representable(back.apply(simplex.base[k]));
    for (std::size_t a = 0; a < 3; ++a) exact = exact && back.exact(simplex.base[k][a]);
  }
  result.radius = unscaled_up(simplex.radius, back);
  result.rounding = unscaled_up(simplex.rounding, back);
  if (!exact) result.radius = enlarged(result.radius + underflow_error);
  require_representable(result.radius);
  return result;
}

template OffsetSegment unscaled(const OffsetSegment&, PowerOfTwo);
template OffsetTriangle unscaled(const OffsetTriangle&, PowerOfTwo);
template IntervalSegment unscaled(const IntervalSegment&, PowerOfTwo);
template IntervalTriangle unscaled(const IntervalTriangle&, PowerOfTwo);

}  // namespace snug
