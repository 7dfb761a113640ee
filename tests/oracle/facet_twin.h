#pragma once

#include <oracle/twin_mesh.h>

#include <vector>

namespace oracle {

/// What two triangles have in common beside the vertices that both name and the edge between two of these.
enum class FacetRelation { none, crossing, overlapping, touching };

/// By cutting the one with the plane and the sides of the other, in rational arithmetic.
/// Requires:  finite coordinates; triangles with area.
[[nodiscard]] FacetRelation relation_of(const std::vector<Point>& points, const Triangle& a,
                                        const Triangle& b);
[[nodiscard]] bool has_area(const std::vector<Point>& points, const Triangle& t);

}  // namespace oracle
