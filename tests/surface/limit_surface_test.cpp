#include <snug/surface/limit_surface.h>

#include <gtest/gtest.h>
#include <support/error.h>
#include <testing/patches.h>
#include <testing/scheme_surfaces.h>

#include <array>
#include <string>
#include <thread>
#include <vector>

namespace snug::limit_surface_test {
namespace {

TEST(surface, scales_its_largest_coordinate_to_about_one) {
  for (const double size : {1e-300, 1.0, 3e299}) {
    oracle::TwinMesh twin = oracle::meshes::icosahedron();
    for (oracle::Point& p : twin.points) p = {p[0] * size, p[1] * size, p[2] * size};
    const LimitSurface surface = testing::surface_of(twin);
    double largest = 0;
    for (const oracle::Point& p : twin.points) {
      for (const double x : p) largest = std::max(largest, std::fabs(surface.scale().apply(x)));
    }
    EXPECT_GE(largest, 1);
    EXPECT_LT(largest, 2);
    const Patch patch = surface.patch(PatchId(0));
    EXPECT_LT(patch.error, 1e-15);
    EXPECT_GT(patch.largest, 0.1);
  }
}

TEST(surface, has_no_patches_at_the_boundary_with_rule_none) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::grid(4, 4, oracle::Boundary::none));
  std::size_t patches = 0;
  for (std::size_t f = 0; f < surface.face_count(); ++f) patches += surface.has_patch(PatchId(f));
  EXPECT_EQ(patches, 8u);  // of the inner 2 x 2 squares
  EXPECT_EQ(surface.kind_count(), 1u);
}

TEST(surface, refuses_what_it_cannot_answer) {
  ControlMesh mesh = testing::control_mesh(oracle::meshes::icosahedron());
  mesh.points[3].x = NAN;
  EXPECT_THROW(LimitSurface(mesh, {}, std::make_shared<BoundsCache>()), InputError);
}

// Kinds are found where they are first asked for, by any of many threads.
TEST(surface, kinds_found_by_threads_at_once_are_those_of_one) {
  testing::for_each_surface(7, [](const testing::NamedSurface& named) {
    const LimitSurface& alone = named.surface;
    for (int round = 0; round < 3; ++round) {
      const LimitSurface shared(alone.mesh(), alone.options(), std::make_shared<BoundsCache>());
      ASSERT_EQ(shared.patch_count(), alone.patch_count());
      std::array<std::vector<std::string>, 3> found;
      std::vector<std::thread> threads;
      for (std::size_t t = 0; t < found.size(); ++t) {
        threads.emplace_back([&, t] {
          std::vector<VertexId> control;
          for (std::size_t i = 0; i < shared.patch_count(); ++i) {
            // In different orders.
            const PatchId p(t == 2 ? shared.patch_count() - 1 - i : i);
            if (shared.has_patch(p) != alone.has_patch(p)) found[t].push_back("another surface");
            if (!shared.has_patch(p)) continue;
            if (t == 1 && shared.after_first_split(p) != (shared.polygon_of(p) != nullptr)) {
              found[t].push_back("no polygon");
            }
            if (shared.first(p) != alone.first(p)) found[t].push_back("another corner");
            if (!(shared.kind(p).key() == alone.kind(p).key())) found[t].push_back("another kind");
            std::vector<VertexId> expected;
            alone.control_vertices(p, expected);
            shared.control_vertices(p, control);
            if (control != expected) found[t].push_back("other vertices");
          }
        });
      }
      for (std::thread& thread : threads) thread.join();
      for (const std::vector<std::string>& of_thread : found) {
        EXPECT_TRUE(of_thread.empty()) << named.name << ": " << of_thread[0];
      }
    }
  });
}

}  // namespace
}  // namespace snug::limit_surface_test
