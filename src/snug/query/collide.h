#pragma once

#include <snug/collide.h>
#include <snug/search/workspace.h>

namespace snug {

/// collide() of surfaces whose trees and workspaces are at hand.
///
/// Both trees are opened from their roots on, deepest overlap first. A pair of pieces is (a) dropped once sets around them
/// are farther apart than the margin; (b) a witness if the limit points at the nearest parameters of its base triangles are
/// near enough, or a proof that one crosses the other; (c) else its larger piece is split, below half the tolerance too.
[[nodiscard]] Collision collide(const PlacedBvh& a, const PlacedBvh& b, const CollideOptions& options,
                                const WorkMonitor& monitor = {});

}  // namespace snug
