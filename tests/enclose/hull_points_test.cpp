#include <snug/enclose/hull_points.h>

#include <gtest/gtest.h>
#include <testing/patches.h>

namespace snug {
namespace {

// Samples of a patch lie in its box and in its slab along any direction, for rows and for control points.
TEST(outer_box_and_slab, contain_the_limit_patch) {
  std::mt19937_64 random(18);
  std::normal_distribution<double> normal;
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(18)) {
    const Surface surface = testing::surface_of(twin);
    HullPoints points;
    for (std::size_t f = 0; f < surface.face_count(); ++f) {
      if (!surface.has_patch(FaceId(f))) continue;
      const Patch patch = surface.patch(FaceId(f));
      for (const bool rows : {true, false}) {
        rows ? hull_points(surface.library().rows(*patch.kind), patch, points)
             : control_points(patch, points);
        const Box3 box = outer_box(points);
        const Slab slab = outer_slab(points, {normal(random), normal(random), normal(random)});
        for (int i = 0; i <= 8; ++i) {
          for (int j = 0; i + j <= 8; ++j) {
            const LimitPoint at = limit_point(patch, {i / 8.0, j / 8.0});
            for (std::size_t k = 0; k < 3; ++k) {
              EXPECT_GE(patch.origin[k] + at.relative[k], box.lower[k] - at.error);
              EXPECT_LE(patch.origin[k] + at.relative[k], box.upper[k] + at.error);
            }
            const double height = dot(slab.normal, at.relative), slack = 8 * at.error + 1e-15;
            EXPECT_GE(height, slab.lower - slack);
            EXPECT_LE(height, slab.upper + slack);
          }
        }
      }
    }
  }
}

TEST(hull_rows, are_far_tighter_than_the_control_points) {
  const Surface surface = testing::surface_of(oracle::meshes::quartered(oracle::meshes::icosahedron()));
  HullPoints rows, control;
  const Patch patch = surface.patch(FaceId(0));
  hull_points(surface.library().rows(*patch.kind), patch, rows);
  control_points(patch, control);
  EXPECT_LT(2 * outer_box(rows).longest_side(), outer_box(control).longest_side());
}

}  // namespace
}  // namespace snug
