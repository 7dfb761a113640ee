#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <snug/surface.h>

namespace snug {

struct DeviationOptions {
  /// > 0, mesh units: largest width of the intervals. Default: 0.01 % of the surface's size.
  std::optional<double> absolute{};
  /// >= 0, mesh units: only decide which distances exceed this; stop as soon as all are decided.
  std::optional<double> threshold{};
  /// For a closed surface: also bound how far the candidate lies inside and outside its solid.
  bool solid = false;
};

/// The greatest distance from a point of one set to the other set, in mesh units: a one-sided Hausdorff
/// distance.
struct OneSidedDistance {
  Interval distance;  ///< contains the exact distance
  LimitPoint
      from;   ///< the farthest point found, at least the lower end away; `at` is set if its set is a surface
  Point3 to;  ///< a point of the other set near it
};

/// How far a limit surface and a candidate meant to replace it deviate from each other.
struct Deviation {
  OneSidedDistance from_surface;    ///< from points of the surface to the candidate
  OneSidedDistance from_candidate;  ///< from points of the candidate to the surface
  /// With `solid`: from the candidate's points inside, and from those outside; 0 if there are none.
  std::optional<OneSidedDistance> inside{}, outside{};
  /// `complete` if each interval is as narrow as requested or, with a threshold, each comparison is decided.
  Outcome outcome = Outcome::complete;
};

/// The two one-sided Hausdorff distances between a limit surface and any triangles: in any order and
/// orientation, open, crossing each other, degenerate.
///
/// Guarantee: each interval contains the exact distance for the given doubles, whatever the outcome.
/// Budget:    50,000,000 parts compared in each direction; 100 bytes each at most, and 100 MB.
/// Errors:    InputError: (value) without triangles, for a corner that is not finite, a negative
///            threshold, or a precision that is not positive or below 2^-38 of the largest coordinate;
///            (refused) if no face of the mesh has a limit surface, and with `solid` if it is not closed;
///            (unrepresentable) if a result does not fit a double. Interrupted.
/// Cost:      grows with triangles and patches, and with the square root of size over precision: see
///            bench/results/deviation.txt. 400 bytes a triangle.
/// Source:    derivations/deviation.md.
[[nodiscard]] SNUG_API Deviation deviation(const Surface& surface, std::span<const Triangle> candidate,
                                           const DeviationOptions& options = {}, const Run& run = {});

/// The same between two limit surfaces.
[[nodiscard]] SNUG_API Deviation deviation(const Surface& surface, const Surface& candidate,
                                           const DeviationOptions& options = {}, const Run& run = {});

}  // namespace snug
