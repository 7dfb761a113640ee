#include <snug/bounds/enclosure.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace snug::segment_test {
namespace {

BoundingPoints points_of(const std::vector<Vector3>& list) {
  BoundingPoints points;
  points.add(list, 0, 0);
  return points;
}

TEST(segment, rests_are_perpendicular_inside_and_reach_to_the_ends_outside) {
  const SegmentFoot foot({1, 0, 0}, {3, 0, 0});
  EXPECT_EQ(foot.rest({2, 5, -1}), (Vector3{0, 5, -1}));
  EXPECT_EQ(foot.rest({0, 1, 0}), (Vector3{-1, 1, 0}));
  EXPECT_EQ(foot.rest({7, 1, 0}), (Vector3{4, 1, 0}));
  const SegmentFoot point({1, 1, 1}, {1, 1, 1});
  EXPECT_EQ(point.rest({2, 0, 1}), (Vector3{1, -1, 0}));
  // The squared length underflows: the foot stays at the first end.
  const SegmentFoot grain({0, 0, 0}, {1e-170, 0, 0});
  EXPECT_EQ(grain.rest({1, 0, 0}), (Vector3{1, 0, 0}));
}

TEST(segment, is_moved_to_the_middle_of_an_arc) {
  const BoundingPoints points = points_of({{0, 0, 0}, {1, 1, 0}, {2, 1, 0}, {3, 0, 0}});
  const OffsetSegment offset = offset_segment(points, {Vector3{0, 0, 0}, Vector3{3, 0, 0}});
  EXPECT_EQ(offset.base[0], (Point3{0, 0.5, 0}));
  EXPECT_EQ(offset.base[1], (Point3{3, 0.5, 0}));
  EXPECT_GE(offset.radius, 0.5);
  EXPECT_LT(offset.radius, 0.5 + 1e-12);
  const IntervalSegment interval = interval_simplex<2>(points, {Vector3{0, 0, 0}, Vector3{3, 0, 0}});
  EXPECT_LE(interval.corner[0].lower.y, 0);
  EXPECT_GE(interval.corner[1].upper.y, 1);
  for (const Box3& box : interval.corner) EXPECT_LT(longest_side(box), 1 + 1e-12);
}

TEST(segment, of_what_is_not_finite_has_an_infinite_radius) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const BoundingPoints points = points_of({{0, 0, 0}, {1, bad, 0}, {3, 0, 0}});
    EXPECT_EQ(offset_segment(points, {Vector3{0, 0, 0}, Vector3{3, 0, 0}}).radius,
              std::numeric_limits<double>::infinity());
  }
}

}  // namespace
}  // namespace snug::segment_test
