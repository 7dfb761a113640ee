#pragma once

#include <array>
#include <span>

#include <snug/base/motion.h>
#include <snug/base/point.h>
#include <snug/enclose/offset_triangle.h>

namespace snug {

/// The set of x with |dot(axis_k, x - centre)| <= half_k for k = 0, 1, 2. Axes are orthonormal up to a few
/// roundings; the set is meant with these very doubles.
struct Obb {
  Point3 centre;
  std::array<Vector3, 3> axes{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  Vector3 half;
};

/// A box around offset triangles, along the principal axes of their corners.
///
/// Guarantee: contains every point of every offset triangle, rounding included.
/// Requires:  at least one; finite radii.
/// Cost:      linear, two passes.
/// Source:    [Gottschalk96], [Wu05, sec. 5.1.2].
[[nodiscard]] Obb outer_obb(std::span<const OffsetTriangle* const> members);

/// x -> scale (R x) + t with scale a power of two: a placement of a surface in the frame that a query works
/// in.
struct PlacedFrame {
  std::array<Vector3, 3> rows;  ///< of R
  double scale = 1;
  Vector3 translation;
  double defect = 0;  ///< upper bound of the largest entry of |R'R - I|

  [[nodiscard]] Vector3 turn(const Vector3& v) const {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
  }
  [[nodiscard]] Point3 apply(const Point3& p) const {
    return Point3{} + (scale * turn(p - Point3{}) + translation);
  }
  /// Upper bound, a coordinate, of |apply(p) - exact image|.
  [[nodiscard]] double apply_error(const Point3& p) const;
  /// Upper bound of scale times the spectral norm of R: how much radii grow.
  [[nodiscard]] double growth() const;
};

/// A box as seen from a query's frame.
struct PlacedObb {
  Point3 centre;
  std::array<Vector3, 3> axes;
  Vector3 half;
  double centre_error;
};
[[nodiscard]] PlacedObb placed(const Obb& box, const PlacedFrame& frame);

/// Lower bound of the distance of two placed boxes: the widest gap along the fifteen axes. Negative or zero
/// if no gap shows; the more negative, the deeper they overlap.
///
/// Guarantee: at most the exact distance where positive; `defect` is the sum of the frames' defects.
/// Source:    [Gottschalk96]; differs: gaps are measured and certified, not only signs.
[[nodiscard]] double certain_gap(const PlacedObb& a, const PlacedObb& b, double defect);

}  // namespace snug
