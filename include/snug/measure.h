#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <snug/surface.h>

namespace snug {

struct MeasureOptions {
  /// >= 0: relative width of the intervals, see Measures::outcome. Default: 0.0001.
  std::optional<double> relative{};
};

/// Area of a surface, and volume, centroid and inertia of the solid that it bounds, in mesh units.
///
/// The solid's density is the winding number: 1 inside, 2 where parts of the surface overlap, negative where
/// faces look clockwise from outside.
struct Measures {
  Interval area;
  /// Empty unless the surface is closed: along every edge of the mesh as many faces run in one direction as
  /// in the other, and all faces have a limit surface.
  std::optional<Interval> volume;
  /// The next two are also empty where the volume may be 0.
  std::optional<std::array<Interval, 3>> centroid;
  /// About the centroid, with density 1 and the coordinate axes: the moments about x, y, z, then the products
  /// xy, yz, zx of the inertia tensor, which are minus the integrals of xy, yz, zx.
  std::optional<std::array<Interval, 6>> inertia;
  /// `complete` if each interval's width is at most `relative` times: the area; |volume|; for the centroid, the size;
  /// for the inertia, the largest entry. Areas, volumes and entries below `relative` times size^2, size^3 and
  /// size^5 count as these.
  Outcome outcome = Outcome::complete;
  std::uint64_t splits = 0;
};

/// Measures of a limit surface.
///
/// Guarantee: each interval contains the exact value for the given doubles, whatever the outcome.
/// Budget:    10,000,000 splits, an equal share for each patch; no memory.
/// Errors:    InputError: (value) for a precision that is negative or not finite; (refused) if no face of
///            the mesh has a limit surface, or with Midedge beside a face of several hundred corners;
///            (unrepresentable) if a result does not fit a double. Interrupted.
/// Cost:      at the default precision 10 microseconds a regular patch, and 0.1 ms for each extraordinary corner
///            of a patch. Each further digit costs about 0.03 ms a corner.
/// Source:    derivations/measures.md.
[[nodiscard]] SNUG_API Measures measure(const Surface& surface, const MeasureOptions& options = {},
                                        const Run& run = {});

}  // namespace snug
