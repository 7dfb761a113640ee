#include <snug/query/piece_quadratic.h>

#include <algorithm>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// Squares, products and sums lose less than this by underflow.
constexpr double tiny = 0x1p-500;

}  // namespace

PieceQuadratic::PieceQuadratic(const QuadraticTriangle& near, const PiecePath& path)
    : path_(path), origin_(near.corners[0]), error_(near.error) {
  const auto from = [&](const Point3& p) { return p - origin_; };
  const Vector3 corner_u = from(near.corners[1]), corner_v = from(near.corners[2]),
                middle_u = from(near.middles[0]), middle_uv = from(near.middles[1]),
                middle_v = from(near.middles[2]);
  u_ = 2.0 * middle_u;
  v_ = 2.0 * middle_v;
  uu_ = corner_u - 2.0 * middle_u;
  vv_ = corner_v - 2.0 * middle_v;
  uv_ = 2.0 * (middle_uv - middle_u - middle_v);
  // Roundings of the coefficients are those of their terms.
  size_ = max_abs(corner_u) + max_abs(corner_v) +
          8 * (max_abs(middle_u) + max_abs(middle_v) + max_abs(middle_uv));
}

Vector3 PieceQuadratic::from_origin(TriangleParameter p) const {
  return p.u * (u_ + p.u * uu_ + p.v * uv_) + p.v * (v_ + p.v * vv_);
}

Vector3 PieceQuadratic::bow(TriangleParameter a, TriangleParameter b) const {
  const double du = (b.u - a.u) * path_.scale(), dv = (b.v - a.v) * path_.scale();
  return 0.25 * (du * du * uu_ + du * dv * uv_ + dv * dv * vv_);
}

// The difference is a quadratic over the triangle with the Bezier points gap_k and, between them, the middle of
// two gaps less twice the bow. Split once in four it lies in the hull of the points below.
Flatness PieceQuadratic::flatness(const FlatTriangle& triangle) const {
  Flatness result{};
  std::array<Vector3, 3> gap, middle;
  double size = size_;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 off = triangle.corner[k] - origin_;
    size = std::max(size, max_abs(off));
    gap[k] = from_origin(path_.local(triangle.at[k])) - off;
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
  result.error = enlarged(std::sqrt(std::max(sq, gap_sq)) + error_ + rounding);
  if (!(result.error < INFINITY)) result.error = INFINITY;
  return result;
}

}  // namespace snug
