#pragma once

#include <optional>

#include <snug/query/collide.h>

namespace snug {

/// How often a closed limit surface winds around a point: 0 outside, 1 inside of a surface whose faces are
/// counter-clockwise from outside.
///
/// Where no set around a piece holds the point, the surface is replaced by triangles of limit corners, with a third
/// triangle over each edge where a piece is split; signed crossings of a ray with these are counted.
///
/// Guarantee: right for every point within `error` of `point`; nothing where that cannot be told, as on the surface.
/// Requires:  closed: require_closed(); point in scaled units of the surface.
/// Cost:      a walk along a ray; more pieces are split the nearer the point is to the surface.
/// Source:    derivations/contact.md.
[[nodiscard]] std::optional<int> winding_number(QueryScratch& scratch, const Point3& point, double error,
                                                const WorkMonitor& monitor = {});

/// Throws InputError (refused), naming a face, unless every edge of the surface's mesh has two faces that run along it in
/// opposite directions, and all have a limit surface.
void require_closed(const Surface& surface);

/// What `apart`, separated surfaces, is for the solids that they bound: intersecting if a component of one lies inside the
/// other, undecided where that cannot be told.
/// Errors:    those of require_closed().
[[nodiscard]] Collision as_solids(const PlacedModel& a, const PlacedModel& b, Collision apart,
                                  const WorkMonitor& monitor = {});

}  // namespace snug
