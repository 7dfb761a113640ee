#pragma once

#include <optional>

#include <snug/search/piece_cache.h>

namespace snug {

/// How often a closed limit surface winds around a point: 0 outside, 1 inside of a surface whose faces are
/// counter-clockwise from outside.
///
/// Where no set around a piece holds the point, the surface is replaced by triangles of limit corners, with a
/// third triangle over each edge where a piece is split; signed crossings of a ray with these are counted.
///
/// Guarantee: right for every point within `error` of `point`; nothing where that cannot be decided, as on the
///            surface. Depends on the point and the surface alone.
/// Requires:  point and error in scaled units of the surface.
/// Errors:    those of SurfaceBvh::solid().
/// Source:    derivations/contact.md.
[[nodiscard]] std::optional<int> winding_number(PieceCache& cache, const Point3& point, double error,
                                                const WorkMonitor& monitor = {});

}  // namespace snug
