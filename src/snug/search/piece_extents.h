#pragma once

#include <ranges>

#include <snug/bounds/enclosure.h>
#include <snug/bvh/obb.h>

namespace snug {

/// Bounds of dot(direction, x - from) over a patch known by points whose hull holds it.
[[nodiscard]] Extent extent_of(const HullPoints& hull, const Vector3& direction, const Point3& from = {});
/// Bounds of dot(direction, x) over an offset triangle.
[[nodiscard]] Extent extent_of(const OffsetTriangle& triangle, const Vector3& direction);

/// A box with given axes around hulls, or around offset triangles.
template <std::ranges::range Sets>
[[nodiscard]] Obb box_around(const std::array<Vector3, 3>& axes, const Sets& sets) {
  return fit_box(axes, [&](const Vector3& axis) {
    Extent all;
    for (const auto& set : sets) all.add(extent_of(set, axis));
    return all;
  });
}

}  // namespace snug
