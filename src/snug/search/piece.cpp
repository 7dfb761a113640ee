#include <snug/search/piece.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/bounds/table_triangle.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <support/direction.h>

namespace snug {

OffsetTriangle offset_of(BoundsCache& library, const Patch& patch, BoundingPoints& scratch,
                         BoundMethod method) {
  if (method == BoundMethod::table) return offset_triangle(table_triangle(library.table(*patch.kind), patch));
  bounding_points(library, patch, scratch);
  return offset_triangle(library, scratch, limit_corners(patch));
}

Piece make_piece(BoundsCache& library, PatchId root, Patch patch, BoundingPoints& scratch,
                 BoundMethod method) {
  const OffsetTriangle offset = offset_of(library, patch, scratch, method);
  return {root, std::move(patch), offset};
}

Piece child_of(BoundsCache& library, const Piece& piece, unsigned child, BoundingPoints& scratch,
               BoundMethod method) {
  return make_piece(library, piece.root, split(piece.patch, child), scratch, method);
}

LimitTriangle limit_triangle(const Patch& patch) {
  LimitTriangle result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const BoundedPoint corner = corner_point(patch, k).from(patch.origin);
    result.corners[k] = corner.position;
    result.error = std::max(result.error, spatial_error(corner.error));
  }
  return result;
}

std::size_t longest_side(const Triangle& triangle) {
  const auto length = [&](std::size_t k) { return max_abs(triangle[(k + 1) % 3] - triangle[k]); };
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (length(k) > length(longest)) longest = k;
  }
  return longest;
}
Vector3 longest_edge(const Triangle& triangle) {
  const std::size_t k = longest_side(triangle);
  return triangle[(k + 1) % 3] - triangle[k];
}

Vector3 unit_normal(const Triangle& triangle) {
  const Vector3 a = triangle[1] - triangle[0], b = triangle[2] - triangle[0];
  // Sides of about 1, so that the product neither underflows nor overflows.
  const double size = std::max(max_abs(a), max_abs(b));
  if (!(size > 0) || !std::isfinite(1 / size)) return {};
  const Vector3 normal = cross((1 / size) * a, (1 / size) * b);
  const double area = length(normal);
  if (!(area > 1e-12)) return {};
  return (1 / area) * normal;
}

Extent extent_of(const BoundingPoints& hull, const Vector3& direction, const Point3& from) {
  const Slab slab = outer_slab(hull, direction);
  if (std::isnan(slab.lower) || std::isnan(slab.upper)) return unbounded;
  const double sum = std::fabs(direction.x) + std::fabs(direction.y) + std::fabs(direction.z);
  const Vector3 between = hull.origin - from;
  const double height = dot(direction, between);
  const double error =
      enlarged(8 * unit_roundoff * sum * (max_abs(between) + hull.largest)) + 8 * underflow_error;
  return {height + slab.lower - error, height + slab.upper + error};
}

Extent extent_of(const OffsetTriangle& triangle, const Vector3& direction) {
  Extent extent;
  double largest = 0;
  for (const Point3& p : triangle.base) {
    extent.add(dot(direction, p - Point3{}));
    largest = std::max(largest, max_abs(p - Point3{}));
  }
  const double reach =
      enlarged(triangle.radius * length(direction) + 16 * unit_roundoff * largest) + 8 * underflow_error;
  if (!std::isfinite(reach)) return unbounded;
  return {extent.lower - reach, extent.upper + reach};
}

Heights heights_of(const Piece& piece, const BoundingPoints& points) {
  const Vector3 normal = unit_normal(piece.offset.base);
  const Vector3 from = piece.offset.base[0] - points.origin;
  const kernels::Range range = kernels::heights(points.coordinates(), from, normal);
  // Differences to `from`, which is rounded once, and a dot product of a vector of length 1.
  const double error =
      enlarged(2 * spatial_error(points.error) + gamma_bound(8) * 2 * (points.largest + max_abs(from))) +
      8 * underflow_error;
  const Heights heights{rounded_down(range.lower - error), rounded_up(range.upper + error)};
  if (!std::isfinite(heights.lower) || !std::isfinite(heights.upper)) return {-INFINITY, INFINITY};
  return heights;
}

// Of all that the offset triangle holds. On needles the computed normal is off by far more than a rounding,
// so that the corners have heights, too.
Heights heights_of(const OffsetTriangle& offset) {
  const Vector3 normal = unit_normal(offset.base);
  Heights heights{0, 0};
  double largest = 0;
  for (const Point3& corner : offset.base) {
    const Vector3 from = corner - offset.base[0];
    const double height = dot(normal, from);
    heights = {std::min(heights.lower, height), std::max(heights.upper, height)};
    largest = std::max(largest, max_abs(from));
  }
  // The normal's length is 1 up to 8 roundings; differences and products of the corners', gamma(8).
  const double reach =
      enlarged(offset.radius * (1 + 16 * unit_roundoff) + gamma_bound(8) * 2 * largest) + 8 * underflow_error;
  heights = {rounded_down(heights.lower - reach), rounded_up(heights.upper + reach)};
  if (!std::isfinite(heights.lower) || !std::isfinite(heights.upper)) return {-INFINITY, INFINITY};
  return heights;
}

namespace {

// Along the longest edge, across it in the triangle's plane, and along the normal.
std::array<Vector3, 3> box_axes(const Triangle& base) {
  const Vector3 normal = unit_normal(base);
  if (normal == Vector3{}) return Obb{}.axes;
  Vector3 along = longest_edge(base);
  along = (1 / max_abs(along)) * along;
  along = normalized(along - dot(along, normal) * normal);
  return {along, cross(normal, along), normal};
}

}  // namespace

Obb box_around(const OffsetTriangle& offset, const BoundingPoints& points, BoundMethod method) {
  return fit_box(box_axes(offset.base), [&](const Vector3& d) {
    return method == BoundMethod::table ? extent_of(offset, d) : extent_of(points, d);
  });
}

}  // namespace snug
