#pragma once

#include <cstddef>
#include <optional>

#include <snug/patch/kind_cache.h>
#include <snug/scheme/stencils.h>

namespace snug {

/// Few points whose hull holds a patch that is regular but for one semi-sharp crease through it: the Bezier
/// points of the two bicubics, or three, that it consists of.
struct CreaseRows {
  std::optional<Stencils> rows;  ///< none: another kind, or one whose sharpness is soon gone
  [[nodiscard]] std::size_t bytes() const;
};

/// The rows of half a Catmull-Clark quad among quads, all corners of valence 4, with edges of one sharpness,
/// at least 2, in a straight line from side to side of its neighbourhood. Others, and crease methods other
/// than uniform, have none.
///
/// Guarantee: for all control points the patch lies in the convex hull of the rows' points.
/// Source:    [NiessnerLoop12]; derivations/bounding_rows.md, "One semi-sharp crease".
[[nodiscard]] CreaseRows make_crease_rows(const Kind& kind);

}  // namespace snug
