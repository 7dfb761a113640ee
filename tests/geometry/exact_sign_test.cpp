#include <snug/geometry/exact_sign.h>

#include <gmpxx.h>
#include <gtest/gtest.h>
#include <testing/counts.h>

#include <array>
#include <cmath>
#include <random>

namespace snug::exact_sign_test {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

int exact_turn(const Point3& a, const Point3& b, const Point3& c, Projection to) {
  const auto d = [&](const Point3& p, std::size_t k) { return mpq_class(mpq_class(p[k]) - mpq_class(a[k])); };
  return sgn(mpq_class(d(b, to.first) * d(c, to.second) - d(b, to.second) * d(c, to.first)));
}
int exact_side(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  std::array<std::array<mpq_class, 3>, 3> m;
  for (std::size_t k = 0; k < 3; ++k) {
    m[0][k] = mpq_class(b[k]) - mpq_class(a[k]);
    m[1][k] = mpq_class(c[k]) - mpq_class(a[k]);
    m[2][k] = mpq_class(d[k]) - mpq_class(a[k]);
  }
  mpq_class sum = 0;
  for (std::size_t k = 0; k < 3; ++k)
    sum += m[0][k] * (m[1][(k + 1) % 3] * m[2][(k + 2) % 3] - m[1][(k + 2) % 3] * m[2][(k + 1) % 3]);
  return sgn(sum);
}

// Points in general, on a lattice, in a plane or on a line up to the last bits, of sizes far from each other.
TEST(exact_sign, is_that_of_rational_arithmetic) {
  std::mt19937_64 random(1);
  int zero = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(40000)) && !HasFailure(); ++trial) {
    std::array<Point3, 4> p;
    const int sort = trial % 5;
    for (Point3& q : p) {
      for (std::size_t k = 0; k < 3; ++k) {
        q[k] = sort == 0   ? unit(random)
               : sort == 1 ? std::round(1.4 * unit(random))
               : sort == 2 ? std::ldexp(unit(random), -static_cast<int>(random() % 290))
                           : 1 + 0x1p-20 * unit(random);
      }
    }
    if (sort >= 3) {
      const double s = unit(random), t = unit(random);
      p[3] = p[0] + s * (p[1] - p[0]) + t * (p[2] - p[0]);
      if (trial % 2 == 0) p[2] = p[0] + s * (p[1] - p[0]);
      if (trial % 3 == 0) p[3][trial % 2] = std::nextafter(p[3][trial % 2], 2 * unit(random));
    }
    const int side = orientation(p[0], p[1], p[2], p[3]);
    ASSERT_EQ(side, exact_side(p[0], p[1], p[2], p[3])) << trial;
    zero += side == 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Projection to{k, (k + 1) % 3};
      ASSERT_EQ(orientation(p[0], p[1], p[2], to), exact_turn(p[0], p[1], p[2], to)) << trial;
    }
  }
  EXPECT_GT(zero, static_cast<int>(testing::fewer(1000)));
}

TEST(exact_sign, takes_coordinates_whose_products_do_not_underflow) {
  EXPECT_TRUE(may_be_signed({0, -1, 0x1p-300}));
  EXPECT_FALSE(may_be_signed({0, 1, 0x1p-301}));
  EXPECT_FALSE(may_be_signed({0, INFINITY, 1}));
  // The smallest differences that are asked for.
  const double low = 0x1p-300;
  EXPECT_EQ(orientation({low, low, low}, {std::nextafter(low, 1), low, low},
                        {low, std::nextafter(low, 1), low}, {low, low, std::nextafter(low, 1)}),
            1);
}

}  // namespace
}  // namespace snug::exact_sign_test
