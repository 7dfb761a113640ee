#pragma once

#include <optional>

#include <snug/bound.h>
#include <snug/patch/patch.h>

namespace snug {

/// A cone of the normals of a patch, or of a piece of one: the directions of S_u x S_v, u and v running from
/// its corner 0 to its corners 1 and 2.
///
/// Guarantee: the piece has a normal at all parameters, extraordinary corners included, and the cone contains
///            it. None where that is not proved.
/// Requires:  no polygon.
/// Cost:      4 to 6 microseconds for a regular patch; with an extraordinary corner 0.1 to 0.6 milliseconds, by ring.
/// Source:    derivations/normals.md.
[[nodiscard]] std::optional<NormalCone> normal_cone(const Patch& piece);

}  // namespace snug
