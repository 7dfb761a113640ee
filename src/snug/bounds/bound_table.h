#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <snug/bounds/bounding_rows.h>
#include <snug/bounds/layout.h>

namespace snug {

/// The dissertation's table of a kind: planes below and above every basis function over a triangle that holds
/// the domain, in a layout of its control points.
///
/// With N_i the basis functions and u = sum N_i layout_i the domain point of a parameter:
///
/// Guarantee: u lies in `triangle`, and  lower_i(u) <= N_i <= upper_i(u)  for control points
///            i = first_bounded(), ..., in exact arithmetic for these very doubles. lower_i <= upper_i at the
///            corners of `triangle`.
///            So  x = l(u) + sum_i (c_i - l(layout_i)) N_i  has linear bounds over `triangle`, whatever
///            linear l is; by rings the one through the first three control points, whose terms vanish.
/// Source:    [Wu05, sec. 4.3 to 4.5]; differs: planes are fitted to bounding rows instead of a net after seven
///            subdivisions in floating point, and the triangle is widened until the domain is proved to lie
///            inside; several extraordinary corners and boundaries are bounded directly.
///            derivations/tables.md.
struct BoundTable {
  /// Affine coordinates: weights of corners 1 and 2 of the patch; corner 0 has the rest.
  using Planar = LayoutPoint;
  /// A plane, by its values at the three corners of `triangle`.
  using CornerValues = std::array<double, 3>;

  std::vector<Planar> layout;              ///< of all control points
  std::array<Planar, 3> triangle;          ///< (x0, y0), (x1, y0), (x0, y2) with x0 < x1, y0 < y2
  std::vector<CornerValues> lower, upper;  ///< of control points first_bounded(), ...

  [[nodiscard]] std::size_t control_count() const { return layout.size(); }
  /// 3 where the first three control points lie at (0,0), (1,0), (0,1), laid_by_rings(); else 0, and the
  /// limits of the corners lie there as nearly as rounding lets them.
  [[nodiscard]] std::size_t first_bounded() const { return layout.size() - lower.size(); }
  [[nodiscard]] std::size_t bytes() const {
    return sizeof(*this) + layout.size() * sizeof(Planar) + 2 * lower.size() * sizeof(CornerValues);
  }
};

/// The table of a kind from its rows: each plane is the one of least volume over the triangle above (below)
/// the bounding points of its function, up to about 1e-12.
///
/// Requires:  rows of this kind.
/// Cost:      two linear programmes a control point, linear in the number of rows.
[[nodiscard]] BoundTable make_bound_table(const Kind& kind, const BoundingRows& rows);
/// The same over any layout; where laid_by_rings(), its first three points are (0, 0), (1, 0), (0, 1).
[[nodiscard]] BoundTable make_bound_table(const Kind& kind, const BoundingRows& rows,
                                          std::vector<LayoutPoint> layout);

}  // namespace snug
