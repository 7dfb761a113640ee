// Sharp polyhedra, which are their own limit surfaces: what self_contact() says of them against CGAL's exact test.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <snug/contacts.h>

#include <gtest/gtest.h>
#include <testing/tagged.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace snug::self_cgal_test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalSurface = CGAL::Surface_mesh<Kernel::Point_3>;

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

// Closed surfaces of triangles, every edge sharp, about round.
std::vector<oracle::TaggedMesh> polyhedra() {
  std::vector<oracle::TaggedMesh> all;
  const auto add = [&](oracle::TaggedMesh mesh) {
    for (const auto& face : mesh.polygons) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = face[k], b = face[(k + 1) % 3];
        if (a < b) mesh.creases.push_back({a, b, 10});
      }
    }
    all.push_back(mesh);
  };
  oracle::TaggedMesh tetrahedron;
  tetrahedron.points = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  tetrahedron.polygons = {{0, 1, 3}, {0, 3, 2}, {0, 2, 1}, {1, 2, 3}};
  add(tetrahedron);
  for (std::uint32_t n = 3; n <= 9; n += 2) {
    // Two rings and two apexes; or only one ring.
    for (const std::uint32_t rings : {1u, 2u, 3u}) {
      oracle::TaggedMesh mesh;
      for (std::uint32_t r = 0; r < rings; ++r) {
        for (std::uint32_t i = 0; i < n; ++i) {
          const double t = 2 * std::numbers::pi * (i + 0.5 * r) / n, z = 0.8 * (r - 0.5 * (rings - 1));
          mesh.points.push_back({std::cos(t), std::sin(t), z});
        }
      }
      const std::uint32_t low = n * rings, high = low + 1;
      mesh.points.push_back({0, 0, -1.5});
      mesh.points.push_back({0, 0, 1.5});
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t k = (i + 1) % n;
        mesh.polygons.push_back({low, k, i});
        for (std::uint32_t r = 0; r + 1 < rings; ++r) {
          mesh.polygons.push_back({r * n + i, r * n + k, (r + 1) * n + i});
          mesh.polygons.push_back({(r + 1) * n + i, r * n + k, (r + 1) * n + k});
        }
        mesh.polygons.push_back({high, (rings - 1) * n + i, (rings - 1) * n + k});
      }
      add(mesh);
    }
  }
  return all;
}

oracle::TaggedMesh beside(oracle::TaggedMesh a, const oracle::TaggedMesh& b, const oracle::Point& offset) {
  const auto first = static_cast<std::uint32_t>(a.points.size());
  for (const auto& p : b.points) a.points.push_back({p[0] + offset[0], p[1] + offset[1], p[2] + offset[2]});
  for (auto face : b.polygons) {
    for (auto& v : face) v += first;
    a.polygons.push_back(face);
  }
  for (const auto& c : b.creases) a.creases.push_back({c.a + first, c.b + first, c.sharpness});
  return a;
}

// None: it has a face without an area.
std::optional<bool> cgal_meets_itself(const oracle::TaggedMesh& mesh) {
  CgalSurface surface;
  std::vector<CgalSurface::Vertex_index> vertices;
  for (const auto& p : mesh.points) vertices.push_back(surface.add_vertex({p[0], p[1], p[2]}));
  for (const auto& face : mesh.polygons) {
    const auto &a = mesh.points[face[0]], &b = mesh.points[face[1]], &c = mesh.points[face[2]];
    if (CGAL::collinear(Kernel::Point_3(a[0], a[1], a[2]), Kernel::Point_3(b[0], b[1], b[2]),
                        Kernel::Point_3(c[0], c[1], c[2]))) {
      return std::nullopt;
    }
    if (!surface.add_face(vertices[face[0]], vertices[face[1]], vertices[face[2]]).is_valid())
      return std::nullopt;
  }
  return CGAL::Polygon_mesh_processing::does_self_intersect(surface);
}

TEST(self_cgal, sharp_polyhedra_are_judged_as_by_exact_predicates) {
  std::mt19937_64 random(7);
  std::map<std::string, int> counts;
  const auto compare = [&](const oracle::TaggedMesh& mesh, const std::string& name) {
    const std::optional<bool> meets = cgal_meets_itself(mesh);
    if (!meets) return;
    const SelfContact found = self_contact(Surface(testing::control_mesh(mesh), {.scheme = Scheme::loop}), {},
                                           {.max_splits = 20'000});
    // The same triangles as facets: decided always, touching included.
    const SelfContact facets = self_contact(Surface(testing::control_mesh(mesh), {.scheme = Scheme::flat}));
    EXPECT_EQ(facets.verdict, *meets ? SelfVerdict::intersecting : SelfVerdict::clear) << name;
    ++counts[std::string(name_of(found.verdict)) + (*meets ? ", meets itself" : ", does not")];
    if (*meets) {
      EXPECT_NE(found.verdict, SelfVerdict::clear) << name;
    } else {
      EXPECT_NE(found.verdict, SelfVerdict::intersecting) << name;
    }
  };
  const std::vector<oracle::TaggedMesh> shapes = polyhedra();
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    for (const double amount : {0.0, 0.3, 0.8, 1.5, 3.0}) {
      for (int trial = 0; trial < 12; ++trial) {
        oracle::TaggedMesh mesh = shapes[s];
        // On a coarse lattice faces often touch exactly.
        const double grain = trial % 3 == 0 ? 0.5 : 0;
        for (auto& p : mesh.points) {
          for (double& x : p) {
            x += amount * unit(random);
            if (grain > 0) x = grain * std::round(x / grain);
          }
        }
        compare(mesh, "shape " + std::to_string(s) + " shaken by " + std::to_string(amount) + ", trial " +
                          std::to_string(trial));
      }
    }
    // Two bodies: apart, touching in a corner, an edge or faces, in each other, in one place.
    const oracle::TaggedMesh& other = shapes[(s + 1) % shapes.size()];
    for (int trial = 0; trial < 12; ++trial) {
      const double step = trial % 2 == 0 ? 1 : 0.37;
      const oracle::Point offset{step * std::round(3 * unit(random)), step * std::round(3 * unit(random)),
                                 step * std::round(3 * unit(random))};
      compare(beside(shapes[s], trial % 3 == 0 ? shapes[s] : other, offset),
              "shape " + std::to_string(s) + " and another one, trial " + std::to_string(trial));
    }
  }
  for (const auto& [what, count] : counts) RecordProperty(what, count);
  EXPECT_GT(counts["clear, does not"], 150);
  EXPECT_GT(counts["intersecting, meets itself"], 300);
}

}  // namespace
}  // namespace snug::self_cgal_test
