#pragma once

#include <snug/deviation.h>
#include <snug/search/surface_bvh.h>
#include <snug/tessellate.h>

namespace snug::command {

/// Triangles that a tessellation was simplified to, and how far they are from the surface.
struct Coarsened {
  Tessellation mesh;  ///< without owners; error_bound is that of the deviation
  Deviation deviation;
};

/// As few triangles as are found within a tolerance of a limit surface, in mesh units: meshoptimizer simplifies
/// `fine`, by several errors of its own, and deviation() judges each result.
///
/// Guarantee: both distances are at most the tolerance. Vertices are some of those of `fine`. If nothing coarser
///            is near enough, `fine` itself.
/// Requires:  a tessellation whose error_bound is at most the tolerance.
[[nodiscard]] Coarsened coarsened(const SurfaceBvh& surface, const Tessellation& fine, double tolerance,
                                  int threads, const WorkMonitor& monitor);

}  // namespace snug::command
