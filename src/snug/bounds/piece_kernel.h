#pragma once

#include <span>

#include <snug/bounds/part_kernels.h>
#include <snug/bounds/rows_kernel.h>

namespace snug::kernels {

/// A patch, and where what is known of it goes: limits of its corners (of `shape` nothing else), its frame, with the quadratic over
/// all of it in the first place, and its bounds in that, a negative `error` being no answer.
struct PieceToFit {
  const Patch* patch;
  PartShape* shape;
  PatchFrame* frame;
  PartBounds* bounds;
};

/// Fits patches of one kind as they are, without a split, a patch a lane, in single precision: all points of these levels, and tips by
/// layouts.
///
/// Guarantee: bounds as those of bound_parts(), all roundings included. Answers do not depend on what is in other lanes.
///            No answer for needles, what is not finite, where tips stick out of the rest by a tenth, and where roundings would make a bound
///            larger by some hundredth.
/// Requires:  rows with layouts; patches of their kind; levels from least_row_levels to most_row_levels.
/// Source:    derivations/quadratics.md, "Many patches of one kind".
void fit_pieces_by_rows(const RowsWithTips<float>& rows, unsigned levels, std::span<const PieceToFit> pieces);

}  // namespace snug::kernels
