#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <snug/time_of_contact.h>

namespace snug {

/// How narrow the interval of each span must become, as in Precision; by default 0.1 % of the larger surface's size, or
/// 10 % of the distance if that is more. Never below 2^-36 of the size.
struct ClearanceOptions {
  std::optional<double> absolute{};  ///< >= 0, mesh units
  std::optional<double> relative{};  ///< >= 0
  bool solid = false;  ///< compare the solids that closed surfaces bound: 0 apart where they meet
};

/// A part of a motion.
struct ClearanceSpan {
  Interval time;      ///< from its beginning to its end
  Interval distance;  ///< contains the least distance at all times in it, both ends included
};

/// How far apart two surfaces are while they move, in mesh units.
struct Clearance {
  Interval distance;                     ///< contains the least distance of the whole motion
  double time = 0;                       ///< a time at which they are at most distance.upper apart
  WitnessPoints witness;                 ///< the two closest points found at that time
  std::optional<std::size_t> contained;  ///< with `solid`: as in Collision, at that time
  /// From 0 to the end of the motion, each from where the one before it ends.
  std::vector<ClearanceSpan> spans;
  Outcome outcome = Outcome::complete;  ///< `complete` if each span is as narrow as requested
  int steps = 0;                        ///< number of times evaluated
  SearchStats stats;
};

/// How far apart do two moving limit surfaces stay? An envelope of their distance over time, proved between samples, too.
///
/// Guarantee: at each time of a span the surfaces (with `solid` the solids) are at least its lower end apart, for the exact
///            motions, and at some time of it at most its upper end, whatever the outcome.
/// Budget:    1,000,000 in each unit of time, in the unit of time_of_contact(). Spans with the least lower ends come first.
/// Requires:  motions of the same duration, or one surface that stays.
/// Errors:    those of time_of_contact(), of a precision instead of a tolerance.
/// Cost:      a distance query for each time evaluated, at most some twice as many as the way that points move against each
///            other is longer than the precision; a few where they slide past each other.
/// Source:    derivations/time_of_contact.md, "Clearance".
[[nodiscard]] SNUG_API Clearance clearance(const Surface& a, const Trajectory& motion_a, const Surface& b,
                                           const Trajectory& motion_b, const ClearanceOptions& options = {},
                                           const Run& run = {});

/// The same for moving control points, as in time_of_contact().
[[nodiscard]] SNUG_API Clearance clearance(const DeformingSurface& a, const DeformingSurface& b,
                                           const ClearanceOptions& options = {}, const Run& run = {});

}  // namespace snug
