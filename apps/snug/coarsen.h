#pragma once

#include <snug/search/surface_bvh.h>
#include <snug/tessellate.h>

namespace snug::command {

/// As few triangles as are found within a tolerance of a limit surface, in mesh units: meshoptimizer simplifies
/// `fine`, by several errors of its own, and deviation() judges each result.
///
/// Guarantee: error_bound is that of the deviation, and at most the tolerance. Vertices are some of those of
///            `fine`; without owners. If nothing coarser is near enough, `fine` itself.
/// Requires:  a tessellation whose error_bound is at most the tolerance.
[[nodiscard]] Tessellation coarsened(const SurfaceBvh& surface, const Tessellation& fine, double tolerance,
                                     int threads, const WorkMonitor& monitor);

}  // namespace snug::command
