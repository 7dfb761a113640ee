#include <snug/geometry/interval.h>
#include <snug/geometry/rounding.h>

#include <gtest/gtest.h>
#include <mpfr.h>
#include <testing/counts.h>

#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace snug::interval_test {
namespace {

// Ends on purpose: zeros, ones, neighbours of powers of two, tiny and huge.
double adversarial(std::mt19937_64& random) {
  static constexpr double ends[] = {0, 1, -1, 0x1p-1022, 0x1p-1074, 1e300, -1e300, 0.5, 3, 1.0 / 3};
  if (random() % 4 == 0) return ends[random() % std::size(ends)];
  const double mantissa = std::ldexp(static_cast<double>(random() >> 11), -53) + 0.5;
  const double x = std::ldexp(mantissa, static_cast<int>(random() % 80) - 40);
  return random() % 2 ? x : -x;
}

Interval any_interval(std::mt19937_64& random) {
  const double a = adversarial(random), b = random() % 3 ? adversarial(random) : a;
  return {std::fmin(a, b), std::fmax(a, b)};
}

// Exact enough: 300 bits hold every product and sum of such doubles, and quotients to 2^-300.
class Exact {
 public:
  explicit Exact(double x) { mpfr_init2(value_, 3000), mpfr_set_d(value_, x, MPFR_RNDN); }
  ~Exact() { mpfr_clear(value_); }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
  mpfr_t value_;
};

bool holds(const Interval& range, const Exact& x) {
  return mpfr_cmp_d(x.value_, range.lower) >= 0 && mpfr_cmp_d(x.value_, range.upper) <= 0;
}

TEST(rounding, neighbours_are_those_of_nextafter) {
  const auto expect_equal = [](double x, double y) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(x), std::bit_cast<std::uint64_t>(y));
  };
  std::vector<double> all{0.0, 0x1p-1074, 0x1p-1022, std::nextafter(0x1p-1022, 0), 1, DBL_MAX, INFINITY};
  std::mt19937_64 random(5);
  for (int i = 0; i < 10000; ++i) all.push_back(std::fabs(std::bit_cast<double>(random())));
  for (const double size : all) {
    for (const double x : {size, -size}) {
      if (std::isnan(x)) continue;
      expect_equal(rounded_up(x), std::nextafter(x, INFINITY));
      expect_equal(rounded_down(x), std::nextafter(x, -INFINITY));
    }
  }
  EXPECT_TRUE(std::isnan(rounded_up(NAN)) && std::isnan(rounded_down(NAN)));
}

TEST(interval, sines_cosines_and_roots_contain_the_exact_ones) {
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 4000; ++trial) {
    // Near multiples of a quarter turn on purpose.
    const double quarters = static_cast<double>(random() % 41) - 20;
    const double near =
        quarters * 1.5707963267948966 + (random() % 2 ? std::ldexp(adversarial(random), -60) : 0);
    const double x = random() % 3 ? std::fmod(adversarial(random), 1e6) : near;
    const double width = random() % 2 ? 0 : 1e-3 * static_cast<double>(random() % 1000);
    const Interval angle(x, x + width);
    const auto [sine, cosine] = sine_cosine(angle);
    for (const double y : {angle.lower, angle.upper, middle(angle)}) {
      const Exact u(y);
      Exact r(0);
      mpfr_sin(r.value_, u.value_, MPFR_RNDN);
      ASSERT_TRUE(holds(sine, r)) << "sin " << y;
      mpfr_cos(r.value_, u.value_, MPFR_RNDN);
      ASSERT_TRUE(holds(cosine, r)) << "cos " << y;
      if (y < 0) continue;
      mpfr_sqrt(r.value_, u.value_, MPFR_RNDN);
      ASSERT_TRUE(holds(square_root(angle), r)) << "root " << y;
    }
    if (width == 0 && std::fabs(x) <= 4) {
      ASSERT_LE(sine.upper - sine.lower, 64 * 0x1p-53);
      ASSERT_LE(cosine.upper - cosine.lower, 64 * 0x1p-53);
    }
  }
}

