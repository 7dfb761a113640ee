#pragma once

#include <vector>

#include <snug/patch/neighbourhood.h>

namespace tablegen {

/// The kinds that are shipped, each key once and turned as keys are, in the order of the file:
///
///   - all corners regular, inside (1) and at a boundary in every position (5);
///   - one extraordinary corner inside, of valence 3 to 12 (9);
///   - one irregular smooth boundary corner of 1, 2, 4, 5 or 6 faces, the patch in every place of its fan;
///     the other corners regular, and at the boundary only where an edge of the patch is (18);
///   - a lone sharp corner, the others regular (1).
[[nodiscard]] std::vector<snug::KindKey> shipped_kinds();

}  // namespace tablegen
