#pragma once

#include <vector>

#include <snug/bounds/layout.h>

namespace snug {

/// A layout for any kind of patch: the control net that is nearest to both of these. Its limit patch is its
/// own parametrisation, and it is fair: each face around the patch an affine image of a regular polygon, each
/// fan at its vertices one of a regular fan. Corners of the limit patch lie at (0, 0), (1, 0) and (0, 1).
///
/// Guarantee: finite numbers, the same for the same kind. Where everything is regular the lattice, without
///            error.
/// Requires:  a patch, no polygon.
/// Cost:      a dense system: the third power of the number of control points (bench/results).
/// Source:    derivations/tables.md, "Other kinds".
[[nodiscard]] std::vector<LayoutPoint> fair_layout(const Kind& kind);

}  // namespace snug
