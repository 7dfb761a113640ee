#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include <snug/search/surface_workspace.h>

namespace snug {

/// Calls ask(scratch, i) for each of many points, on the threads, one scratch each. Points follow one another
/// along a curve that fills their box (Morton's): those that lie together need few pieces.
///
/// Requires:  fewer than 2^32 points. Those that are not finite may come anywhere.
/// Errors:    what `ask` throws ends the loop and is thrown again, of several one; Interrupted.
void for_each_point(const SurfaceBvh& model, std::span<const Point3> points, int threads,
                    const WorkMonitor& monitor,
                    const std::function<void(SurfaceWorkspace&, std::size_t)>& ask);

}  // namespace snug