TEST(interval, operations_contain_the_exact_results_of_their_ends) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < static_cast<int>(testing::fewer(20'000)); ++trial) {
    const Interval a = any_interval(random), b = any_interval(random);
    for (const double x : {a.lower, a.upper, middle(a)}) {
      for (const double y : {b.lower, b.upper, middle(b)}) {
        const Exact u(x), v(y);
        Exact r(0);
        mpfr_add(r.value_, u.value_, v.value_, MPFR_RNDN);
        ASSERT_TRUE(holds(a + b, r)) << x << " + " << y;
        mpfr_sub(r.value_, u.value_, v.value_, MPFR_RNDN);
        ASSERT_TRUE(holds(a - b, r)) << x << " - " << y;
        mpfr_mul(r.value_, u.value_, v.value_, MPFR_RNDN);
        ASSERT_TRUE(holds(a * b, r)) << x << " * " << y;
        if (y == 0) continue;
        mpfr_div(r.value_, u.value_, v.value_, MPFR_RNDN);
        ASSERT_TRUE(holds(a / b, r)) << x << " / " << y;
      }
    }
  }
}

TEST(interval, middle_and_radius_cover_the_ends) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < static_cast<int>(testing::fewer(20'000)); ++trial) {
    const Interval a = any_interval(random);
    EXPECT_GE(radius(a), std::fmax(a.upper - middle(a), middle(a) - a.lower));
  }
}

TEST(cos_of_turn, contains_the_cosine_and_is_narrow) {
  mpfr_t x, c;
  mpfr_inits2(200, x, c, nullptr);
  for (unsigned n = 1; n <= 2000; ++n) {
    for (const unsigned k : {0u, 1u, 2u, n / 4, n / 3, n / 2, n - 1, 3 * n + 1}) {
      mpfr_const_pi(x, MPFR_RNDN);
      mpfr_mul_ui(x, x, 2 * (k % n), MPFR_RNDN);
      mpfr_div_ui(x, x, n, MPFR_RNDN);
      mpfr_cos(c, x, MPFR_RNDN);
      const Interval range = cos_of_turn(k, n);
      // 200 bits leave an error of 2^-190, seen only where the cosine is an exact double.
      mpfr_sub_d(x, c, range.lower, MPFR_RNDN);
      ASSERT_GE(mpfr_get_d(x, MPFR_RNDN), -0x1p-180) << k << "/" << n;
      mpfr_sub_d(x, c, range.upper, MPFR_RNDN);
      ASSERT_LE(mpfr_get_d(x, MPFR_RNDN), 0x1p-180) << k << "/" << n;
      ASSERT_LE(range.upper - range.lower, 64 * 0x1p-53) << k << "/" << n;
    }
  }
  mpfr_clears(x, c, nullptr);
}

TEST(cos_of_turn, is_exact_where_it_is_rational) {
  EXPECT_EQ(cos_of_turn(1, 3), Interval(-0.5));
  EXPECT_EQ(cos_of_turn(1, 4), Interval(0.0));
  EXPECT_EQ(cos_of_turn(1, 6), Interval(0.5));
  EXPECT_EQ(cos_of_turn(5, 10), Interval(-1.0));
}

TEST(interval, sines_of_degrees_contain_the_exact_ones) {
  std::mt19937_64 random(7);
  const std::vector<double> ends{0,   1e-320, 45,  -45, 90, 135,   180,   225,
                                 270, 315,    360, 30,  60, 1e300, -1e17, 44.999999999999993};
  for (int trial = 0; trial < static_cast<int>(testing::fewer(20'000)); ++trial) {
    const double angle = trial < 16 ? ends[trial] : std::uniform_real_distribution<double>(-800, 800)(random);
    const SineCosine found = of_degrees(angle);
    Exact radians(angle), pi(0), sine(0), cosine(0);
    mpfr_const_pi(pi.value_, MPFR_RNDN);
    mpfr_mul(radians.value_, radians.value_, pi.value_, MPFR_RNDN);
    mpfr_div_ui(radians.value_, radians.value_, 180, MPFR_RNDN);
    mpfr_sin_cos(sine.value_, cosine.value_, radians.value_, MPFR_RNDN);
    if (std::fmod(angle, 90) == 0) {
      ASSERT_EQ(found.sine.lower, found.sine.upper);
      ASSERT_EQ(found.sine.lower, std::round(mpfr_get_d(sine.value_, MPFR_RNDN))) << angle;
      ASSERT_EQ(found.cosine.lower, std::round(mpfr_get_d(cosine.value_, MPFR_RNDN))) << angle;
      continue;
    }
    ASSERT_TRUE(holds(found.sine, sine)) << angle;
    ASSERT_TRUE(holds(found.cosine, cosine)) << angle;
    ASSERT_LE(found.sine.upper - found.sine.lower, 0x1p-46) << angle;
    ASSERT_LE(found.cosine.upper - found.cosine.lower, 0x1p-46) << angle;
  }
}

}  // namespace
}  // namespace snug::interval_test
