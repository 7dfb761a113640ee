#pragma once

#include <snug/search/workspace.h>

namespace snug {

/// Lower bound, in mesh units, of the distance of two placed surfaces, along the line between their middles: cheap. Not
/// positive where none shows, or where doubles do not reach.
/// Source:    derivations/boxes.md, "Whole models".
[[nodiscard]] double outer_gap(const PlacedBvh& a, const PlacedBvh& b);

}  // namespace snug
