#include <oracle/tagged_shapes.h>

#include <cmath>
#include <map>
#include <numbers>

namespace oracle::meshes {

namespace {

using Polygon = std::vector<std::uint32_t>;

Point on_circle(std::uint32_t i, std::uint32_t n, double z) {
  const double angle = 2 * std::numbers::pi * i / n;
  return {std::cos(angle), std::sin(angle), z};
}

}  // namespace

TaggedMesh cube() {
  TaggedMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.points.push_back({double(i & 1), double((i >> 1) & 1), double((i >> 2) & 1)});
  mesh.polygons = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return mesh;
}

TaggedMesh quad_grid(std::uint32_t columns, std::uint32_t rows) {
  TaggedMesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i) mesh.points.push_back({double(i), double(j), 0});
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t c = j * (columns + 1) + i;
      mesh.polygons.push_back({c, c + 1, c + columns + 2, c + columns + 1});
    }
  return mesh;
}

TaggedMesh triangulated(const TaggedMesh& mesh) {
  TaggedMesh result = mesh;
  result.polygons.clear();
  for (const Polygon& p : mesh.polygons)
    for (std::size_t k = 1; k + 1 < p.size(); ++k) result.polygons.push_back({p[0], p[k], p[k + 1]});
  return result;
}

TaggedMesh prism(std::uint32_t n) {
  TaggedMesh mesh;
  Polygon top, bottom;
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.points.push_back(on_circle(i, n, 1));
    mesh.points.push_back(on_circle(i, n, -1));
    const std::uint32_t next = (i + 1) % n;
    mesh.polygons.push_back({2 * i, 2 * i + 1, 2 * next + 1, 2 * next});
    top.push_back(2 * i);
    bottom.insert(bottom.begin(), 2 * i + 1);
  }
  mesh.polygons.push_back(top);
  mesh.polygons.push_back(bottom);
  return mesh;
}

TaggedMesh pyramid(std::uint32_t n) {
  TaggedMesh mesh;
  mesh.points.push_back({0, 0, 1});
  Polygon base;
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.points.push_back(on_circle(i, n, 0));
    mesh.polygons.push_back({0, i + 1, (i + 1) % n + 1});
    base.insert(base.begin(), i + 1);
  }
  mesh.polygons.push_back(base);
  return mesh;
}

TaggedMesh mixed_strip() {
  TaggedMesh mesh;
  mesh.points = {{0, 0, 1},  {2, 0, 0},   {1, 2, 0},   {-1, 2, 0},
                 {-2, 1, 0}, {-2, -1, 0}, {-1, -2, 0}, {1, -2, 0}};
  mesh.polygons = {{0, 1, 2}, {0, 2, 3, 4}, {0, 4, 5, 6, 7}, {0, 7, 1}};
  return mesh;
}

TaggedMesh book(std::uint32_t pages) {
  TaggedMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}};
  for (std::uint32_t i = 0; i < pages; ++i) {
    const std::uint32_t c = static_cast<std::uint32_t>(mesh.points.size());
    for (int z = 0; z < 3; ++z) mesh.points.push_back(on_circle(i, pages, z));
    mesh.polygons.push_back({0, c, c + 1, 1});
    mesh.polygons.push_back({1, c + 1, c + 2, 2});
  }
  return mesh;
}

TaggedMesh two_cubes_at_a_vertex() {
  TaggedMesh mesh = cube();
  for (std::uint32_t i = 1; i < 8; ++i) {
    const Point& p = mesh.points[i];
    mesh.points.push_back({-p[0], -p[1], -p[2]});
  }
  for (std::size_t f = 0; f < 6; ++f) {
    Polygon p;
    for (const std::uint32_t v : mesh.polygons[f]) p.insert(p.begin(), v == 0 ? 0 : v + 7);
    mesh.polygons.push_back(p);
  }
  return mesh;
}

