#pragma once

#include <snug/bounds/bounding_points.h>
#include <snug/geometry/triangle.h>

namespace snug {

/// Bounding prism of [Kobbelt98]: the triangle of the limit corners, shifted along its normal to the least
/// and the greatest height of the patch. Kept for comparison only.
///
/// It is NOT a bound: the patch may leave it sideways, where its boundary curves bulge out over the edges.
struct Prism {
  Triangle lower, upper;
};

/// Errors:    a triangle without a normal gives lower == upper.
[[nodiscard]] Prism kobbelt_prism(const BoundingPoints& points, const std::array<Vector3, 3>& corners);

/// How far a point lies outside the prism: 0 inside, else its largest distance to a facet's plane that it is
/// beyond.
[[nodiscard]] double distance_outside(const Prism& prism, const Point3& p);

}  // namespace snug
