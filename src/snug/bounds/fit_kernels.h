#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <snug/geometry.h>
#include <snug/mesh.h>

namespace snug {

struct BoundTable;
class Kind;

/// Upper bounds for the difference of a patch and a quadratic over all parameters: of its length, and of its part along a direction.
struct Apart {
  double any = 0, along = 0;
  void add(const Apart& other) {
    any = std::max(any, other.any);
    along = std::max(along, other.along);
  }
};

}  // namespace snug

/// The loops that bounds spend their time in, on the widest vectors of the processor, chosen at run time.
///
/// Guarantee: every lane does the same operations in the same order on every instruction set, none of them
///            fused, and lanes meet only in minima and maxima: results are the same everywhere, bit by bit.
namespace snug::kernels {

/// The instruction set in use, such as AVX2.
[[nodiscard]] const char* instruction_set();

/// Coordinates of many points, one array each, `count` long.
struct Coordinates {
  const double* x;
  const double* y;
  const double* z;
  std::size_t count;
  [[nodiscard]] Coordinates first(std::size_t n) const { return {x, y, z, n}; }
  [[nodiscard]] Coordinates from(std::size_t i) const { return {x + i, y + i, z + i, count - i}; }
};

/// x, y, z = M points, for a column-major matrix of `rows` rows. Sums run over the columns in order.
void apply_rows(const double* weights, std::size_t rows, std::span<const Vector3> points, double* x,
                double* y, double* z);

/// The sum of weights[i] times row places[sources[i]] of a row-major matrix.
struct RowSum {
  const double* entries;
  std::size_t width;
  std::span<const std::uint32_t> places, sources;
  std::span<const double> weights;
};
/// That row; each sum runs over the sources in order.
void combine_rows(const RowSum& sum, double* out);

/// Least and largest dot(normal, p - from). NaN where a point is not finite is passed over.
struct Range {
  double lower, upper;
};
[[nodiscard]] Range heights(const Coordinates& points, const Vector3& from, const Vector3& normal);

/// How far points are from a triangle.
struct Reach {
  double distance;  ///< upper bound of the largest distance, but for the points' own error; infinite where a
                    ///< point is not finite
  double rounding;  ///< the part of it that accounts for rounding
};

/// Largest distance to the triangle of the points before each of three places, from the one before it on, and
/// of those after them, 0 for none; nothing for a triangle that is too flat for its own plane: the sine of
/// its sharpest angle below 1/32, without area, not finite, or of a size whose fourth power leaves the range
/// of doubles.
///
/// Guarantee: largest distance <= distance, for the triangle of these very doubles; distance <= largest
///            distance + 3 rounding, times 1 + 2^-39 where its longest edge is below 1e-70;
///            rounding <= (16 + 112 / sine) u (distance + 2 longest edge).
/// Requires:  points in scaled coordinates (support/scaling.h), or not finite; splits not decreasing, at
///            most points.count.
/// Source:    derivations/rounding.md, "Distance in the triangle's plane".
[[nodiscard]] std::optional<std::array<Reach, 4>> farthest(const Coordinates& points,
                                                           const std::array<std::size_t, 3>& splits,
                                                           const Vector3& a, const Vector3& b,
                                                           const Vector3& c);

/// The largest distance of point r from the sum of weights[k points.count + r] quadratic[k], and its part along a direction, as
/// computed: each difference has six products and six subtractions a coordinate. Infinite where one is not finite.
[[nodiscard]] Apart farthest_from_quadratic(const Coordinates& points, const double* weights,
                                            const std::array<Vector3, 6>& quadratic,
                                            const Vector3& direction);

/// Offset triangles of regular patches inside the surface, straight from their control points: Bezier points,
/// one split of de Casteljau's, fit; a patch a lane. A negative radius is no answer: take the general way.
///
/// Guarantee: as offset_triangle() on the patch's bounding points; marked where farthest() has no answer.
/// Requires:  control: twelve vertices of `points` a patch, in the kind's order; out.size() patches; points
///            as in farthest().
/// Cost:      about 0.07 microseconds a patch with eight lanes, 0.08 with four.
void fit_regular(std::span<const Point3> points, std::span<const VertexId> control,
                 std::span<OffsetTriangle> out);

/// The same of regular Catmull-Clark patches inside the surface, halves of bicubic quads: their Bezier points
/// without a split, sixteen control points a patch.
///
/// Guarantee: the patch lies in the offset triangle; its radius is at least that of fits to points after a
///            split.
void fit_bicubic(std::span<const Point3> points, std::span<const VertexId> control,
                 std::span<OffsetTriangle> out);

/// Offset triangles of many patches of one kind from its table.
///
/// Guarantee: as offset_triangle(table_triangle()); base in the kind's order of corners. Infinite radius
///            where a point is not finite.
/// Requires:  the table of this kind; control: table.control_count() vertices of `points` a patch, in the
///            kind's order; out.size() patches; coordinates of at most about 2 (support/scaling.h).
/// Cost:      about 20 operations a control point and coordinate, four to eight patches at once.
void fit_table(const BoundTable& table, const Kind& kind, std::span<const Point3> points,
               std::span<const VertexId> control, std::span<OffsetTriangle> out);

}  // namespace snug::kernels
