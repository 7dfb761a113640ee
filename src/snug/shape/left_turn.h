#pragma once

#include <snug/patch/patch.h>

namespace snug {

/// Is the determinant of a patch in the plane proved to be positive at all parameters, but at an extraordinary corner?
///
/// Guarantee: true only if it is, in exact arithmetic.
/// Source:    derivations/self_contact.md, "A star", "At extraordinary corners".
[[nodiscard]] bool turns_left_everywhere(const Patch& patch);

/// The same of a patch at a spike (RingDecay), that corner of it, seen along the spike: in exact values there is nothing of what grows
/// fastest there.
[[nodiscard]] bool turns_left_around_spike(const Patch& patch, unsigned corner);

}  // namespace snug
