#include <experiments/corner_nets.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <snug/scheme/rules.h>
#include <support/error.h>
#include <support/names.h>

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

// The angle between spokes of a fan of n faces.
double spoke_angle(std::size_t n, bool open) {
  if (!open) return 2 * std::numbers::pi / static_cast<double>(n);
  return std::numbers::pi / static_cast<double>(std::max<std::size_t>(n, 2));
}

// p times spoke s and q times the next one.
Point3 between_spokes(double angle, std::size_t s, double p, double q) {
  const double a = angle * static_cast<double>(s), b = angle * static_cast<double>(s + 1);
  return {p * std::cos(a) + q * std::cos(b), p * std::sin(a) + q * std::sin(b), 0};
}

// A fan of lattices around vertex 0, one of them a sector.
class Fan {
 public:
  Fan(std::size_t n, std::size_t rings, bool quads, bool open)
      : n_(n), rings_(rings), quads_(quads), open_(open) {
    require_value(n >= (open ? 1u : 3u) && rings >= 1,
                  "fan: give at least one ring, and three sectors, or one where it is open");
  }

  [[nodiscard]] ControlMesh mesh() const { return quads_ ? of_quads() : of_triangles(); }

  // Vertex i of a spoke, the middle being vertex 0.
  [[nodiscard]] VertexId on_spoke(std::size_t spoke, std::size_t i) const {
    return quads_ ? quad_vertex(spoke, i, 0) : triangle_vertex(i, spoke, 0);
  }

 private:
  // Ring i has i vertices a sector, and one at the end if it is open.
  [[nodiscard]] VertexId triangle_vertex(std::size_t i, std::size_t sector, std::size_t j) const {
    if (i == 0) return VertexId(0);
    const std::size_t before = 1 + n_ * i * (i - 1) / 2 + (open_ ? i - 1 : 0);
    return VertexId(before + (open_ ? sector * i + j : (sector * i + j) % (n_ * i)));
  }

  // Sector s holds the places (i, j) with i >= 1 and j >= 0; those with i = 0 belong to the next one. If it
  // is open there is one more sector of a spoke alone.
  [[nodiscard]] VertexId quad_vertex(std::size_t s, std::size_t i, std::size_t j) const {
    if (i == 0 && j == 0) return VertexId(0);
    if (i == 0) return quad_vertex(s + 1, j, 0);
    if (s == n_ && open_) return VertexId(n_ * rings_ * (rings_ + 1) + i);
    return VertexId(1 + s % n_ * rings_ * (rings_ + 1) + (i - 1) * (rings_ + 1) + j);
  }

  [[nodiscard]] ControlMesh of_triangles() const {
    const double angle = spoke_angle(n_, open_);
    ControlMesh mesh;
    mesh.points.push_back({});
    for (std::size_t i = 1; i <= rings_; ++i) {
      for (std::size_t s = 0; s < n_; ++s) {
        for (std::size_t j = 0; j < i; ++j) {
          mesh.points.push_back(between_spokes(angle, s, static_cast<double>(i - j), static_cast<double>(j)));
        }
      }
      if (open_) mesh.points.push_back(between_spokes(angle, n_, static_cast<double>(i), 0));
    }
    const auto at = [&](std::size_t i, std::size_t s, std::size_t j) { return triangle_vertex(i, s, j); };
    for (std::size_t i = 0; i < rings_; ++i) {
      for (std::size_t s = 0; s < n_; ++s) {
        for (std::size_t j = 0; j <= i; ++j) {
          mesh.add_face(std::array{at(i, s, j), at(i + 1, s, j), at(i + 1, s, j + 1)});
          if (j < i) mesh.add_face(std::array{at(i, s, j), at(i + 1, s, j + 1), at(i, s, j + 1)});
        }
      }
    }
    return mesh;
  }

