// Random bodies and folds of every scheme with a tolerance: none is clear whose refined mesh has near points
// with a long way between them, none near whose refined mesh has none.

#include <snug/contacts.h>

#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/near_twin.h>
#include <oracle/polygon_twin.h>
#include <oracle/tagged_shapes.h>
#include <testing/counts.h>
#include <testing/tagged.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>
#include <string>

namespace snug::near_test {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// A tube around a horseshoe whose ends are this far apart, closed by fans or n-gons.
oracle::TaggedMesh horseshoe(double gap, std::uint32_t n, bool triangles) {
  constexpr std::uint32_t m = 14;
  oracle::TaggedMesh mesh;
  for (std::uint32_t i = 0; i < m; ++i) {
    const double open = 0.25 + 0.5 * gap;  // angle at either end, of a circle of radius 1
    const double t = open + (2 * std::numbers::pi - 2 * open) * i / (m - 1);
    for (std::uint32_t j = 0; j < n; ++j) {
      const double s = 2 * std::numbers::pi * j / n, r = 1 + 0.25 * std::cos(s);
      mesh.points.push_back({r * std::cos(t), r * std::sin(t), 0.25 * std::sin(s)});
    }
  }
  for (std::uint32_t i = 0; i + 1 < m; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t k = (j + 1) % n;
      const std::array<std::uint32_t, 4> c{i * n + j, i * n + k, (i + 1) * n + k, (i + 1) * n + j};
      if (triangles) {
        mesh.polygons.push_back({c[0], c[2], c[1]});
        mesh.polygons.push_back({c[0], c[3], c[2]});
      } else {
        mesh.polygons.push_back({c[0], c[3], c[2], c[1]});
      }
    }
  }
  std::vector<std::uint32_t> first, last;
  for (std::uint32_t j = 0; j < n; ++j) {
    first.push_back(j);
    last.push_back((m - 1) * n + n - 1 - j);
  }
  for (const auto& end : {first, last}) {
    if (!triangles) {
      mesh.polygons.push_back(end);
      continue;
    }
    for (std::size_t k = 2; k < n; ++k) mesh.polygons.push_back({end[0], end[k - 1], end[k]});
  }
  return mesh;
}

oracle::TaggedMesh refined(const oracle::TaggedMesh& mesh, Scheme scheme) {
  if (scheme == Scheme::doo_sabin) return oracle::refine_dual(mesh, oracle::DualScheme::doo_sabin, 3);
  if (scheme == Scheme::midedge) return oracle::refine_dual(mesh, oracle::DualScheme::midedge, 5);
  oracle::Rules rules;
  rules.scheme = scheme == Scheme::loop ? oracle::PrimalScheme::loop : oracle::PrimalScheme::catmull_clark;
  return oracle::refine(mesh, rules, 3);
}

// SNUG_NEAR_TRIALS: rounds.
TEST(near, verdicts_are_those_of_refined_meshes) {
  const int trials = static_cast<int>(testing::number_of("SNUG_NEAR_TRIALS", 1));
  std::mt19937_64 random(7);
  std::map<std::string, int> counts;
  for (int trial = 0; trial < trials; ++trial) {
    for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
      for (const std::uint32_t n : {4u, 5u}) {
        for (const double gap : {0.05, 0.8}) {
          for (const double shake : {0.0, 0.2}) {
            const bool triangles = scheme == Scheme::loop || random() % 3 == 0;
            oracle::TaggedMesh mesh = horseshoe(gap, n, triangles);
            for (auto& p : mesh.points) {
              for (double& x : p) x += shake * (unit(random) - 0.5);
            }
            const double tolerance = 0.08 * std::exp2(3 * unit(random)),
                         radius = (2.5 + 2 * unit(random)) * tolerance;
            // Half of the combinations have all pairs.
            const bool odd = (n == 5) != ((gap > 0.1) != (shake > 0));
            if (odd == (scheme == Scheme::loop || scheme == Scheme::doo_sabin) && !testing::long_check())
              continue;
            const SelfContact found =
                self_contact(Surface(testing::control_mesh(mesh), {.scheme = scheme}),
                             {.within = tolerance, .radius = radius}, {.max_splits = 300'000});
            ++counts[std::string(name_of(scheme)) + " " + name_of(found.verdict)];
            const std::string name = std::string(name_of(scheme)) + ", " + std::to_string(n) + ", " +
                                     std::to_string(gap) + ", " + std::to_string(shake) + ", " +
                                     std::to_string(tolerance) + ", " + std::to_string(radius);
            const oracle::TaggedMesh fine = refined(mesh, scheme);
            std::vector<std::array<double, 3>> points;
            for (const auto& p : fine.points) points.push_back({p[0], p[1], p[2]});
            const oracle::EdgeWays ways(points, fine.polygons);
            const double edge = ways.longest_edge();
            if (found.verdict == SelfVerdict::clear) {
              // Ways along edges are at most 1.5 times the shortest ones, points about edge / 8 off.
              const double longest = ways.longest_way(tolerance - edge / 4, 1.5 * radius + edge,
                                                      static_cast<std::uint32_t>(1 + points.size() / 100));
              EXPECT_LE(longest, 1.5 * radius + edge) << name;
            }
            if (found.verdict == SelfVerdict::near) {
              ASSERT_FALSE(found.pairs.empty());
              for (std::size_t i = 0; i < std::min<std::size_t>(5, found.pairs.size()); ++i) {
                const Point3 &a = found.pairs[i].points[0].point, &b = found.pairs[i].points[1].point;
                EXPECT_LE(distance(a, b), tolerance * (1 + 1e-12)) << name;
                const std::uint32_t at = ways.nearest({a.x, a.y, a.z}), to = ways.nearest({b.x, b.y, b.z});
                const double way = ways.from(at, INFINITY)[to];
                EXPECT_GT(way + 3 * edge, radius) << name;
              }
            }
          }
        }
      }
    }
  }
  for (const auto& [what, count] : counts) std::printf("%s: %d\n", what.c_str(), count);
  EXPECT_GT(counts["loop clear"], 0);
  EXPECT_GT(counts["loop near"], 0);
  EXPECT_GT(counts["doo-sabin clear"], 0);
}

}  // namespace
}  // namespace snug::near_test
