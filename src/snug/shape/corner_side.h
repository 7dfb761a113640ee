#pragma once

#include <snug/patch/patch.h>

namespace snug {

/// Of a patch one corner of which stays in place, and has the value 0: are all others proved to be positive? Values are the points' x.
///
/// Guarantee: true only if they are, in exact arithmetic.
/// Source:    derivations/self_contact.md, "Pairs at one vertex".
[[nodiscard]] bool certainly_positive_but_at_corner(const Patch& values, unsigned corner);

}  // namespace snug
