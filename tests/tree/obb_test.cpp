#include <snug/tree/obb.h>

#include <gtest/gtest.h>
#include <testing/containment.h>

#include <random>
#include <vector>

namespace snug {
namespace {

using testing::Extended;

OffsetTriangle any_triangle(std::mt19937_64& random, const Point3& centre, double size) {
  std::uniform_real_distribution<double> unit(-size, size);
  OffsetTriangle t;
  for (Point3& p : t.base) p = centre + Vector3{unit(random), 0.3 * unit(random), 0.05 * unit(random)};
  if (random() % 5 == 0) t.base[2] = t.base[1];
  t.radius = size * 0.1 * static_cast<double>(random() % 10);
  return t;
}

PlacedFrame any_frame(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  // Gram-Schmidt in doubles: rigid to a few roundings.
  Vector3 a{normal(random), normal(random), normal(random)},
      b{normal(random), normal(random), normal(random)};
  a = (1 / length(a)) * a;
  b = b - dot(a, b) * a;
  b = (1 / length(b)) * b;
  PlacedFrame frame;
  frame.rows = {a, b, cross(a, b)};
  frame.scale = random() % 2 ? 1.0 : 0.25;
  frame.translation = {normal(random), normal(random), normal(random)};
  frame.defect = 1e-15;
  return frame;
}

Extended image(const PlacedFrame& frame, const Extended& p) {
  Extended q;
  for (std::size_t k = 0; k < 3; ++k) {
    q[k] = frame.scale * (p[0] * frame.rows[k].x + p[1] * frame.rows[k].y + p[2] * frame.rows[k].z) +
           frame.translation[k];
  }
  return q;
}

TEST(outer_obb, contains_its_offset_triangles) {
  std::mt19937_64 random(22);
  for (int trial = 0; trial < 5000; ++trial) {
    std::vector<OffsetTriangle> triangles;
    for (std::size_t i = 0; i < 1 + random() % 5; ++i)
      triangles.push_back(any_triangle(random, {0.5, 1, -1.2}, 0.3));
    std::vector<const OffsetTriangle*> members;
    for (const OffsetTriangle& t : triangles) members.push_back(&t);
    const Obb box = outer_obb(members);
    for (const OffsetTriangle& t : triangles) {
      for (const Point3& p : t.base) {
        for (std::size_t k = 0; k < 3; ++k) {
          const Extended axis{box.axes[k].x, box.axes[k].y, box.axes[k].z};
          const long double height =
              testing::inner(axis, testing::minus(testing::extended(p), testing::extended(box.centre)));
          const long double reach = t.radius * std::sqrt(testing::inner(axis, axis));
          ASSERT_LE(std::fabs(height) + reach, box.half[k]);
        }
      }
    }
  }
}

// Corner triangles of two clusters, placed: the gap of their boxes is never more than the distance of the
// contents.
TEST(certain_gap, never_exceeds_the_distance_of_the_contents) {
  std::mt19937_64 random(23);
  int gaps = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const OffsetTriangle a = any_triangle(random, {0, 0, 0}, 0.5),
                         b = any_triangle(random, {0.9, 0.2, 0}, 0.5);
    const OffsetTriangle* const only_a = &a;
    const OffsetTriangle* const only_b = &b;
    const PlacedFrame frame_a = any_frame(random), frame_b = any_frame(random);
    const double gap = certain_gap(placed(outer_obb({&only_a, 1}), frame_a),
                                   placed(outer_obb({&only_b, 1}), frame_b), frame_a.defect + frame_b.defect);
    if (gap <= 0) continue;
    ++gaps;
    long double nearest_corner = INFINITY;
    for (const Point3& p : a.base) {
      for (const Point3& q : b.base) {
        const Extended d =
            testing::minus(image(frame_a, testing::extended(p)), image(frame_b, testing::extended(q)));
        nearest_corner = std::min(nearest_corner, std::sqrt(testing::inner(d, d)));
      }
    }
    ASSERT_LE(gap, nearest_corner - frame_a.scale * a.radius - frame_b.scale * b.radius) << trial;
  }
  EXPECT_GT(gaps, 2000);
}

// A placement may stretch by as much as rigidity_tolerance: gaps along cross products stay below the distance all the same.
// Thin boxes along nearly the same direction, one above the other, turned so that only the cross product sees the gap.
TEST(certain_gap, holds_for_placements_that_stretch_as_far_as_allowed) {
  const double e = 0.499999e-9;
  PlacedFrame frame;
  frame.rows = {Vector3{1 + e, e, e}, {e, 1 + e, e}, {e, e, 1 + e}};
  frame.defect = 1e-9;
  const Vector3 along = (1 / std::sqrt(3.0)) * Vector3{1, 1, 1},
                above = (1 / std::sqrt(2.0)) * Vector3{1, -1, 0};
  const Vector3 aside = cross(above, along);
  const auto box = [&](double angle, const Point3& centre) {
    const Vector3 first = std::cos(angle) * along + std::sin(angle) * aside;
    const Vector3 second = -std::sin(angle) * along + std::cos(angle) * aside;
    Obb result;
    result.axes = {first, std::cos(0.7) * second + std::sin(0.7) * above,
                   -std::sin(0.7) * second + std::cos(0.7) * above};
    result.half = {1e-9, 0, 0};
    result.centre = centre;
    return placed(result, frame);
  };
  for (double angle = 0.0317; angle < 1.5; angle *= 1.02) {
    const PlacedObb a = box(-angle / 2, {}), b = box(angle / 2, Point3{} + above);
    const Extended d = testing::minus(testing::extended(b.centre), testing::extended(a.centre));
    EXPECT_LE(certain_gap(a, b, 2e-9), std::sqrt(testing::inner(d, d))) << angle;
  }
}

TEST(certain_gap, finds_most_of_the_distance_between_boxes_side_by_side) {
  OffsetTriangle a{{Point3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0.1}, b = a;
  for (Point3& p : b.base) p.z += 2;
  const OffsetTriangle* const only_a = &a;
  const OffsetTriangle* const only_b = &b;
  PlacedFrame here;
  here.rows = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double gap =
      certain_gap(placed(outer_obb({&only_a, 1}), here), placed(outer_obb({&only_b, 1}), here), 0);
  EXPECT_NEAR(gap, 1.8, 1e-11);
}

}  // namespace
}  // namespace snug
