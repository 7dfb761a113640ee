#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <oracle/polygon_twin.h>
#include <oracle/self_twin.h>
#include <oracle/tagged_shapes.h>
#include <oracle/test_meshes.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace oracle::oracle_polygon_test {
namespace {

using namespace meshes;
using Key = std::tuple<std::uint32_t, std::uint32_t, double, double>;

/// Samples of a coarser level must be found again, which is how limits are checked without another program.
void expect_limits_at_all_levels(const TaggedMesh& mesh, const Rules& rules, int coarse, int fine) {
  std::map<Key, FaceSample> found;
  for (const FaceSample& s : sample_faces(mesh, rules, fine)) found[{s.face, s.part, s.u, s.v}] = s;
  for (const FaceSample& s : sample_faces(mesh, rules, coarse)) {
    const auto at = found.find({s.face, s.part, s.u, s.v});
    ASSERT_NE(at, found.end());
    for (std::size_t x = 0; x < 3; ++x)
      EXPECT_LE(std::abs(s.position[x] - at->second.position[x]), s.error + at->second.error);
  }
}

TaggedMesh creased_cube(std::mt19937_64& random) {
  TaggedMesh mesh = shaken(cube(), 0.25, random);
  mesh.creases = {{0, 1, 1.75}, {1, 3, 10}, {3, 7, 2.5}, {4, 5, 10}, {2, 6, 0.375}};
  mesh.corners = {{6, 1.25}};
  return mesh;
}

// Two bent sheets, close to each other; the second one is tilted by so much. One that only comes near must not be said to cross.
TEST(self_twin, sheets_cross_where_they_do_and_not_where_they_are_near) {
  const auto crosses = [](PrimalScheme scheme, double apart, double tilt) {
    TaggedMesh mesh;
    for (const double up : {0.0, 1.0}) {
      const auto first = static_cast<std::uint32_t>(mesh.points.size());
      for (int y = -3; y <= 3; ++y) {
        for (int x = -3; x <= 3; ++x) {
          // Edges of one are not above those of the other.
          const double u = x + 0.31 * up, v = y + 0.17 * up;
          const double bent = 0.1 * (u * u - 0.5 * u * v + 0.3 * v * v);
          mesh.points.push_back({u, v, bent + up * (apart + tilt * u)});
        }
      }
      for (std::uint32_t y = 0; y < 6; ++y) {
        for (std::uint32_t x = 0; x < 6; ++x) {
          const std::uint32_t a = first + 7 * y + x;
          if (scheme == PrimalScheme::loop) {
            mesh.polygons.push_back({a, a + 1, a + 8});
            mesh.polygons.push_back({a, a + 8, a + 7});
          } else {
            mesh.polygons.push_back({a, a + 1, a + 8, a + 7});
          }
        }
      }
    }
    Rules rules;
    rules.scheme = scheme;
    const double height = scheme == PrimalScheme::loop ? 0.42 / 12 : 0.13 / 3;  // of the limit at the middle
    return crosses_near(mesh, rules, {0, 0, height}, 1e-3);
  };
  for (const PrimalScheme scheme : {PrimalScheme::catmull_clark, PrimalScheme::loop}) {
    EXPECT_TRUE(crosses(scheme, 1e-4, 0.3));
    EXPECT_TRUE(crosses(scheme, 7e-7, 2e-3));
    EXPECT_FALSE(crosses(scheme, 1e-3, 0));
    EXPECT_FALSE(crosses(scheme, 1e-5, 0));
    EXPECT_FALSE(crosses(scheme, 1e-7, 0));
  }
}

TEST(polygon_twin, gives_the_same_limits_from_any_level) {
  std::mt19937_64 random(31);
  for (const bool chaikin : {false, true})
    for (const bool clamp : {false, true}) {
      Rules rules;
      rules.chaikin = chaikin;
      rules.clamp_dart_edges = clamp;
      const TaggedMesh mesh = creased_cube(random);
      for (int coarse = 0; coarse < 4; ++coarse) expect_limits_at_all_levels(mesh, rules, coarse, 4);
      rules.scheme = PrimalScheme::loop;
      for (int coarse = 0; coarse < 4; ++coarse)
        expect_limits_at_all_levels(triangulated(mesh), rules, coarse, 4);
    }
  for (const TaggedMesh& mesh : {prism(5), pyramid(7), mixed_strip(), book(3), back_to_back(), moebius(5)})
    for (const bool smooth_triangles : {false, true}) {
      Rules rules;
      rules.smooth_triangles = smooth_triangles;
      for (int coarse = 0; coarse < 3; ++coarse)
        expect_limits_at_all_levels(shaken(mesh, 0.1, random), rules, coarse, 3);
    }
}

TEST(polygon_twin, gives_the_same_limits_from_any_level_by_the_old_vertex_rule) {
  std::mt19937_64 random(32);
  Rules rules;
  rules.old_vertex_rule = true;
  for (const TaggedMesh& mesh : {cube(), prism(5), pyramid(7)})
    for (int coarse = 0; coarse < 3; ++coarse)
      expect_limits_at_all_levels(shaken(mesh, 0.2, random), rules, coarse, 3);
}

TEST(polygon_twin, has_one_vertex_rule_at_valence_four) {
  std::mt19937_64 random(33);
  const TaggedMesh grid = shaken(quad_grid(4, 4), 0.3, random), box = shaken(cube(), 0.2, random);
  Rules old_rule;
  old_rule.old_vertex_rule = true;
  const auto same = [&](const TaggedMesh& mesh) {
    return refine(mesh, {}, 2).points == refine(mesh, old_rule, 2).points;
  };
  EXPECT_TRUE(same(grid));
  EXPECT_FALSE(same(box));
}

/// By hand: after one step corner 0 of the cube is (Q + 2R + S) / 4 with Q = (1/3, 1/3, 1/3), R = (1/6, 1/6,
/// 1/6).
TEST(polygon_twin, knows_the_old_vertex_rule) {
  Rules rules;
  rules.old_vertex_rule = true;
  const TaggedMesh fine = refine(cube(), rules);
  const Point p = fine.points[6 + 12];
  for (const double x : p) EXPECT_NEAR(x, (1.0 / 3 + 2.0 / 6) / 4, 1e-15);
}

TEST(polygon_twin, agrees_with_the_loop_twin) {
  std::mt19937_64 random(34);
  for (const Boundary boundary : {Boundary::none, Boundary::edge_only, Boundary::edge_and_corner})
    for (const TwinMesh& mesh : {disturbed(icosahedron(), 20, 0.3, random),
                                 disturbed(grid(4, 3, boundary), 12, 0.3, random), wheel(7, boundary)}) {
      Rules rules;
      rules.scheme = PrimalScheme::loop;
      rules.boundary = boundary;
      TaggedMesh same;
      same.points = mesh.points;
      for (const Triangle& t : mesh.triangles) same.polygons.push_back({t.begin(), t.end()});
      TwinMesh other = mesh;
      other.boundary = boundary;
      std::map<Key, LimitSample> found;
      for (const LimitSample& s : sample_uniform(other, 3)) found[{s.face, 0, s.u, s.v}] = s;
      const auto samples = sample_faces(same, rules, 3);
      EXPECT_EQ(samples.size(), found.size());
      for (const FaceSample& s : samples) {
        const auto at = found.find({s.face, 0, s.u, s.v});
        ASSERT_NE(at, found.end());
        for (std::size_t x = 0; x < 3; ++x)
          EXPECT_LE(std::abs(s.position[x] - at->second.position[x]), s.error + at->second.error);
      }
    }
}

TEST(polygon_twin, commutes_with_affine_maps) {
  std::mt19937_64 random(35);
  const auto image = [](const Point& p) {
    return Point{p[0] - 2 * p[1] + 5, p[2] + 0.5 * p[0] - 7, 3 * p[1] + p[2] + 1};
  };
  for (const bool loop : {false, true}) {
    Rules rules;
    if (loop) rules.scheme = PrimalScheme::loop;
    TaggedMesh mesh = creased_cube(random);
    if (loop) mesh = triangulated(mesh);
    TaggedMesh moved = mesh;
    for (Point& p : moved.points) p = image(p);
    const auto here = sample_faces(mesh, rules, 3), there = sample_faces(moved, rules, 3);
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t i = 0; i < here.size(); ++i)
      for (std::size_t x = 0; x < 3; ++x)
        EXPECT_NEAR(image(here[i].position)[x], there[i].position[x], 1e-14);
  }
}

TEST(polygon_twin, refuses_what_it_cannot_read) {
  TaggedMesh mesh = cube();
  mesh.polygons[0][0] = 8;
  EXPECT_THROW(static_cast<void>(refine(mesh, {})), std::invalid_argument);
  mesh = cube();
  mesh.points[3][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(refine(mesh, {})), std::invalid_argument);
  Rules loop;
  loop.scheme = PrimalScheme::loop;
  EXPECT_THROW(static_cast<void>(refine(cube(), loop)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(sample_faces(cube(), {}, 11)), std::invalid_argument);
}

}  // namespace
}  // namespace oracle::oracle_polygon_test
