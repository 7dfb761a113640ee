#pragma once

#include <vector>

#include <snug/patch/neighbourhood.h>

namespace tablegen {

/// Kinds that meshes have most of, each key once and turned as keys are, in the order of the file. Loop:
///
///   - all corners regular, inside (1) and at a boundary in every position (5);
///   - one extraordinary corner inside, of valence 3 to 12 (9);
///   - one irregular smooth boundary corner of 1, 2, 4, 5 or 6 faces, the patch in every place of its fan;
///     the other corners regular, and at the boundary only where an edge of the patch is (18);
///   - a lone sharp corner, the others regular (1).
///
/// Catmull-Clark: regular inside (1), one extraordinary corner of valence 3, 5 or 6 in each place (12), a
///                boundary along one edge (4) or along two that meet in a lone sharp corner (4). Doo-Sabin
///                and Midedge: regular (1), one face of 3, 5 or 6 corners in each place (12).
[[nodiscard]] std::vector<snug::KindKey> common_kinds();

}  // namespace tablegen
