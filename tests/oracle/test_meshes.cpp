#include <oracle/test_meshes.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace oracle::meshes {

TwinMesh octahedron() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

TwinMesh icosahedron() {
  TwinMesh mesh;
  const double height = 1 / std::sqrt(5.0), radius = 2 * height;
  mesh.points = {{0, 0, 1}, {0, 0, -1}};
  for (std::uint32_t k = 0; k < 5; ++k) {
    const double angle = 2 * std::numbers::pi * k / 5, turned = angle + std::numbers::pi / 5;
    mesh.points.push_back({radius * std::cos(angle), radius * std::sin(angle), height});
    mesh.points.push_back({radius * std::cos(turned), radius * std::sin(turned), -height});
  }
  for (std::uint32_t k = 0; k < 5; ++k) {
    const std::uint32_t up = 2 + 2 * k, low = up + 1, next_up = 2 + 2 * ((k + 1) % 5), next_low = next_up + 1;
    mesh.triangles.insert(
        mesh.triangles.end(),
        {{0, up, next_up}, {up, low, next_up}, {next_up, low, next_low}, {1, next_low, low}});
  }
  return mesh;
}

TwinMesh grid(std::uint32_t columns, std::uint32_t rows, Boundary boundary) {
  TwinMesh mesh;
  mesh.boundary = boundary;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i) mesh.points.push_back({double(i), double(j), 0});
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i, d = a + columns + 1;
      mesh.triangles.insert(mesh.triangles.end(), {{a, a + 1, d + 1}, {a, d + 1, d}});
    }
  return mesh;
}

TwinMesh bipyramid(std::uint32_t n) {
  TwinMesh mesh;
  mesh.points = {{0, 0, 1}, {0, 0, -1}};
  for (std::uint32_t k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * k / n;
    mesh.points.push_back({std::cos(angle), std::sin(angle), 0});
    const std::uint32_t a = 2 + k, b = 2 + (k + 1) % n;
    mesh.triangles.insert(mesh.triangles.end(), {{0, a, b}, {1, b, a}});
  }
  return mesh;
}

TwinMesh wheel(std::uint32_t n, Boundary boundary) {
  TwinMesh mesh;
  mesh.boundary = boundary;
  mesh.points = {{0, 0, 1}};
  for (std::uint32_t k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * k / n;
    mesh.points.push_back({std::cos(angle), std::sin(angle), 0});
    mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % n});
  }
  return mesh;
}

TwinMesh disturbed(TwinMesh mesh, int count, double amount, std::mt19937_64& random) {
  for (int i = 0; i < count; ++i) {
    const std::size_t f = random() % mesh.triangles.size();
    const Triangle t = mesh.triangles[f];
    Point middle{};
    for (std::size_t x = 0; x < 3; ++x)
      middle[x] = (mesh.points[t[0]][x] + mesh.points[t[1]][x] + mesh.points[t[2]][x]) / 3;
    const auto m = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back(middle);
    mesh.triangles[f] = {t[0], t[1], m};
    mesh.triangles.push_back({t[1], t[2], m});
    mesh.triangles.push_back({t[2], t[0], m});
  }
  std::uniform_real_distribution<double> offset(-amount, amount);
  for (Point& p : mesh.points)
    for (double& x : p) x += offset(random);
  return mesh;
}

TwinMesh quartered(const TwinMesh& mesh) {
  TwinMesh fine{mesh.points, {}, mesh.boundary};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.points.size()));
    if (is_new) {
      const Point &p = mesh.points[a], &q = mesh.points[b];
      fine.points.push_back({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
    }
    return at->second;
  };
  for (const Triangle& t : mesh.triangles) {
    const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
    fine.triangles.insert(fine.triangles.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {b, c, a}});
  }
  return fine;
}

}  // namespace oracle::meshes
