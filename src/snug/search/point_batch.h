#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include <snug/search/workspace.h>

namespace snug {

/// Calls ask(pieces, i) for each of many points, on the threads of a run. Points follow one another along a curve that fills
/// their box (Morton's): those that lie together need few pieces.
///
/// Requires:  fewer than 2^32 points. Those that are not finite may come anywhere.
/// Errors:    what `ask` throws ends the loop and is thrown again, of several one; Interrupted.
void for_each_point(const Surface& surface, std::span<const Point3> points, const Run& run,
                    const std::function<void(PieceCache&, std::size_t)>& ask);

}  // namespace snug
