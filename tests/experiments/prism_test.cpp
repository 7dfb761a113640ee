#include <experiments/prism.h>

#include <gtest/gtest.h>
#include <snug/bounds/enclosure.h>
#include <testing/containment.h>
#include <testing/patches.h>

namespace snug::prism_test {
namespace {

// The counter-example to [Kobbelt98] of the dissertation's figure 1-4: where a patch is strongly curved it
// bulges sideways over the edges of its limit triangle, and heights along the normal cannot see that.
TEST(kobbelt_prism, misses_a_strongly_curved_patch_that_our_enclosures_contain) {
  // A regular fan of faces around a triangle, folded down steeply all round.
  oracle::TwinMesh cap = oracle::meshes::grid(5, 5);
  for (oracle::Point& p : cap.points) {
    const double x = p[0] - 2.5, y = p[1] - 2.5;
    p = {x, y, -1.5 * (x * x + y * y)};
  }
  const LimitSurface surface = testing::surface_of(cap);
  double worst = 0;
  BoundingPoints points;
  for (std::size_t f = 0; f < surface.face_count(); ++f) {
    const Patch patch = surface.patch(PatchId(f));
    const auto corners = limit_corners(patch);
    bounding_points(surface.library().rows(*patch.kind), patch, points);
    const Prism prism = kobbelt_prism(points, corners);
    const OffsetTriangle offset = offset_triangle(surface.library(), points, corners);
    for (int i = 0; i <= 32; ++i) {
      for (int j = 0; i + j <= 32; ++j) {
        const RelativePoint at = limit_point(patch, {i / 32.0, j / 32.0});
        const Point3 p = patch.origin + at.relative;
        worst = std::max(worst, distance_outside(prism, p) / surface.scale().apply(1.0));
        EXPECT_LE(testing::distance_to_triangle(testing::extended(p), offset.base),
                  offset.radius + 2 * at.error);
      }
    }
  }
  EXPECT_GT(worst, 0.05);  // mesh units; the faces' edges are 1 long from above
}

TEST(kobbelt_prism, contains_a_flat_patch) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::grid(5, 5));
  BoundingPoints points;
  const Patch patch = surface.patch(PatchId(24));
  bounding_points(surface.library().rows(*patch.kind), patch, points);
  const Prism prism = kobbelt_prism(points, limit_corners(patch));
  EXPECT_LT(distance_outside(prism, patch.origin + limit_point(patch, {0.25, 0.25}).relative), 1e-14);
}

}  // namespace
}  // namespace snug::prism_test
