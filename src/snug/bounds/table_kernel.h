#pragma once

#include <span>

#include <snug/bounds/bound_table.h>
#include <snug/bounds/fit_kernels.h>

namespace snug::kernels {

/// Offset triangles of many patches of one kind from its table: the dissertation's, as offset_triangle() has
/// them; a patch a lane.
///
/// Guarantee: as offset_triangle(table_triangle()); base in the kind's order of corners. The radius is
///            infinite where a point is not finite. Results are the same on every instruction set, bit by bit.
/// Requires:  table.first_bounded() == 3; control: table.control_count() vertices of `points` a patch, in the
///            kind's order; out.size() patches; coordinates of at most about 2 (geometry/scaling.h).
/// Cost:      about 20 operations a control point and coordinate, four to eight patches at once.
void fit_table(const BoundTable& table, std::span<const Point3> points, std::span<const VertexId> control,
               std::span<BatchFit> out);

}  // namespace snug::kernels
