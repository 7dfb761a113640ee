#pragma once

#include <cstdint>

#include <snug/search/workspace.h>

namespace snug {

struct PenetrationOptions {
  double relative =
      0.05;  ///< >= 0; the search ends once the bounds are as near to each other as this share of the upper one
  std::uint64_t budget = 20'000;  ///< most pieces that each collision query of the search opens
};

/// How deep two solids are in each other: the least length of a translation of B that separates them.
struct Penetration {
  double lower = 0;  ///< proved: no shorter translation separates them
  double upper = 0;  ///< proved: an upper bound of the length of `translation`, which does, as doubles add up
  Vector3
      translation;  ///< to be added to that of B's pose; zero where the solids are separated as they stand
  bool reached = false;  ///< are the bounds as near as was asked for?
};

/// Bounds of the penetration depth of two closed, placed surfaces.
///
/// Above: translations are tried along many directions and shortened along the normals of the contact they leave, and each is
/// proved by collide(). Below: two balls around one point, each in one solid, meet after every translation that is shorter
/// than the sum of their radii.
///
/// Guarantee: lower <= depth <= upper; with B's pose so moved the solids are separated. The upper bound is
///            that of the best translation found, a local minimum, and may be far from the depth where parts interlock.
/// Requires:  two scratches.
/// Errors:    those of SurfaceBvh::solid(); InputError (value) for a precision that is negative or not finite,
///            (unrepresentable) if no translation that separates them fits a double; Interrupted.
/// Cost:      some hundred collision and closest-point queries.
/// Source:    derivations/contact.md, "How deep".
[[nodiscard]] Penetration penetration(const PlacedBvh& a, const PlacedBvh& b,
                                      const PenetrationOptions& options = {},
                                      const WorkMonitor& monitor = {});

}  // namespace snug
