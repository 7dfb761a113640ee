#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/tagged_shapes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace oracle::oracle_dual_test {
namespace {

using namespace meshes;

constexpr DualScheme kSchemes[] = {DualScheme::doo_sabin, DualScheme::midedge};

Point centroid(const TaggedMesh& mesh, const std::vector<std::uint32_t>& face) {
  Point sum{};
  for (const std::uint32_t v : face)
    for (std::size_t x = 0; x < 3; ++x) sum[x] += mesh.points[v][x] / static_cast<double>(face.size());
  return sum;
}

TEST(dual_twin, makes_a_face_for_each_face_edge_and_vertex) {
  for (const DualScheme scheme : kSchemes) {
    const TaggedMesh fine = refine_dual(cube(), scheme);
    EXPECT_EQ(fine.points.size(), 24U);
    ASSERT_EQ(fine.polygons.size(), 6U + 12U + 8U);
    std::map<std::size_t, int> sizes;
    for (const auto& face : fine.polygons) ++sizes[face.size()];
    EXPECT_EQ(sizes[3], 8);
    EXPECT_EQ(sizes[4], 18);
  }
}

TEST(dual_twin, is_the_biquadratic_b_spline_on_a_grid) {
  std::mt19937_64 random(41);
  const TaggedMesh mesh = shaken(quad_grid(2, 2), 0.3, random);
  const TaggedMesh fine = refine_dual(mesh, DualScheme::doo_sabin);
  // Corner 0 of face 0 is (9 c0 + 3 c1 + 3 c3 + c2) / 16.
  const auto& face = mesh.polygons[0];
  for (std::size_t x = 0; x < 3; ++x)
    EXPECT_NEAR(fine.points[0][x],
                (9 * mesh.points[face[0]][x] + 3 * mesh.points[face[1]][x] + mesh.points[face[2]][x] +
                 3 * mesh.points[face[3]][x]) /
                    16,
                1e-15);
}

TEST(dual_twin, keeps_the_centroids) {
  std::mt19937_64 random(42);
  for (const DualScheme scheme : kSchemes)
    for (const TaggedMesh& shape : {cube(), prism(5), pyramid(7), pyramid(3)}) {
      const TaggedMesh mesh = shaken(shape, 0.2, random), fine = refine_dual(mesh, scheme, 2);
      const auto samples = sample_dual(mesh, scheme, 4);
      for (const TaggedMesh* coarse : {&mesh, &fine})
        for (const auto& face : coarse->polygons) {
          const Point p = centroid(*coarse, face);
          EXPECT_TRUE(std::any_of(samples.begin(), samples.end(), [&](const DualSample& s) {
            return std::abs(s.position[0] - p[0]) + std::abs(s.position[1] - p[1]) +
                       std::abs(s.position[2] - p[2]) <
                   1e-13;
          }));
        }
    }
}

TEST(dual_twin, gives_patches_to_inner_vertices_only) {
  for (const DualScheme scheme : kSchemes) {
    for (const DualSample& s : sample_dual(quad_grid(3, 3), scheme, 2)) {
      ASSERT_FALSE(s.owners.empty());
      for (const std::uint32_t v : s.owners) EXPECT_TRUE(v == 5 || v == 6 || v == 9 || v == 10);
      for (std::size_t x = 0; x < 2; ++x) {
        EXPECT_GE(s.position[x], 0.5);
        EXPECT_LE(s.position[x], 2.5);
      }
    }
    EXPECT_TRUE(sample_dual(moebius(5), scheme, 1).empty());
    EXPECT_TRUE(sample_dual(back_to_back(), scheme, 1).empty());
    for (const DualSample& s : sample_dual(two_cubes_at_a_vertex(), scheme, 1))
      EXPECT_EQ(std::count(s.owners.begin(), s.owners.end(), 0U), 0);
  }
}

TEST(dual_twin, does_not_mind_orientation) {
  std::mt19937_64 random(43);
  TaggedMesh mesh = shaken(prism(5), 0.2, random), turned = mesh;
  std::reverse(turned.polygons[1].begin(), turned.polygons[1].end());
  for (const DualScheme scheme : kSchemes) {
    const auto a = sample_dual(mesh, scheme, 3), b = sample_dual(turned, scheme, 3);
    ASSERT_EQ(a.size(), b.size());
    for (const DualSample& s : a)
      EXPECT_TRUE(std::any_of(b.begin(), b.end(), [&](const DualSample& t) {
        return s.owners == t.owners && std::abs(s.position[0] - t.position[0]) < 1e-14 &&
               std::abs(s.position[1] - t.position[1]) < 1e-14 &&
               std::abs(s.position[2] - t.position[2]) < 1e-14;
      }));
  }
}

TEST(dual_twin, commutes_with_affine_maps) {
  std::mt19937_64 random(44);
  const TaggedMesh mesh = shaken(pyramid(5), 0.2, random);
  TaggedMesh moved = mesh;
  const auto image = [](const Point& p) {
    return Point{p[0] - 2 * p[1] + 5, p[2] + 0.5 * p[0] - 7, 3 * p[1] + 1};
  };
  for (Point& p : moved.points) p = image(p);
  for (const DualScheme scheme : kSchemes) {
    const auto here = sample_dual(mesh, scheme, 4), there = sample_dual(moved, scheme, 4);
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t i = 0; i < here.size(); ++i)
      for (std::size_t x = 0; x < 3; ++x)
        EXPECT_NEAR(image(here[i].position)[x], there[i].position[x], 1e-14);
  }
}

}  // namespace
}  // namespace oracle::oracle_dual_test
