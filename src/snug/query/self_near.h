#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <snug/geometry.h>
#include <snug/run.h>
#include <snug/search/surface_bvh.h>
#include <snug/surface/level_complex.h>

namespace snug {

/// Definition of near, in scaled units.
struct NearnessOptions {
  double tolerance = 0;  ///< places at most this far apart are near
  double radius = 0;     ///< if their distance along the surface is more than this
  std::uint64_t budget = 0;
  unsigned levels = 0;  ///< at most, below the coarsest one
  int threads = 0;
};

/// Two pieces that have points near each other, or are not known not to.
struct ProximityPair {
  std::array<PieceName, 2> pieces;
  std::array<TriangleParameter, 2> at;  ///< of each, two points
  Interval distance;                    ///< from that of the pieces to that of the points
};

struct Nearness {
  std::vector<ProximityPair> near;        ///< proved to be
  std::vector<ProximityPair> unresolved;  ///< none if all others are proved not to be
  std::uint64_t stars = 0, pair_tests = 0;
  unsigned levels = 0;
  bool budget_spent = false;  ///< a larger budget might leave fewer unresolved
};

/// Are places of a surface near each other that are far from each other along it?
///
/// Guarantee: `near` in exact arithmetic; if both lists are empty, all points at most `tolerance` apart have a
///            distance along the surface of at most `radius`. Results do not depend on threads.
/// Requires:  0 < tolerance, 2 tolerance <= radius, both finite and at most about 1e100.
/// Errors:    Interrupted.
/// Source:    derivations/self_contact.md, "Nearness".
[[nodiscard]] Nearness find_nearness(const SurfaceBvh& model, const LevelComplex& complex,
                                     const NearnessOptions& options, const WorkMonitor& monitor);

}  // namespace snug
