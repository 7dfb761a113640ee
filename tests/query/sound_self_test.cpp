// Random closed meshes of every scheme, from smooth to crumpled: none is clear whose refined mesh crosses
// itself; nearly all that do not are not said to.

#include <snug/self.h>

#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/polygon_twin.h>
#include <oracle/self_twin.h>
#include <testing/closed_meshes.h>
#include <testing/tagged.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>

namespace snug {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// A mesh with a place for each vertex, and the same shaken.
struct Shape {
  testing::ClosedMesh mesh;
  std::vector<std::array<double, 3>> points;
};

oracle::TaggedMesh shaken(const Shape& shape, double amount, std::mt19937_64& random) {
  oracle::TaggedMesh mesh;
  mesh.polygons = shape.mesh.faces;
  for (const auto& p : shape.points) {
    oracle::Point moved{};
    for (std::size_t k = 0; k < 3; ++k) moved[k] = p[k] + amount * (unit(random) - 0.5);
    mesh.points.push_back(moved);
  }
  return mesh;
}

// Drums of every valence.
std::vector<Shape> shapes() {
  std::vector<Shape> all;
  const auto add_drum = [&](const testing::ClosedMesh& mesh, std::uint32_t n, double twist) {
    Shape shape{mesh, {}};
    for (std::uint32_t v = 0; v < 2 * n; ++v) {
      const double t = 2 * std::numbers::pi * (v % n + (v < n ? 0 : twist)) / n;
      shape.points.push_back({std::cos(t), std::sin(t), v < n ? -0.7 : 0.7});
    }
    shape.points.resize(mesh.vertices);
    all.push_back(shape);
  };
  for (std::uint32_t n = 3; n <= 12; n += 3) {
    add_drum(testing::prism(n), n, 0);
    add_drum(testing::antiprism(n), n, 0.5);
    // Both with fans of triangles for their two n-gons: valences up to n.
    for (const bool anti : {false, true}) {
      testing::ClosedMesh mesh = anti ? testing::antiprism(n) : testing::prism(n);
      mesh.name += " with apexes";
      testing::ClosedMesh fans{mesh.name, 2 * n + 2, {}};
      for (const auto& face : mesh.faces) {
        if (face.size() != n || (n == 3 && &face > &mesh.faces[1])) {
          for (std::size_t k = 2; k < face.size(); ++k) fans.faces.push_back({face[0], face[k - 1], face[k]});
          continue;
        }
        const std::uint32_t apex = face[0] < n ? 2 * n : 2 * n + 1;
        for (std::size_t k = 0; k < n; ++k) fans.faces.push_back({face[k], face[(k + 1) % n], apex});
      }
      if (!testing::is_closed_manifold(fans)) continue;
      add_drum(fans, n, anti ? 0.5 : 0);
      all.back().points[2 * n] = {0, 0, -1.2};
      all.back().points[2 * n + 1] = {0, 0, 1.2};
    }
  }
  return all;
}

// Sharp edges and corners at random.
void add_tags(oracle::TaggedMesh& mesh, std::mt19937_64& random) {
  for (const auto& face : mesh.polygons) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const double sharpness = random() % 2 == 0 ? 10 : 2.5;
      if (random() % 12 == 0) mesh.creases.push_back({face[k], face[(k + 1) % face.size()], sharpness});
    }
  }
}

bool crosses(const oracle::TaggedMesh& fine, double margin) {
  std::vector<std::array<double, 3>> points;
  for (const auto& p : fine.points) points.push_back({p[0], p[1], p[2]});
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& face : fine.polygons) {
    for (std::size_t k = 2; k < face.size(); ++k) triangles.push_back({face[0], face[k - 1], face[k]});
  }
  return oracle::crossing_triangles(points, triangles, margin).has_value();
}

oracle::TaggedMesh refined(const oracle::TaggedMesh& mesh, Scheme scheme) {
  if (scheme == Scheme::doo_sabin) return oracle::refine_dual(mesh, oracle::DualScheme::doo_sabin, 3);
  if (scheme == Scheme::midedge) return oracle::refine_dual(mesh, oracle::DualScheme::midedge, 4);
  oracle::Rules rules;
  rules.scheme = scheme == Scheme::loop ? oracle::PrimalScheme::loop : oracle::PrimalScheme::catmull_clark;
  return oracle::refine(mesh, rules, 3);
}

// SNUG_SELF_TRIALS: meshes a family, scheme and amount.
TEST(sound_self, verdicts_are_those_of_refined_meshes) {
  const char* const wanted = std::getenv("SNUG_SELF_TRIALS");
  const int trials = wanted != nullptr ? std::atoi(wanted) : 1;
  std::mt19937_64 random(1);
  std::map<std::string, int> counts;
  for (const Shape& shape : shapes()) {
    const testing::ClosedMesh& closed = shape.mesh;
    const bool triangles = std::all_of(closed.faces.begin(), closed.faces.end(),
                                       [](const auto& face) { return face.size() == 3; });
    for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
      if (scheme == Scheme::loop && !triangles) continue;
      for (const double amount : {0.0, 0.3, 0.8, 1.5, 3.0}) {
        for (int trial = 0; trial < 2 * trials; ++trial) {
          oracle::TaggedMesh mesh = shaken(shape, amount, random);
          const bool tagged = trial % 2 == 1 && (scheme == Scheme::loop || scheme == Scheme::catmark);
          if (tagged) add_tags(mesh, random);
          const SelfContact found =
              self_contact(Surface(testing::control_mesh(mesh), {.scheme = scheme}), {.budget = 20'000});
          const std::string name = closed.name + " " + name_of(scheme) + " " + std::to_string(amount);
          const bool crossing = crosses(refined(mesh, scheme), 0.005);
          ++counts[std::string(name_of(found.verdict)) + (crossing ? ", twin crosses" : ", twin does not")];
          if (crossing) {
            EXPECT_NE(found.verdict, SelfVerdict::clear) << name << " trial " << trial;
          }
        }
      }
    }
  }
  for (const auto& [what, count] : counts) RecordProperty(what, count);
  for (const auto& [what, count] : counts) std::printf("%s: %d\n", what.c_str(), count);
  EXPECT_GT(counts["clear, twin does not"], 30 * trials);
  EXPECT_GT(counts["intersecting, twin crosses"], 30 * trials);
}

}  // namespace
}  // namespace snug
