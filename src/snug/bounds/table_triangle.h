#pragma once

#include <snug/bounds/bound_table.h>
#include <snug/bounds/enclosure.h>
#include <snug/patch/patch.h>

namespace snug {

/// The dissertation's interval triangle of a patch, from the table of its kind.
struct TableTriangle {
  IntervalTriangle interval;  ///< corners in the patch's order
  double rounding;            ///< by how much each side of a box was moved to account for rounding, at most
};

/// At corner k of the table's triangle the patch is between
///   l(t_k) + sum max(d_i, 0) lower_i[k] + min(d_i, 0) upper_i[k]   and
///   l(t_k) + sum max(d_i, 0) upper_i[k] + min(d_i, 0) lower_i[k],  a coordinate, where
/// l is linear through the control points of the corners and d_i = c_i - l(layout_i). A table that bounds all
/// of its functions takes an l through the limits of the corners as computed: any l will do.
///
/// Guarantee: contains every limit point of the patch, rounding and the control points' own error included.
/// Requires:  the table of the patch's kind.
/// Source:    [Wu05, eq. 4.1, lemma 11]; differs: boxes lie at the corners of the widened triangle, and are
///            rounded outwards.
[[nodiscard]] TableTriangle table_triangle(const BoundTable& table, const Patch& patch);

/// The offset triangle that the dissertation makes of an interval triangle: through the boxes' centres, with
/// the largest of their half diagonals as radius.
///
/// Guarantee: contains the interval triangle, rounding included.
/// Requires:  coordinates of at most about 4 (support/scaling.h).
/// Source:    [Wu05, eq. 5.1, 5.2].
[[nodiscard]] OffsetTriangle offset_triangle(const TableTriangle& triangle);

}  // namespace snug
