#pragma once

#include <oracle/twin_mesh.h>

#include <gmpxx.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace oracle {

/// A closed polyhedron of triangles, asked in exact rational arithmetic.
///
/// Requires:  edges with two triangles each that run along them in opposite directions.
class PolyhedronTwin {
 public:
  PolyhedronTwin(const std::vector<Point>& points, const std::vector<Triangle>& triangles);

  /// The square of the distance of a point to the surface.
  [[nodiscard]] mpq_class squared_distance(const Point& q) const;

  /// How often the surface winds around a point, by signed crossings of a ray; nothing on the surface.
  [[nodiscard]] std::optional<int> winding(const Point& q) const;

 private:
  using Vector = std::array<mpq_class, 3>;
  std::vector<std::array<Vector, 3>> triangles_;
};

}  // namespace oracle
