#include <snug/query/piece_quadratic.h>

#include <algorithm>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// Squares, products and sums lose less than this by underflow.
constexpr double tiny = 0x1p-500;

Vector3 doubled(const std::array<float, 3>& x) {
  return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
}

}  // namespace

PieceQuadratic::PieceQuadratic(const QuadraticTriangle& near, const PiecePath& path)
    : first_(to_face(path, {0, 0})),
      origin_(near.corners[0]),
      scale_(static_cast<float>(path.turned() ? -path.scale() : path.scale())) {
  const auto from = [&](const Point3& p) { return p - origin_; };
  const Vector3 corner_u = from(near.corners[1]), corner_v = from(near.corners[2]),
                middle_u = from(near.middles[0]), middle_uv = from(near.middles[1]),
                middle_v = from(near.middles[2]);
  u_ = 2.0 * middle_u;
  v_ = 2.0 * middle_v;
  // u^2 + u v + v^2 is at most 1.
  double rounding = 0;
  const auto single = [&](const Vector3& x) {
    Single result;
    for (std::size_t a = 0; a < 3; ++a) {
      result[a] = static_cast<float>(x[a]);
      rounding = std::max(rounding, std::fabs(static_cast<double>(result[a]) - x[a]));
    }
    return result;
  };
  uu_ = single(corner_u - 2.0 * middle_u);
  vv_ = single(corner_v - 2.0 * middle_v);
  uv_ = single(2.0 * (middle_uv - middle_u - middle_v));
  error_ = float_up(enlarged(near.error + spatial_error(rounding)));
}

TriangleParameter PieceQuadratic::local(TriangleParameter p) const {
  const auto scale = static_cast<double>(scale_);
  return {scale * (p.u - first_.u), scale * (p.v - first_.v)};
}

Vector3 PieceQuadratic::from_origin(TriangleParameter p) const {
  const Vector3 uu = doubled(uu_), uv = doubled(uv_), vv = doubled(vv_);
  return p.u * (u_ + p.u * uu + p.v * uv) + p.v * (v_ + p.v * vv);
}

Vector3 PieceQuadratic::bow(TriangleParameter a, TriangleParameter b) const {
  const auto scale = static_cast<double>(scale_);
  const double du = (b.u - a.u) * scale, dv = (b.v - a.v) * scale;
  return 0.25 * (du * du * doubled(uu_) + du * dv * doubled(uv_) + dv * dv * doubled(vv_));
}

// The difference is a quadratic over the triangle with the Bezier points gap_k and, between them, the middle of
// two gaps less twice the bow. Split once in four it lies in the hull of the points below.
Flatness PieceQuadratic::flatness(const FlatTriangle& triangle) const {
  Flatness result{};
  std::array<Vector3, 3> gap, middle;
  // Of the coefficients' terms, whose roundings are in them.
  double size = 9 * (max_abs(u_) + max_abs(v_)) + max_abs(doubled(uu_)) + max_abs(doubled(vv_)) +
                4 * max_abs(doubled(uv_));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 off = triangle.corner[k] - origin_;
    size = std::max(size, max_abs(off));
    gap[k] = from_origin(local(triangle.at[k])) - off;
  }
  double gap_sq = 0, sq = 0;
  Vector3 middles;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    result.bow[k] = bow(triangle.at[k], triangle.at[next]);
    middle[k] = 0.5 * (gap[k] + gap[next]) - 2.0 * result.bow[k];
    middles = middles + middle[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    gap_sq = std::max(gap_sq, length_sq(gap[k]));
    sq = std::max({sq, length_sq(0.5 * (gap[k] + middle[k])), length_sq(0.5 * (gap[k] + middle[(k + 2) % 3])),
                   length_sq(0.25 * (gap[k] + middles))});
  }
  result.corner_gap = std::sqrt(gap_sq);
  const double rounding = spatial_error(gamma_bound(64) * 4 * size) + tiny;
  result.error = enlarged(std::sqrt(std::max(sq, gap_sq)) + error() + rounding);
  if (!(result.error < INFINITY)) result.error = INFINITY;
  return result;
}

}  // namespace snug
