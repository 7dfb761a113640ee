#pragma once

#include <snug/distance.h>
#include <snug/search/workspace.h>

namespace snug {

/// distance() of surfaces whose trees and workspaces are at hand.
///
/// Pairs of nodes are opened, the nearest first. Limit points at the nearest parameters of base triangles bound it from
/// above; planes across the direction of the nearest ones, which hold pieces' hulls apart, from below. Where pieces cut each
/// other, contact is proved as in collide().
[[nodiscard]] Distance distance(const PlacedBvh& a, const PlacedBvh& b, const DistanceOptions& options,
                                const WorkMonitor& monitor = {});

}  // namespace snug
