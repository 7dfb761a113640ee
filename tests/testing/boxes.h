#pragma once

#include <snug/bvh/obb.h>

#include <vector>

namespace snug::testing {

/// A box around some points with coordinates of about 1 at most, along their principal axes.
[[nodiscard]] inline Obb box_around(const std::vector<Point3>& points) {
  return fit_box(principal_axes(points), [&](const Vector3& direction) {
    Extent all;
    for (const Point3& p : points) {
      const double height = dot(direction, p - Point3{});
      all.add({height - 1e-15, height + 1e-15});
    }
    return all;
  });
}

}  // namespace snug::testing
