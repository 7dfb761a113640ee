#pragma once

#include <snug/patch/neighbourhood.h>
#include <snug/scheme/stencils.h>

namespace snug {

/// Is the limit patch of this kind one quartic polynomial? So it is if every corner is regular.
[[nodiscard]] bool is_polynomial(const KindKey& key);

/// Bezier points of a polynomial kind from its control points: 15 rows. Smooth boundaries are completed by
/// one row of ghost points, which reproduce them exactly.
///
/// Guarantee: entries are multiples of 1/24, each rounded once.
/// Requires:  is_polynomial(key).
/// Source:    derivations/loop_bezier.md; [Stam98] gives the same basis.
[[nodiscard]] Stencils bezier_rows(const KindKey& key);

}  // namespace snug
