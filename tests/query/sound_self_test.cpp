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
#include <random>

namespace snug {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// Points of a family's mesh: by some steps of smoothing from random ones on a sphere, then shaken.
oracle::TaggedMesh placed(const testing::ClosedMesh& closed, double amount, std::mt19937_64& random) {
  oracle::TaggedMesh mesh;
  mesh.polygons = closed.faces;
  std::vector<std::array<double, 3>> points(closed.vertices);
  for (auto& p : points) {
    for (double& x : p) x = unit(random) - 0.5;
  }
  std::vector<std::vector<std::uint32_t>> beside(closed.vertices);
  for (const auto& face : closed.faces) {
    for (std::size_t k = 0; k < face.size(); ++k) beside[face[k]].push_back(face[(k + 1) % face.size()]);
  }
  for (int step = 0; step < 60; ++step) {
    std::vector<std::array<double, 3>> next(points.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
      for (const std::uint32_t w : beside[v]) {
        for (std::size_t k = 0; k < 3; ++k) next[v][k] += points[w][k];
      }
      const double size = std::hypot(next[v][0], next[v][1], next[v][2]) + 1e-9;
      for (double& x : next[v]) x /= size;
    }
    for (std::size_t v = 0; v < points.size(); ++v) {
      for (std::size_t k = 0; k < 3; ++k) points[v][k] = 0.5 * (points[v][k] + next[v][k]);
    }
  }
  for (auto& p : points) {
    for (double& x : p) x += amount * (unit(random) - 0.5);
    mesh.points.push_back({p[0], p[1], p[2]});
  }
  return mesh;
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
  std::vector<testing::ClosedMesh> families{testing::tetrahedron(), testing::torus(5, 5, true)};
  for (std::uint32_t n = 3; n <= 11; n += 4) {
    families.push_back(testing::prism(n));
    families.push_back(testing::antiprism(n));
    families.push_back(testing::bipyramid(n));
  }
  families.push_back(testing::stellated(testing::prism(5)));
  std::map<std::string, int> counts;
  for (const auto& closed : families) {
    const bool triangles = std::all_of(closed.faces.begin(), closed.faces.end(),
                                       [](const auto& face) { return face.size() == 3; });
    for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
      if (scheme == Scheme::loop && !triangles) continue;
      for (const double amount : {0.0, 0.5, 1.5, 3.0}) {
        for (int trial = 0; trial < 2 * trials; ++trial) {
          oracle::TaggedMesh mesh = placed(closed, amount, random);
          const bool tagged = trial % 2 == 1 && (scheme == Scheme::loop || scheme == Scheme::catmark);
          if (tagged) add_tags(mesh, random);
          const SelfContact found =
              self_contact(Surface(testing::control_mesh(mesh), {.scheme = scheme}), {.budget = 20'000});
          const std::string name = closed.name + " " + name_of(scheme) + " " + std::to_string(amount);
          const bool crossing = crosses(refined(mesh, scheme), 0.02);
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
  // Those that cross by less than the twin's margin.
  EXPECT_LT(counts["intersecting, twin does not"], counts["intersecting, twin crosses"]);
}

}  // namespace
}  // namespace snug
