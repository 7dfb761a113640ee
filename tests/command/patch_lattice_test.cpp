#include <apps/snug/patch_lattice.h>

#include <tuple>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <testing/tagged.h>

namespace snug::command::patch_lattice_test {
namespace {

using oracle::meshes::quad_grid;

/// A grid of quads, one of which is a hole and one of which is in two triangles.
ControlMesh mixed() {
  ControlMesh mesh;
  const auto at = [](std::size_t i, std::size_t j) { return VertexId(5 * j + i); };
  for (std::size_t j = 0; j < 5; ++j) {
    for (std::size_t i = 0; i < 5; ++i)
      mesh.points.push_back({double(i), double(j), 0.3 * double(i * j % 3)});
  }
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (i == 2 && j == 1) {
        mesh.add_face(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        mesh.add_face(std::array{at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      } else {
        mesh.add_face(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  mesh.tags.holes.emplace_back(std::size_t{9});
  return mesh;
}

TEST(patch_lattice, has_the_patches_of_the_surface_and_interpolates_between_its_places) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge, Scheme::bilinear}) {
    for (const BoundaryRule rule : {BoundaryRule::edge_and_corner, BoundaryRule::none}) {
      const Surface surface(mixed(), {.scheme = scheme, .boundary = rule});
      const PatchLattice lattice(surface, 4);
      const PatchBounds patches(surface);
      ASSERT_EQ(lattice.patches().size(), patches.patches().size()) << name_of(scheme);
      for (std::size_t i = 0; i < patches.patches().size(); ++i) {
        EXPECT_EQ(lattice.patches()[i].owner, patches.patches()[i].owner);
        EXPECT_EQ(lattice.patches()[i].part, patches.patches()[i].part);
        EXPECT_EQ(lattice.rank(patches.patches()[i]), i);
      }
      std::vector<double> u, v;
      std::size_t points = 0;
      lattice.evaluate(
          surface, {.threads = 1},
          [&](const Place& at, std::vector<Place>& asked) {
            EXPECT_TRUE(surface.has(at));
            u.push_back(at.u);
            v.push_back(at.v);
            asked.push_back(at);
          },
          [&](std::span<const SurfacePoint> found) { points += found.size(); });
      EXPECT_EQ(points, u.size());
      EXPECT_EQ(points, 15 * lattice.patches().size());
      const RayCaster caster(surface, 1e-4);
      int hits = 0;
      for (double x = 0.1; x < 4; x += 0.37) {
        for (double y = 0.15; y < 4; y += 0.31) {
          const QuickHit hit = caster.cast({.origin = {x, y, 9}, .direction = {0, 0, -1}});
          if (hit.t == std::numeric_limits<double>::infinity()) continue;
          ++hits;
          EXPECT_NEAR(lattice.interpolated(u, hit), hit.at.u, 1e-12) << name_of(scheme);
          EXPECT_NEAR(lattice.interpolated(v, hit), hit.at.v, 1e-12) << name_of(scheme);
        }
      }
      EXPECT_GT(hits, 10) << name_of(scheme);
    }
  }
}

}  // namespace
}  // namespace snug::command::patch_lattice_test
