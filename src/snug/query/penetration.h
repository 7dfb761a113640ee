#pragma once

#include <snug/collide.h>
#include <snug/search/workspace.h>

namespace snug {

/// penetration() of surfaces whose trees and workspaces are at hand.
/// Requires:  two workspaces.
[[nodiscard]] Penetration penetration(const PlacedBvh& a, const PlacedBvh& b,
                                      const PenetrationOptions& options = {},
                                      const WorkMonitor& monitor = {});

}  // namespace snug
