#include <snug/query/corner_nets.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <snug/base/contract.h>

namespace snug {
namespace {

// In [-1, 1), the same on every machine.
double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

Vector3 random_direction(std::mt19937_64& random) {
  for (;;) {
    const double x = unit(random), y = unit(random), z = unit(random);
    const Vector3 v{x, y, z};
    const double size = length_sq(v);
    if (size > 0.01 && size < 1) return (1 / std::sqrt(size)) * v;
  }
}

// x, y -> x e1 + y e2 + sum of a random vector for each monomial of degree 2 and 3, on the disc of radius
// `extent`.
void bend(ControlMesh& mesh, std::uint64_t seed, double extent = 2) {
  std::mt19937_64 random(seed);
  const Vector3 normal = random_direction(random);
  Vector3 e1 = cross(normal, random_direction(random));
  e1 = (1 / length(e1)) * e1;
  const Vector3 e2 = cross(normal, e1);
  std::array<Vector3, 7> coefficients;
  for (Vector3& c : coefficients) {
    const double along_one = 0.15 * unit(random), along_two = 0.15 * unit(random),
                 across = 0.5 * unit(random);
    c = (extent / 2) * (along_one * e1 + along_two * e2 + across * normal);
  }
  for (Point3& p : mesh.points) {
    const double x = p.x / extent, y = p.y / extent;
    const std::array monomials{x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y};
    Vector3 q = p.x * e1 + p.y * e2;
    for (std::size_t i = 0; i < monomials.size(); ++i) q = q + monomials[i] * coefficients[i];
    p = Point3{} + q;
  }
}

// p times spoke s of n and q times the next one.
Point3 between_spokes(std::size_t n, std::size_t s, double p, double q) {
  const double a = 2 * std::numbers::pi * static_cast<double>(s) / static_cast<double>(n);
  const double b = 2 * std::numbers::pi * static_cast<double>(s + 1) / static_cast<double>(n);
  return {p * std::cos(a) + q * std::cos(b), p * std::sin(a) + q * std::sin(b), 0};
}

}  // namespace

ControlMesh fan_mesh(std::size_t n, std::size_t rings) {
  SNUG_EXPECT(n >= 3 && rings >= 1);
  ControlMesh mesh;
  mesh.points.push_back({});
  // Ring i has i vertices a sector.
  const auto at = [&](std::size_t i, std::size_t sector, std::size_t j) {
    return i == 0 ? VertexId(0) : VertexId(1 + n * i * (i - 1) / 2 + (sector * i + j) % (n * i));
  };
  for (std::size_t i = 1; i <= rings; ++i) {
    for (std::size_t s = 0; s < n; ++s) {
      for (std::size_t j = 0; j < i; ++j) {
        const double a = 2 * std::numbers::pi * static_cast<double>(s) / static_cast<double>(n);
        const double b = 2 * std::numbers::pi * static_cast<double>(s + 1) / static_cast<double>(n);
        const double p = static_cast<double>(i - j), q = static_cast<double>(j);
        mesh.points.push_back({p * std::cos(a) + q * std::cos(b), p * std::sin(a) + q * std::sin(b), 0});
      }
    }
  }
  for (std::size_t i = 0; i < rings; ++i) {
    for (std::size_t s = 0; s < n; ++s) {
      for (std::size_t j = 0; j <= i; ++j) {
        mesh.add_face(std::array{at(i, s, j), at(i + 1, s, j), at(i + 1, s, j + 1)});
        if (j < i) mesh.add_face(std::array{at(i, s, j), at(i + 1, s, j + 1), at(i, s, j + 1)});
      }
    }
  }
  return mesh;
}

ControlMesh quad_fan_mesh(std::size_t n, std::size_t rings) {
  SNUG_EXPECT(n >= 3 && rings >= 1);
  ControlMesh mesh;
  mesh.points.push_back({});
  // Sector s holds the places (i, j) with i >= 1 and j >= 0; those with i = 0 belong to the next one.
  for (std::size_t s = 0; s < n; ++s) {
    for (std::size_t i = 1; i <= rings; ++i) {
      for (std::size_t j = 0; j <= rings; ++j) {
        mesh.points.push_back(between_spokes(n, s, static_cast<double>(i), static_cast<double>(j)));
      }
    }
  }
  const auto at = [&](std::size_t s, std::size_t i, std::size_t j) {
    if (i == 0 && j == 0) return VertexId(0);
    if (i == 0) return VertexId(1 + (s + 1) % n * rings * (rings + 1) + (j - 1) * (rings + 1));
    return VertexId(1 + s * rings * (rings + 1) + (i - 1) * (rings + 1) + j);
  };
  for (std::size_t s = 0; s < n; ++s) {
    for (std::size_t i = 0; i < rings; ++i) {
      for (std::size_t j = 0; j < rings; ++j) {
        mesh.add_face(std::array{at(s, i, j), at(s, i + 1, j), at(s, i + 1, j + 1), at(s, i, j + 1)});
      }
    }
  }
  return mesh;
}

ControlMesh polygon_mesh(std::size_t n) {
  SNUG_EXPECT(n >= 3);
  ControlMesh mesh;
  for (const auto& [p, q] : {std::pair{0.5, 0.5}, {1.5, 0.5}, {1.5, 1.5}, {0.5, 1.5}}) {
    for (std::size_t s = 0; s < n; ++s) mesh.points.push_back(between_spokes(n, s, p, q));
  }
  const auto at = [&](std::size_t place, std::size_t s) { return VertexId(place * n + s % n); };
  std::vector<VertexId> middle;
  for (std::size_t s = 0; s < n; ++s) middle.push_back(at(0, s));
  mesh.add_face(middle);
  for (std::size_t s = 0; s < n; ++s) {
    mesh.add_face(std::array{at(0, s), at(1, s), at(2, s), at(3, s)});
    mesh.add_face(std::array{at(0, s), at(3, s), at(1, s + 1), at(0, s + 1)});
  }
  return mesh;
}

void disturb(ControlMesh& mesh, double along, double across, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (Point3& p : mesh.points) {
    p.x += along * unit(random);
    p.y += along * unit(random);
    p.z += across * unit(random);
  }
}

const char* name_of(NetShape shape) {
  switch (shape) {
    case NetShape::bent:
      return "bent";
    case NetShape::bumpy:
      return "bumpy";
    default:
      return "flat";
  }
}

ControlMesh corner_net(NetShape shape, std::size_t n, std::uint64_t seed) {
  ControlMesh mesh = fan_mesh(n, 2);
  if (shape == NetShape::bent) {
    bend(mesh, seed);
  } else if (shape == NetShape::bumpy) {
    // Edges across the spokes are of about 6 / n: moves along the net must not fold it.
    disturb(mesh, 0.25 * std::min(1.0, 6.0 / static_cast<double>(n)), 0.5, seed);
  } else {
    disturb(mesh, 0, 0.01, seed);
  }
  return mesh;
}

ControlMesh bent_net(Scheme scheme, std::size_t n, std::uint64_t seed) {
  if (scheme == Scheme::loop) return corner_net(NetShape::bent, n, seed);
  ControlMesh mesh = scheme == Scheme::catmark ? quad_fan_mesh(n, 2) : polygon_mesh(n);
  double extent = 0;
  for (const Point3& p : mesh.points) extent = std::max(extent, std::hypot(p.x, p.y));
  bend(mesh, seed, extent);
  return mesh;
}

}  // namespace snug