TaggedMesh cells(const std::set<std::array<int, 3>>& corners) {
  TaggedMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> numbers;
  for (const std::array<int, 3>& cell : corners) {
    for (const Polygon& side : cube().polygons) {
      std::array<int, 3> beside = cell;
      for (std::size_t x = 0; x < 3; ++x) {
        int sum = 0;  // of the corners' places: 0 or 4 along the axis that the side is across
        for (const std::uint32_t v : side) sum += static_cast<int>(v >> x & 1U);
        if (sum % 4 == 0) beside[x] += sum == 0 ? -1 : 1;
      }
      if (corners.contains(beside)) continue;
      Polygon face;
      for (const std::uint32_t v : side) {
        std::array<int, 3> at = cell;
        for (std::size_t x = 0; x < 3; ++x) at[x] += static_cast<int>(v >> x & 1U);
        const auto [it, is_new] = numbers.try_emplace(at, static_cast<std::uint32_t>(mesh.points.size()));
        if (is_new)
          mesh.points.push_back(
              {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
        face.push_back(it->second);
      }
      mesh.polygons.push_back(face);
    }
  }
  return mesh;
}

TaggedMesh moebius(std::uint32_t n) {
  TaggedMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double half = std::numbers::pi * i / n;
    for (const double t : {-0.5, 0.5}) {
      Point p = on_circle(i, n, t * std::sin(half));
      for (std::size_t x = 0; x < 2; ++x) p[x] *= 2 + t * std::cos(half);
      mesh.points.push_back(p);
    }
    const std::uint32_t c = 2 * i;
    if (i + 1 < n)
      mesh.polygons.push_back({c, c + 2, c + 3, c + 1});
    else
      mesh.polygons.push_back({c, 1, 0, c + 1});
  }
  return mesh;
}

TaggedMesh back_to_back() {
  TaggedMesh mesh = quad_grid(1, 1);
  mesh.polygons.emplace_back(mesh.polygons[0].rbegin(), mesh.polygons[0].rend());
  return mesh;
}

TaggedMesh valence_two_inside() {
  TaggedMesh mesh = quad_grid(3, 3);
  // The middle quad (5, 6, 10, 9) becomes two that share the path 5, 16, 10.
  mesh.points.push_back({1.5, 1.5, 1});
  mesh.polygons[4] = {5, 6, 10, 16};
  mesh.polygons.push_back({5, 16, 10, 9});
  return mesh;
}

TaggedMesh vertices_twice() {
  TaggedMesh mesh = quad_grid(3, 3);
  mesh.points.push_back({4, 4, 1});
  for (const std::vector<std::uint32_t>& face :
       {std::vector<std::uint32_t>{5, 6, 6}, {9, 9, 10}, {6, 6, 6}, {1, 16, 1}}) {
    mesh.polygons.push_back(face);
  }
  return mesh;
}

TaggedMesh same_ways() {
  TaggedMesh mesh = quad_grid(4, 1);
  for (const std::vector<std::uint32_t>& face : {std::vector<std::uint32_t>{0, 3, 1},
                                                 {1, 3, 2},
                                                 {1, 4, 2},
                                                 {0, 6, 1},
                                                 {1, 6, 2},
                                                 {2, 4, 1},
                                                 {8, 7, 9}}) {
    mesh.polygons.push_back(face);
  }
  mesh.polygons.erase(mesh.polygons.begin(), mesh.polygons.begin() + 4);
  return mesh;
}

TaggedMesh pole(std::uint32_t n, bool open) {
  TaggedMesh mesh;
  mesh.points.push_back({0, 0, 0.5});
  const std::uint32_t around = 2 * n + (open ? 1 : 0);
  for (std::uint32_t i = 0; i < around; ++i) {
    const double angle = 6.283185307179586 * i / (2 * n + (open ? 4 : 0));
    mesh.points.push_back({std::cos(angle), std::sin(angle), 0.2 * std::sin(3 * angle)});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.polygons.push_back({0, 1 + 2 * i, 2 + 2 * i, open ? 3 + 2 * i : 1 + (2 * i + 2) % around});
  }
  return mesh;
}

TaggedMesh shaken(TaggedMesh mesh, double amount, std::mt19937_64& random) {
  std::uniform_real_distribution<float> step(-1, 1);
  for (Point& p : mesh.points)
    for (double& x : p) x += amount * double(step(random));
  return mesh;
}

}  // namespace oracle::meshes
