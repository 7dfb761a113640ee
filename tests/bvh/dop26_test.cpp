#include <snug/bvh/dop26.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace snug::dop26_test {
namespace {

// A box around points along the coordinate axes, or along the principal ones.
Obb box_around(const std::vector<Point3>& points, bool aligned) {
  return fit_box(aligned ? Obb{}.axes : principal_axes(points), [&](const Vector3& d) {
    Extent extent;
    for (const Point3& p : points) {
      const double x = dot(d, p - Point3{}), error = 1e-15 * (1 + max_abs(p - Point3{}));
      extent.add({x - error, x + error});
    }
    return extent;
  });
}

long double exact_dot(const Vector3& d, const Vector3& x) {
  return static_cast<long double>(d.x) * x.x + static_cast<long double>(d.y) * x.y +
         static_cast<long double>(d.z) * x.z;
}

// Directions anywhere, in coordinate planes, with equal coordinates, and large and small ones.
Vector3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Vector3 d{normal(random), normal(random), normal(random)};
  for (std::size_t k = 0; k < 3; ++k) {
    if (random() % 5 == 0) d[k] = 0;
    if (random() % 5 == 0) d[k] = random() % 2 == 0 ? d[(k + 1) % 3] : -d[(k + 1) % 3];
  }
  return std::ldexp(1.0, static_cast<int>(random() % 200) - 100) * d;
}

TEST(dop26, no_point_reaches_farther_than_it_says) {
  std::mt19937_64 random(26);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const double spread = std::ldexp(1.0, -static_cast<int>(random() % 40)), off = random() % 2 == 0 ? 0 : 1;
    std::vector<Obb> parts;
    std::vector<Point3> all;
    for (std::size_t part = 0; part < 1 + random() % 6; ++part) {
      std::vector<Point3> set;
      for (std::size_t i = 0; i < 1 + random() % 12; ++i) {
        set.push_back({off + spread * unit(random), spread * unit(random), spread * unit(random) - off});
      }
      parts.push_back(box_around(set, random() % 2 == 0));
      all.insert(all.end(), set.begin(), set.end());
    }
    const Point3 centre{off + spread * unit(random), spread * unit(random), -off};
    const Dop26 dop(parts, centre);
    for (int i = 0; i < 100; ++i) {
      const Vector3 d = random_direction(random);
      const long double slack =
          16 * 0x1p-53L * (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z)) * dop.radius();
      for (const Point3& p : all) {
        ASSERT_LE(exact_dot(d, p - centre), dop.reach(d) + slack) << "trial " << trial;
        ASSERT_LE(max_abs(p - centre), dop.radius() * (1 + 0x1p-50));
      }
    }
  }
}

// Hulls that are larger than the boxes here and smaller there, on either side of the centre, near it and far away.
TEST(dop26, no_point_of_boxes_and_hull_reaches_farther_than_it_says) {
  std::mt19937_64 random(27);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const double spread = std::ldexp(1.0, -static_cast<int>(random() % 40)), off = random() % 2 == 0 ? 0 : 1;
    const Point3 from{off, 0, -off};
    const auto point = [&](double size) {
      return from + size * spread * Vector3{unit(random), unit(random), unit(random)};
    };
    std::vector<Point3> set, hull;
    for (std::size_t i = 0; i < 1 + random() % 12; ++i) set.push_back(point(1));
    // Around the set: each of its points is a mean of some of these.
    for (const Point3& p : set) {
      const Vector3 away = point(1) - from;
      hull.push_back(p + away);
      hull.push_back(p - away);
    }
    std::vector<Obb> boxes;
    for (const Point3& p : set) boxes.push_back(box_around({p}, random() % 2 == 0));
    for (Obb& box : boxes) {
      for (std::size_t k = 0; k < 3; ++k)
        box.half[k] += random() % 2 == 0 ? spread * std::fabs(unit(random)) : 0;
    }
    Dop26 dop(boxes, point(2));
    const Dop26 boxes_alone = dop;
    dop.narrow(hull);
    EXPECT_EQ(dop.centre(), boxes_alone.centre());
    for (int i = 0; i < 100; ++i) {
      const Vector3 d = random_direction(random);
      const double sum = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
      const long double slack = 16 * 0x1p-53L * sum * dop.radius();
      // Hulls' points are rounded.
      const double rounded = 16 * 0x1p-53 * sum;
      for (const Point3& p : set) {
        ASSERT_LE(exact_dot(d, p - dop.centre()), dop.reach(d) + slack + rounded) << "trial " << trial;
        ASSERT_LE(max_abs(p - dop.centre()), dop.radius() * (1 + 0x1p-50) + 16 * 0x1p-53);
      }
      ASSERT_LE(dop.reach(d), boxes_alone.reach(d) + 64 * 0x1p-53 * sum * boxes_alone.radius());
    }
  }
}

// An edge's reach from the boxes, and those of its two axes from boxes and hull.
TEST(dop26, no_direction_reaches_farther_than_its_axes) {
  const Obb box = box_around({{-1, -9, -1}, {1, 9, 1}}, true);
  Dop26 dop({&box, 1}, {});
  dop.narrow(std::vector<Point3>{{-9, -1, -9}, {9, -1, 9}, {9, 1, -9}, {-9, 1, 9}});
  EXPECT_NEAR(dop.radius(), 1, 1e-11);
  EXPECT_LE(dop.reach({1, 1, 0}), 2 + 1e-11);
  EXPECT_LE(dop.reach({-1, 1, -1}), 3 + 1e-11);
}

TEST(dop26, is_as_far_as_the_points_along_its_own_directions) {
  const Obb box = box_around({{-1, -2, -3}, {1, 2, 3}}, true);
  const Dop26 dop({&box, 1}, {});
  for (int place = 0; place < 27; ++place) {
    const Vector3 d{static_cast<double>(place % 3 - 1), static_cast<double>(place / 3 % 3 - 1),
                    static_cast<double>(place / 9 - 1)};
    EXPECT_NEAR(dop.reach(d), std::fabs(d.x) + 2 * std::fabs(d.y) + 3 * std::fabs(d.z), 1e-11);
  }
}

TEST(dop26, what_is_not_finite_reaches_no_number) {
  Obb box;
  box.half = {INFINITY, INFINITY, INFINITY};
  const Dop26 dop({&box, 1}, {});
  EXPECT_FALSE(std::isfinite(dop.reach({1, 2, 3})));
  EXPECT_FALSE(std::isfinite(dop.radius()));
  Dop26 narrowed(std::vector{Obb{}, box}, {});
  EXPECT_FALSE(std::isfinite(narrowed.reach({0, 0, -1})));
  narrowed.narrow(std::vector<Point3>{{1, 2, 3}, {-1, 0, 2}});
  EXPECT_NEAR(narrowed.reach({0, 0, -1}), -2, 1e-12);
}

}  // namespace
}  // namespace snug::dop26_test
