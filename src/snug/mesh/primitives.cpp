#include <snug/mesh/primitives.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <support/direction.h>

namespace snug {
namespace {

// More than all roundings, relative to the radius.
constexpr double slack = 1e-12;

void add_triangle(ControlMesh& mesh, std::size_t a, std::size_t b, std::size_t c) {
  mesh.add_face(std::array{VertexId(a), VertexId(b), VertexId(c)});
}

}  // namespace

ControlMesh box_mesh(const Vector3& sides) {
  ControlMesh mesh;
  mesh.tags.scheme = Scheme::flat;
  for (std::size_t v = 0; v < 8; ++v) {
    Point3 p;
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = ((v >> axis & 1u) != 0 ? 0.5 : -0.5) * sides[axis];
    mesh.points.push_back(p);
  }
  // Each side across an axis: its lower corner, and the two other axes in the order that faces outwards.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t own = std::size_t{1} << axis, u = std::size_t{1} << (axis + 1) % 3,
                      w = std::size_t{1} << (axis + 2) % 3;
    add_triangle(mesh, own, own + u, own + u + w);
    add_triangle(mesh, own, own + u + w, own + w);
    add_triangle(mesh, 0, w, u + w);
    add_triangle(mesh, 0, u + w, u);
  }
  return mesh;
}

OuterMesh cylinder_mesh(double radius, double length, double error) {
  // Around the circle: 1 / cos(pi / n) - 1 is near pi^2 / (2 n^2).
  std::size_t n = std::max<std::size_t>(8, static_cast<std::size_t>(std::numbers::pi / std::sqrt(2 * error)));
  const auto outer = [&] { return (1 + slack) / std::cos(std::numbers::pi / static_cast<double>(n)); };
  while (outer() - 1 + slack > error) ++n;
  OuterMesh result;
  result.outward = (outer() - 1 + slack) * radius;
  ControlMesh& mesh = result.mesh;
  mesh.tags.scheme = Scheme::flat;
  for (const double z : {-length / 2, length / 2}) {
    for (std::size_t k = 0; k < n; ++k) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
      mesh.points.push_back({outer() * radius * std::cos(angle), outer() * radius * std::sin(angle), z});
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t next = (k + 1) % n;
    add_triangle(mesh, k, next, n + next);
    add_triangle(mesh, k, n + next, n + k);
    if (k < 2) continue;
    add_triangle(mesh, 0, k, k - 1);
    add_triangle(mesh, n, n + k - 1, n + k);
  }
  return result;
}

OuterMesh sphere_mesh(double radius, double error) {
  // An icosahedron, its triangles cut in four until they are near enough.
  const double g = std::numbers::phi;
  std::vector<Vector3> points{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Vector3& p : points) p = normalized(p);
  std::vector<std::array<std::size_t, 3>> faces{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                                {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                                {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                                {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  // The least distance of a facet's plane from the origin.
  const auto inner = [&] {
    double least = 1;
    for (const auto& [a, b, c] : faces) {
      const Vector3 normal = normalized(cross(points[b] - points[a], points[c] - points[a]));
      least = std::min(least, dot(normal, points[a]));
    }
    return least;
  };
  double least = inner();
  while ((1 + slack) / least - 1 + 2 * slack > error) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
    const auto middle = [&](std::size_t a, std::size_t b) {
      const auto [known, fresh] = middles.emplace(std::minmax(a, b), points.size());
      if (fresh) points.push_back(normalized(points[a] + points[b]));
      return known->second;
    };
    std::vector<std::array<std::size_t, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const std::size_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const std::array<std::size_t, 3>& face :
           {std::array{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}}) {
        finer.push_back(face);
      }
    }
    faces = std::move(finer);
    least = inner();
  }
  const double outer = (1 + slack) / least;
  OuterMesh result;
  result.outward = (outer - 1 + 2 * slack) * radius;
  result.mesh.tags.scheme = Scheme::flat;
  for (const Vector3& p : points) result.mesh.points.push_back(Point3{} + (outer * radius) * p);
  for (const auto& [a, b, c] : faces) add_triangle(result.mesh, a, b, c);
  return result;
}

}  // namespace snug
