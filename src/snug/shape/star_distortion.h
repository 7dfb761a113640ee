#pragma once

#include <span>

#include <snug/shape/star.h>

namespace snug {

/// How much longer are ways along a star than straight ones? For every two points of a star, as parameters,
/// their distance along it is at most this times the distance of their limit points.
///
/// Guarantee: an upper bound of the supremum in exact arithmetic; infinite where none was found.
/// Requires:  as certainly_injective(), star.h.
/// Cost:      about 10 microseconds for six regular patches, a millisecond at an extraordinary corner.
/// Source:    derivations/self_contact.md, "The stretch of a star".
[[nodiscard]] double star_distortion(std::span<const StarSector> sectors, bool closed);

}  // namespace snug
