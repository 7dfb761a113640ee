#pragma once

#include <snug/bounds/hull_points.h>
#include <snug/patch/curve_piece.h>

namespace snug {

/// Points whose convex hull contains a piece of a curve: the Bezier points of its four quarters, written over
/// `out`, which keeps its memory.
///
/// Guarantee: the piece lies in the hull of points that differ from these by at most out.error a coordinate.
void hull_points(const CurvePiece& piece, HullPoints& out);

}  // namespace snug
