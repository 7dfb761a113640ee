#include <picture/camera.h>
#include <support/error.h>

#include <gtest/gtest.h>

#include <random>

namespace snug::camera_test {
namespace {

struct Extent {
  double across = 0, upright = 0;  // largest |s| and |t| as shares of the picture's half width and height
  bool in_front = true;
};

Extent extent(const Camera& c, const Box3& box, double aspect) {
  Extent e;
  for (int i = 0; i < 8; ++i) {
    const Point3 p{i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y,
                   i & 4 ? box.upper.z : box.lower.z};
    const Vector3 v = p - c.eye;
    const double depth = dot(v, c.forward);
    e.in_front = e.in_front && depth > 0;
    e.across = std::max(e.across, std::fabs(dot(v, c.right)) / depth / (c.tangent * aspect));
    e.upright = std::max(e.upright, std::fabs(dot(v, c.up)) / depth / c.tangent);
  }
  return e;
}

TEST(camera, axes_are_orthonormal_and_right_handed) {
  const Camera c = frame(Box3{{0, 0, 0}, {1, 2, 3}}, {1, 2, -3}, {0, 0, 5}, 1.5);
  EXPECT_NEAR(length(c.right), 1, 1e-14);
  EXPECT_NEAR(length(c.up), 1, 1e-14);
  EXPECT_NEAR(length(c.forward), 1, 1e-14);
  EXPECT_NEAR(length(cross(c.forward, c.up) - c.right), 0, 1e-14);
  EXPECT_NEAR(dot(c.right, c.up), 0, 1e-14);
  EXPECT_GT(c.up.z, 0);
}

TEST(camera, frame_fills_the_picture_with_every_box_but_for_the_margin) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    SCOPED_TRACE(trial);
    Box3 box;
    box.add(Point3{unit(random), unit(random), unit(random)});
    box.add(Point3{unit(random), unit(random), unit(random)});
    const Vector3 direction{unit(random), unit(random), unit(random)};
    const double aspect = std::exp2(unit(random));
    const Camera c = frame(box, direction, {unit(random), unit(random), unit(random)}, aspect);
    const Extent e = extent(c, box, aspect);
    EXPECT_TRUE(e.in_front);
    EXPECT_LE(e.across, 0.9 + 1e-9);
    EXPECT_LE(e.upright, 0.9 + 1e-9);
    EXPECT_GE(std::max(e.across, e.upright), 0.5);  // less than 0.9 only for boxes seen end on
  }
}

TEST(camera, frame_touches_the_margin_of_the_tighter_direction) {
  const Box3 box{{-1, -1, -1}, {1, 1, 1}};
  for (const double aspect : {0.5, 1.0, 2.0}) {
    const Extent e = extent(frame(box, {1, 1, -1}, {0, 0, 1}, aspect), box, aspect);
    EXPECT_NEAR(std::max(e.across, e.upright), 0.9, 1e-12);
  }
}

TEST(camera, frame_of_a_point_looks_at_it_from_distance_one) {
  const Point3 p{3, 4, 5};
  const Camera c = frame(Box3{p, p}, {0, 1, 0}, {0, 0, 1}, 1);
  EXPECT_EQ(c.eye, (Point3{3, 3, 5}));
}

TEST(camera, frame_refuses_what_it_cannot_show) {
  const Box3 box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_THROW((void)frame(Box3{}, {1, 0, 0}, {0, 0, 1}, 1), InputError);
  EXPECT_THROW((void)frame(std::span<const Point3>{}, {1, 0, 0}, {0, 0, 1}, 1), InputError);
  EXPECT_THROW((void)frame(box, {0, 0, 1}, {0, 0, 2}, 1), InputError);
  EXPECT_THROW((void)frame(box, {0, 0, 0}, {0, 0, 1}, 1), InputError);
  EXPECT_THROW((void)frame(box, {1, 0, 0}, {0, 0, 1}, 0), InputError);
  EXPECT_THROW((void)frame(Box3{{0, 0, 0}, {INFINITY, 1, 1}}, {1, 0, 0}, {0, 0, 1}, 1), InputError);
}

}  // namespace
}  // namespace snug::camera_test
