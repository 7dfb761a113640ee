#pragma once

#include <array>
#include <vector>

#include <snug/basis/bound_library.h>
#include <snug/enclose/fit_kernels.h>
#include <snug/patch/patch.h>

namespace snug {

/// Points whose convex hull contains a limit patch, relative to its origin; one array a coordinate.
struct HullPoints {
  Point3 origin;
  std::vector<double> x, y, z;
  double error = 0;    ///< upper bound, a coordinate, of |point - exact point|
  double largest = 0;  ///< upper bound of every |coordinate|
  /// The last points, if they are the control nets of tips (see BoundRows).
  std::array<BoundRows::Tip, 3> tips;

  [[nodiscard]] std::size_t tips_begin() const { return tips[0].kind ? tips[0].begin : size(); }
  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] kernels::Coordinates coordinates() const { return {x.data(), y.data(), z.data(), x.size()}; }
  [[nodiscard]] Vector3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// The points M c of a patch, written over `out`, which keeps its memory.
///
/// Guarantee: the patch lies in the hull of points that differ from these by at most out.error a coordinate.
/// Requires:  rows of the patch's kind.
/// Cost:      3 rows.count() rows.control_count() multiply-adds; no allocation once `out` has been as large.
void hull_points(const BoundRows& rows, const Patch& patch, HullPoints& out);

/// Replaces the control net of tip `i` by the points that the rows of its own kind make of it: the hull shrinks
/// to the pieces around the corner, and a net some levels farther down.
///
/// Requires:  points.tips[i].kind.
void refine_tip(BoundLibrary& library, std::size_t i, HullPoints& points);

/// The baseline: the control points themselves. The limit lies in their hull because all masks are
/// non-negative.
void control_points(const Patch& patch, HullPoints& out);

/// Least box around the points, moved to the coordinates' origin.
/// Guarantee: contains the patch, rounding included.
[[nodiscard]] Box3 outer_box(const HullPoints& points);

/// The set lower <= dot(normal, p) <= upper.
struct Slab {
  Vector3 normal;
  double lower, upper;
};

/// Slab along `normal`, which need not be of length 1, that contains the patch, rounding included. Bounds
/// belong to points relative to points.origin.
[[nodiscard]] Slab outer_slab(const HullPoints& points, const Vector3& normal);

}  // namespace snug
