#pragma once

#include <snug/bounds/bounding_points.h>
#include <snug/patch/curve_piece.h>

/// The baseline of all comparisons: the least box around control points.
namespace snug {

/// Control points, whose hull holds the limit because all masks are non-negative; of a curve's end the end of
/// the polyline in the place of a ghost (derivations/curves.md).
void control_points(const Patch& patch, BoundingPoints& out);
void control_points(const CurvePiece& piece, BoundingPoints& out);

/// Least box around points, moved to the coordinates' origin.
/// Guarantee: contains what their hull does, rounding included.
[[nodiscard]] Box3 outer_box(const BoundingPoints& points);

/// The box around control points.
/// Guarantee: contains the patch, or the piece, rounding included.
template <class Piece>
[[nodiscard]] Box3 control_box(const Piece& piece, BoundingPoints& scratch) {
  control_points(piece, scratch);
  return outer_box(scratch);
}

}  // namespace snug
