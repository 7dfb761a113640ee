#pragma once

#include <cstddef>
#include <optional>

#include <snug/bounds/bounding_rows.h>

namespace snug {

/// Few points whose hull holds a patch that is regular but for one semi-sharp crease through it: the Bezier
/// points of the two bicubics, or three, that it consists of.
struct CreaseRows {
  std::optional<BoundingRows> rows;  ///< none: another kind, or one whose sharpness is soon gone
  [[nodiscard]] std::size_t bytes() const { return sizeof(*this) + (rows ? rows->bytes() : 0); }
};

/// The rows of half a Catmull-Clark quad among quads, all corners of valence 4, with edges of one sharpness,
/// at least 2, in a straight line from side to side of its neighbourhood. Others, and crease methods other
/// than uniform, have none.
///
/// Guarantee: those of BoundingRows, quadratic() among them; there are no nets.
/// Source:    [NiessnerLoop12]; derivations/bounding_rows.md, "One semi-sharp crease".
[[nodiscard]] CreaseRows make_crease_rows(const Kind& kind);

}  // namespace snug
