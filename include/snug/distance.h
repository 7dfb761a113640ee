#pragma once

#include <snug/collide.h>

namespace snug {

/// How narrow the interval of a distance must become: upper - lower <= max(absolute, relative * upper). If
/// only one is given the other is 0; if neither is given `absolute` is 0.01 % of the (larger) surface's size.
struct DistanceOptions {
  std::optional<double> absolute{};  ///< >= 0, mesh units
  std::optional<double> relative{};  ///< >= 0
  std::uint64_t budget = 1'000'000;  ///< most splits; memory: 200 bytes each
  bool solid = false;  ///< compare the solids that closed surfaces bound: 0 apart where they meet
};

/// How far apart two surfaces are, in mesh units and world coordinates.
struct Distance {
  Interval distance;                 ///< contains the distance; [0, 0] if contact is proved
  bool reached = false;              ///< is it as narrow as requested?
  std::array<Point3, 2> witness;     ///< the two closest points found, on A and on B
  double witness_error = 0;          ///< as in Collision
  WitnessPlaces at;                  ///< as in Collision
  std::optional<std::size_t> inner;  ///< with `solid`: as in Collision
  SearchStats stats;
};

/// The distance of two placed limit surfaces.
///
/// Guarantee: `distance` contains the exact distance for the given doubles, whether the precision is reached or not.
/// Errors:    InputError: (value) for a precision that is negative or not finite; (unrepresentable) if a
///            result does not fit a double; (refused) if no face of a mesh has a limit surface, and with
///            `solid` if a surface is not closed. Interrupted.
/// Cost:      about 200 microseconds at 0.1 % of the size (bench/results/distance.txt).
[[nodiscard]] SNUG_API Distance distance(const PlacedSurface& a, const PlacedSurface& b,
                                         const DistanceOptions& options = {}, const WorkMonitor& monitor = {},
                                         Workspace& workspace = Workspace::of_this_thread());

/// The same bits for many poses, in the same order, on any number of threads (0: all cores).
[[nodiscard]] SNUG_API std::vector<Distance> distance(const Surface& a, const Surface& b,
                                                      std::span<const PosePair> poses,
                                                      const DistanceOptions& options = {}, int threads = 0,
                                                      const WorkMonitor& monitor = {});

}  // namespace snug
