#include <snug/bounds/tip_table.h>

#include <gtest/gtest.h>
#include <snug/bounds/table_triangle.h>
#include <snug/patch/evaluate.h>
#include <testing/counts.h>
#include <testing/scheme_surfaces.h>

namespace snug::tip_table_test {
namespace {

// The same boxes by middle and half width, at the origin of the patch.
TEST(tip_table, gives_the_boxes_of_the_table_triangle) {
  std::size_t compared = 0;
  testing::for_each_surface(87, [&](const testing::NamedSurface& named) {
    testing::for_each_patch(named.surface, [&](PatchId p) {
      Patch patch = named.surface.patch(p);
      if (!patch.kind->cacheable() || ++compared % 8 != 0) return;
      patch.first = 0;
      patch.origin = {};
      const BoundTable& table = named.surface.library().table(*patch.kind);
      const IntervalTriangle interval = table_triangle(table, patch).interval;
      const TipBoxes boxes = TipTable(table).boxes(patch);
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t a = 0; a < 3; ++a) {
          EXPECT_NEAR(boxes.lower[k][a], interval.corner[k].lower[a], 1e-12) << named.name;
          EXPECT_NEAR(boxes.upper[k][a], interval.corner[k].upper[a], 1e-12) << named.name;
        }
      }
    });
  });
  EXPECT_GT(compared, testing::fewer(2000));
}

// Boxes are widened by what roundings may take: at a patch whose control points are one of 2^-40 of the
// others' size apart from a plane, the limits of corners lie in the boxes' hull, corner by corner of the
// axes.
TEST(tip_table, holds_limit_corners_of_points_far_from_the_origin) {
  testing::for_each_surface(88, [&](const testing::NamedSurface& named) {
    testing::for_each_patch(named.surface, [&](PatchId p) {
      Patch patch = named.surface.patch(p);
      if (!patch.kind->cacheable() || p.index() % 8 != 0) return;
      for (Vector3& point : patch.points) point = 0x1p-40 * point + Vector3{0.3, -0.7, 0.1};
      patch.error = 0;
      patch.largest = 1;
      const TipBoxes boxes = TipTable(named.surface.library().table(*patch.kind)).boxes(patch);
      for (std::size_t k = 0; k < 3; ++k) {
        const RelativePoint corner = corner_point(patch, k);
        for (std::size_t a = 0; a < 3; ++a) {
          const double low = std::min({boxes.lower[0][a], boxes.lower[1][a], boxes.lower[2][a]}),
                       high = std::max({boxes.upper[0][a], boxes.upper[1][a], boxes.upper[2][a]});
          EXPECT_GE(corner.relative[a], low - corner.error) << named.name;
          EXPECT_LE(corner.relative[a], high + corner.error) << named.name;
        }
      }
    });
  });
}

}  // namespace
}  // namespace snug::tip_table_test
