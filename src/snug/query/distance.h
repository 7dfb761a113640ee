#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <snug/search/answers.h>
#include <snug/search/precision.h>
#include <snug/search/workspace.h>

namespace snug {

/// How far two surfaces are from each other, in mesh units and world coordinates.
struct Distance {
  double lower = 0, upper = 0;    ///< bounds of the distance; both 0 where contact is proved
  bool reached = false;           ///< are they as near as was asked for?
  std::array<Point3, 2> witness;  ///< two points as near as were found, on A and on B
  double witness_error =
      0;             ///< upper bound, a coordinate, of how far one is from the limit point it stands for
  WitnessPlaces at;  ///< where the witnesses lie, as in Collision
  std::optional<std::size_t> inner;  ///< with `solid`: as in Collision
  SearchStats stats;
};

/// Distance of two placed limit surfaces.
///
/// Pairs of nodes are opened, the nearest first. Limit points at the nearest parameters of base triangles bound it from
/// above; planes across the direction of the nearest ones, which hold pieces' hulls apart, from below. Where pieces cut each other, contact is proved as in collide().
///
/// Guarantee: lower <= distance <= upper for these very doubles, also where precision is not reached. The result depends on
///            the input alone, not on threads or earlier queries.
/// Errors:    InputError (value) for a precision that is negative or not finite, and scratches that are not of their
///            models; (unrepresentable) if a result does not fit a double; (refused) with `solid` if a surface is not
///            closed, wherever it is; Interrupted.
/// Cost:      some 200 microseconds at 0.1 % of the size (bench/results/distance.txt).
[[nodiscard]] Distance distance(const PlacedBvh& a, const PlacedBvh& b, const DistanceOptions& options,
                                const WorkMonitor& monitor = {});

}  // namespace snug
