#include <snug/surface/evaluate.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <testing/patches.h>

namespace snug {
namespace {

TEST(evaluate, holds_its_error_at_every_scale) {
  for (const double size : {1e-300, 1e-20, 1.0, 7e250}) {
    oracle::TwinMesh twin = oracle::meshes::bipyramid(7);
    for (oracle::Point& p : twin.points) p = {size * (p[0] + 3), size * p[1], size * p[2]};
    const LimitSurface surface = testing::surface_of(twin);
    for (const oracle::LimitSample& s : oracle::sample_uniform(twin, 2)) {
      const SurfacePoint point = evaluate(surface, {s.face, 0, s.u, s.v});
      const BoundedPoint alone = PatchEvaluator(surface, PatchId(s.face))(TriangleParameter{s.u, s.v});
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE(std::fabs(point.position[k] - s.position[k]), point.error + s.error);
        EXPECT_LE(std::fabs(alone.position[k] - s.position[k]), alone.error + s.error);
      }
      EXPECT_LT(point.error, 1e-13 * size + 1e-307);
      ASSERT_TRUE(point.normal);
      EXPECT_NEAR(length(*point.normal), 1, 1e-14);
    }
  }
}

}  // namespace
}  // namespace snug
