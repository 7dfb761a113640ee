#include <snug/bvh/dop26.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace snug {
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
  EXPECT_FALSE(std::isfinite(Dop26(std::vector{Obb{}, box}, {}).reach({0, 0, -1})));
}

}  // namespace
}  // namespace snug
