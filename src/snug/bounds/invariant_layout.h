#pragma once

#include <vector>

#include <snug/bounds/layout.h>
#include <snug/patch/kind_cache.h>

namespace snug {

/// The characteristic map as a layout, which subdivision leaves as it is up to an affine map, for a kind that comes
/// again at a corner; empty for others. Corners of the limit patch lie at (0, 0), (1, 0), (0, 1). It has right
/// eigenvectors of the step to the piece at the corner, those that belong to the tangents there.
///
/// Guarantee: finite numbers, the same for the same kind. A bound needs no more: any layout is sound.
/// Cost:      a dense system: the third power of the number of control points.
/// Source:    [Reif95]; derivations/quadratics.md.
[[nodiscard]] std::vector<LayoutPoint> invariant_layout(const Kind& kind);

/// The layout of the tables that bound tips: the invariant one, where make_bound_table() wants it by an affine
/// map; of kinds that have none make_layout().
[[nodiscard]] std::vector<LayoutPoint> tip_layout(const Kind& kind);

}  // namespace snug
