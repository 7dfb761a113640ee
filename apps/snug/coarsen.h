#pragma once

#include <snug/tessellate.h>

namespace snug::command {

/// As few triangles as are found within an error of a limit surface: meshoptimizer simplifies tessellations,
/// by several errors of its own, and deviation() judges each result.
///
/// Guarantee: error_bound is that of the deviation, and at most the error. Vertices are limit points up to
///            position_error; without owners. If nothing coarser is near enough, the tessellation itself, whose
///            outcome may not be `complete`.
/// Requires:  `how` with an error, and no other goal; a monitor.
[[nodiscard]] Tessellation coarsened(const Surface& surface, TessellateOptions how, const Run& run);

}  // namespace snug::command
