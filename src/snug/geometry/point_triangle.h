#pragma once

#include <snug/geometry/triangle.h>

namespace snug {

/// How far a point is from a triangle.
struct PointTriangleDistance {
  double lower, upper;  ///< contain the distance
  Barycentric foot;     ///< of a point that is at most `upper` away: b, c >= 0 and b + c <= 1, exactly
};

/// The distance of a point from a triangle, which may be a needle or a point.
///
/// Guarantee: `lower` and `upper` hold for the given doubles, and are apart by 64 roundings of the distance and `size`
///            together; where doubles leave more open, double-doubles are tried. Without a size these leave 32 roundings of
///            the distance, unless the triangle reaches 2^40 times as far.
/// Requires:  finite coordinates of at most 2^42; `size` >= 0.
/// Cost:      100 ns; a microsecond in double-doubles.
/// Source:    derivations/closest.md, "Facets".
[[nodiscard]] PointTriangleDistance distance_between(const Point3& point, const Triangle& triangle,
                                                     double size);

/// How well a triangle faces a point whose nearest point on it is `foot`: of facets that share this point the one that faces
/// it best has it on the same side as the surface has. Larger is better; parts are equal up to roundings.
struct Facing {
  double steepness =
      0;  ///< cosine of the least angle between the way to the point and the triangle's edges, at a corner
  double cosine = 1;  ///< of the angle between that way and the normal, without its sign

  [[nodiscard]] bool better_than(const Facing& other) const {
    constexpr double equal = 0x1p-40;
    if (steepness > other.steepness + equal) return true;
    return steepness >= other.steepness - equal && cosine > other.cosine;
  }
};
[[nodiscard]] Facing facing(const Point3& point, const Triangle& triangle, Barycentric foot);

}  // namespace snug
