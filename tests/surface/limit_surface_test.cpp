#include <snug/surface/limit_surface.h>

#include <gtest/gtest.h>
#include <snug/base/error.h>
#include <testing/patches.h>

namespace snug {
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

}  // namespace
}  // namespace snug
