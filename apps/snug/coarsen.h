#pragma once

#include <snug/tessellate.h>

namespace snug::command {

/// As few triangles as are found within a tolerance of a limit surface: meshoptimizer simplifies tessellations,
/// by several errors of its own, and deviation() judges each result.
///
/// Guarantee: error_bound is that of the deviation, and at most the tolerance. Vertices are limit points up to
///            position_error; without owners. If nothing coarser is near enough, the tessellation itself, whose
///            `reached` may be false.
/// Requires:  `how` with a tolerance, and no other goal.
[[nodiscard]] Tessellation coarsened(const Surface& surface, TessellateOptions how,
                                     const WorkMonitor& monitor);

}  // namespace snug::command
