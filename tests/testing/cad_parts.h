#pragma once

#include <snug/mesh/control_mesh.h>
#include <support/point.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

/// Parts as CAD exports them: few vertices, long triangles, faces that are meant as they are.
namespace snug::testing {

using Ids = std::vector<std::uint32_t>;

inline void add_face(ControlMesh& mesh, const Ids& ids) {
  std::vector<VertexId> corners;
  for (const std::uint32_t v : ids) corners.emplace_back(v);
  mesh.add_face(corners);
}

/// Two faces that close a prism over a counter-clockwise outline: as polygons, or as fans around corner
/// `centre`.
inline void add_caps(ControlMesh& mesh, const Ids& low, const Ids& high, bool triangles, std::size_t centre) {
  const std::size_t n = low.size();
  if (!triangles) {
    add_face(mesh, Ids(low.rbegin(), low.rend()));
    add_face(mesh, high);
    return;
  }
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const std::size_t a = centre, b = (centre + k) % n, c = (centre + k + 1) % n;
    add_face(mesh, {low[a], low[c], low[b]});
    add_face(mesh, {high[a], high[b], high[c]});
  }
}

inline void add_wall(ControlMesh& mesh, const Ids& low, const Ids& high, bool triangles) {
  for (std::size_t k = 0; k < low.size(); ++k) {
    const std::size_t next = (k + 1) % low.size();
    if (triangles) {
      add_face(mesh, {low[k], low[next], high[next]});
      add_face(mesh, {low[k], high[next], high[k]});
    } else {
      add_face(mesh, {low[k], low[next], high[next], high[k]});
    }
  }
}

inline Ids add_ring(ControlMesh& mesh, const std::vector<std::array<double, 2>>& outline, double z) {
  Ids ids;
  for (const auto& [x, y] : outline) {
    ids.push_back(static_cast<std::uint32_t>(mesh.points.size()));
    mesh.points.push_back({x, y, z});
  }
  return ids;
}

/// Over a counter-clockwise outline that corner `centre` sees all of.
inline ControlMesh prism(const std::vector<std::array<double, 2>>& outline, double low, double high,
                         bool triangles, std::size_t centre = 0) {
  ControlMesh mesh;
  const Ids below = add_ring(mesh, outline, low), above = add_ring(mesh, outline, high);
  add_caps(mesh, below, above, triangles, centre);
  add_wall(mesh, below, above, triangles);
  return mesh;
}

inline ControlMesh box(const Point3& low, const Point3& high, bool triangles) {
  return prism({{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}}, low.z, high.z,
               triangles);
}

/// An L of side 4 with arms 2 wide; its notch is at (2, 2).
inline ControlMesh l_prism(bool triangles) {
  return prism({{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}, 0, 1, triangles, 3);
}

inline std::vector<std::array<double, 2>> circle(double x, double y, double radius, std::size_t sides) {
  std::vector<std::array<double, 2>> points;
  for (std::size_t k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(sides);
    points.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  return points;
}

inline ControlMesh pin(double radius, double low, double high, std::size_t sides, bool triangles) {
  return prism(circle(0, 0, radius, sides), low, high, triangles);
}

/// A plate of columns x rows squares of side `cell`, each with a round hole of `sides` sides (a multiple of
/// 4), in long triangles.
inline ControlMesh perforated_plate(std::size_t columns, std::size_t rows, double cell, double radius,
                                    double thickness, std::size_t sides) {
  ControlMesh mesh;
  std::vector<std::array<double, 2>> grid;
  for (std::size_t j = 0; j <= rows; ++j) {
    for (std::size_t i = 0; i <= columns; ++i) {
      grid.push_back({cell * static_cast<double>(i), cell * static_cast<double>(j)});
    }
  }
  const Ids low = add_ring(mesh, grid, 0), high = add_ring(mesh, grid, thickness);
  const auto at = [&](std::size_t i, std::size_t j) { return j * (columns + 1) + i; };
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      const auto rim =
          circle(cell * (static_cast<double>(i) + 0.5), cell * (static_cast<double>(j) + 0.5), radius, sides);
      const Ids rim_low = add_ring(mesh, rim, 0), rim_high = add_ring(mesh, rim, thickness);
      const std::array<std::size_t, 4> corner{at(i + 1, j + 1), at(i, j + 1), at(i, j), at(i + 1, j)};
      for (std::size_t k = 0; k < sides; ++k) {
        const std::size_t next = (k + 1) % sides, q = k * 4 / sides, q_next = next * 4 / sides;
        add_face(mesh, {high[corner[q]], rim_high[next], rim_high[k]});
        add_face(mesh, {low[corner[q]], rim_low[k], rim_low[next]});
        if (q == q_next) continue;
        add_face(mesh, {high[corner[q]], high[corner[q_next]], rim_high[next]});
        add_face(mesh, {low[corner[q]], rim_low[next], low[corner[q_next]]});
      }
      add_wall(mesh, Ids(rim_low.rbegin(), rim_low.rend()), Ids(rim_high.rbegin(), rim_high.rend()), true);
    }
  }
  Ids outline;
  for (std::size_t i = 0; i < columns; ++i) outline.push_back(static_cast<std::uint32_t>(at(i, 0)));
  for (std::size_t j = 0; j < rows; ++j) outline.push_back(static_cast<std::uint32_t>(at(columns, j)));
  for (std::size_t i = columns; i > 0; --i) outline.push_back(static_cast<std::uint32_t>(at(i, rows)));
  for (std::size_t j = rows; j > 0; --j) outline.push_back(static_cast<std::uint32_t>(at(0, j)));
  Ids above;
  for (const std::uint32_t v : outline) above.push_back(high[v]);
  add_wall(mesh, outline, above, true);
  return mesh;
}

/// Turned at random about the origin and moved; then rounded to floats, as an STL file has them.
template <class Random>
ControlMesh turned(ControlMesh mesh, Random& random, bool floats, double shift = 0) {
  std::normal_distribution<double> normal;
  double q[4], norm = 0;
  for (double& x : q) {
    x = normal(random);
    norm += x * x;
  }
  for (double& x : q) x /= std::sqrt(norm);
  const double w = q[0], i = q[1], j = q[2], k = q[3];
  for (Point3& p : mesh.points) {
    p = {(1 - 2 * (j * j + k * k)) * p.x + 2 * (i * j - k * w) * p.y + 2 * (i * k + j * w) * p.z + shift,
         2 * (i * j + k * w) * p.x + (1 - 2 * (i * i + k * k)) * p.y + 2 * (j * k - i * w) * p.z,
         2 * (i * k - j * w) * p.x + 2 * (j * k + i * w) * p.y + (1 - 2 * (i * i + j * j)) * p.z};
    if (floats) {
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = static_cast<float>(p[axis]);
    }
  }
  return mesh;
}

}  // namespace snug::testing