  [[nodiscard]] ControlMesh of_quads() const {
    const double angle = spoke_angle(n_, open_);
    ControlMesh mesh;
    mesh.points.push_back({});
    for (std::size_t s = 0; s < n_; ++s) {
      for (std::size_t i = 1; i <= rings_; ++i) {
        for (std::size_t j = 0; j <= rings_; ++j) {
          mesh.points.push_back(between_spokes(angle, s, static_cast<double>(i), static_cast<double>(j)));
        }
      }
    }
    for (std::size_t i = 1; open_ && i <= rings_; ++i) {
      mesh.points.push_back(between_spokes(angle, n_, static_cast<double>(i), 0));
    }
    const auto at = [&](std::size_t s, std::size_t i, std::size_t j) { return quad_vertex(s, i, j); };
    for (std::size_t s = 0; s < n_; ++s) {
      for (std::size_t i = 0; i < rings_; ++i) {
        for (std::size_t j = 0; j < rings_; ++j) {
          mesh.add_face(std::array{at(s, i, j), at(s, i + 1, j), at(s, i + 1, j + 1), at(s, i, j + 1)});
        }
      }
    }
    return mesh;
  }

  std::size_t n_, rings_;
  bool quads_, open_;
};

}  // namespace

ControlMesh fan_mesh(std::size_t n, std::size_t rings) { return Fan(n, rings, false, false).mesh(); }
ControlMesh quad_fan_mesh(std::size_t n, std::size_t rings) { return Fan(n, rings, true, false).mesh(); }
ControlMesh open_fan_mesh(std::size_t n, std::size_t rings) { return Fan(n, rings, false, true).mesh(); }
ControlMesh open_quad_fan_mesh(std::size_t n, std::size_t rings) { return Fan(n, rings, true, true).mesh(); }

ControlMesh polygon_mesh(std::size_t n) {
  require_value(n >= 3, "polygon: give at least three corners");
  const double angle = spoke_angle(n, false);
  ControlMesh mesh;
  for (const auto& [p, q] : {std::pair{0.5, 0.5}, {1.5, 0.5}, {1.5, 1.5}, {0.5, 1.5}}) {
    for (std::size_t s = 0; s < n; ++s) mesh.points.push_back(between_spokes(angle, s, p, q));
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

constexpr auto net_shape_names = std::to_array<Named<NetShape>>(
    {{"bent", NetShape::bent}, {"bumpy", NetShape::bumpy}, {"flat", NetShape::flat}});

const char* name_of(NetShape shape) { return name_in(net_shape_names, shape); }

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

constexpr auto net_centre_names = std::to_array<Named<NetCentre>>({{"interior", NetCentre::interior},
                                                                   {"boundary", NetCentre::boundary},
                                                                   {"corner", NetCentre::corner},
                                                                   {"crease", NetCentre::crease},
                                                                   {"dart", NetCentre::dart},
                                                                   {"semi-sharp", NetCentre::semi_sharp}});

const char* name_of(NetCentre centre) { return name_in(net_centre_names, centre); }

ControlMesh bent_net(Scheme scheme, const NetPlace& place, std::uint64_t seed) {
  const std::size_t n = place.faces;
  if (place.centre == NetCentre::interior && rules_of(scheme).triangular()) {
    return corner_net(NetShape::bent, n, seed);
  }
  ControlMesh mesh;
  if (rules_of(scheme).primal) {
    const bool open = place.centre == NetCentre::boundary || place.centre == NetCentre::corner;
    const Fan fan(n, 2, !rules_of(scheme).triangular(), open);
    mesh = fan.mesh();
    const auto sharpen = [&](std::size_t spoke, double sharpness) {
      for (std::size_t i = 0; i < 2; ++i) {
        mesh.tags.creases.push_back({fan.on_spoke(spoke, i), fan.on_spoke(spoke, i + 1), sharpness});
      }
    };
    // Else the middle of one face would be a corner.
    if (place.centre == NetCentre::boundary) mesh.tags.boundary = BoundaryRule::edge_only;
    if (place.centre == NetCentre::corner) mesh.tags.corners.push_back({VertexId(0), infinite_sharpness});
    if (place.centre == NetCentre::crease || place.centre == NetCentre::semi_sharp) {
      const double sharpness = place.centre == NetCentre::crease ? infinite_sharpness : place.sharpness;
      sharpen(0, sharpness);
      sharpen(n / 2, sharpness);
    }
    if (place.centre == NetCentre::dart) sharpen(0, infinite_sharpness);
  } else {
    require_value(place.centre == NetCentre::interior,
                  "nets of dual schemes have an inner centre; give NetCentre::interior");
    mesh = polygon_mesh(n);
  }
  double extent = 0;
  for (const Point3& p : mesh.points) extent = std::max(extent, std::hypot(p.x, p.y));
  bend(mesh, seed, extent);
  return mesh;
}

}  // namespace snug
