#include <snug/geometry/quadratic_distance.h>

#include <gtest/gtest.h>
#include <testing/counts.h>
#include <testing/instruction_sets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <vector>

namespace snug::quadratic_distance_test {
namespace {

using Extended = std::array<long double, 3>;

Extended minus(const Extended& a, const Extended& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
long double inner(const Extended& a, const Extended& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Case {
  std::array<float, 18> net;
  std::array<float, 3> point;

  // Flat, bent, thin, of one point or one line; points on it, beside it and far away.
  explicit Case(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const double size = std::pow(10.0, -static_cast<double>(random() % 7)),
                 away = std::array{0.0, 1.0, 10.0, 1e5}[random() % 4] * size,
                 bend = std::array{0.0, 0.05, 1.0}[random() % 3] * size;
    std::array<double, 3> shape{size, size * std::array{1.0, 1e-4, 0.0}[random() % 3],
                                size * std::array{1.0, 0.0}[random() % 2]};
    if (random() % 20 == 0) shape = {0, 0, 0};
    std::array<std::array<double, 3>, 6> at;
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t x = 0; x < 3; ++x) {
        at[k][x] = k < 3 ? shape[x] * normal(random) + (x == 0 ? 1 : -0.5) * size
                         : 0.5 * (at[k - 3][x] + at[(k - 2) % 3][x]) + bend * normal(random);
        net[3 * k + x] = static_cast<float>(at[k][x]);
      }
    }
    for (std::size_t x = 0; x < 3; ++x) point[x] = net[9 + x] + static_cast<float>(away * normal(random));
  }
  [[nodiscard]] Extended at(long double u, long double v) const {
    const long double r = 1 - u - v;
    const std::array<long double, 6> weights{r * r, u * u, v * v, 2 * r * u, 2 * u * v, 2 * r * v};
    Extended p{-static_cast<long double>(point[0]), -static_cast<long double>(point[1]),
               -static_cast<long double>(point[2])};
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t x = 0; x < 3; ++x) p[x] += weights[k] * net[3 * k + x];
    }
    return p;
  }
  // What roundings are measured by.
  [[nodiscard]] long double sizes(long double distance) const {
    long double spread = 0, own = 0;
    for (std::size_t k = 1; k < 6; ++k) {
      long double sum = 0;
      for (std::size_t x = 0; x < 3; ++x) sum += std::fabs(static_cast<long double>(net[3 * k + x]) - net[x]);
      spread = std::max(spread, 2 * sum);
    }
    for (const float x : point) own += std::fabs(static_cast<long double>(x));
    return own + 2 * distance + 8 * spread;
  }
};

// The distance of the origin from a triangle: of its plane's foot, and of its sides.
long double distance_of(const Extended& a, const Extended& b, const Extended& c) {
  const auto on_side = [](const Extended& p, const Extended& q) {
    const Extended e = minus(q, p);
    const long double ee = inner(e, e);
    const long double t = ee > 0 ? std::clamp(-inner(e, p) / ee, 0.0L, 1.0L) : 0;
    const Extended x{p[0] + t * e[0], p[1] + t * e[1], p[2] + t * e[2]};
    return inner(x, x);
  };
  long double best = std::min({on_side(a, b), on_side(b, c), on_side(c, a)});
  const Extended e = minus(b, a), f = minus(c, a);
  const long double ee = inner(e, e), ff = inner(f, f), ef = inner(e, f), det = ee * ff - ef * ef;
  const long double s = -(ff * inner(e, a) - ef * inner(f, a)), t = -(ee * inner(f, a) - ef * inner(e, a));
  if (s >= 0 && t >= 0 && s + t <= det && det > 0) {
    Extended x = a;
    for (std::size_t k = 0; k < 3; ++k) x[k] += (s * e[k] + t * f[k]) / det;
    best = std::min(best, inner(x, x));
  }
  return std::sqrt(best);
}

long double exact_distance(const Case& c) {
  long double least = INFINITY;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i + j < 4; ++i) {
      const auto at = [&](int k, int l) { return c.at((i + k) / 4.0L, (j + l) / 4.0L); };
      least = std::min(least, distance_of(at(0, 0), at(1, 0), at(0, 1)));
      if (i + j < 3) least = std::min(least, distance_of(at(1, 1), at(0, 1), at(1, 0)));
    }
  }
  return least;
}

TEST(flattened_distance, holds_the_distance_of_sixteen_triangles) {
  std::mt19937_64 random(41);
  std::size_t narrow = 0;
  const std::size_t trials = testing::fewer(40'000);
  for (std::size_t trial = 0; trial < trials; ++trial) {
    const Case c(random);
    const FlattenedDistance found = flattened_distance(c.net.data(), c.point.data());
    const long double exact = exact_distance(c), doubt = 0x1p-18L * c.sizes(exact) + 0x1p-55L;
    ASSERT_LE(found.lower - doubt, exact) << trial;
    ASSERT_GE(found.upper + doubt, exact) << trial;
    ASSERT_GE(found.at.u, -1e-6);
    ASSERT_GE(found.at.v, -1e-6);
    ASSERT_LE(found.at.u + found.at.v, 1 + 1e-6);
    narrow += found.upper - found.lower < 2 * doubt;
  }
  std::printf("  %zu of %zu as narrow as roundings\n", narrow, trials);
  EXPECT_GT(narrow, trials * 9 / 10);
}

TEST(flattened_distance, is_the_same_on_every_instruction_set) {
  std::mt19937_64 random(42);
  const testing::EachInstructionSet sets;
  for (int trial = 0; trial < 2000; ++trial) {
    const Case c(random);
    std::optional<FlattenedDistance> first;
    sets.run([&](const char* name) {
      const FlattenedDistance found = flattened_distance(c.net.data(), c.point.data());
      if (!first) first = found;
      EXPECT_EQ(found.lower, first->lower) << name << ' ' << trial;
      EXPECT_EQ(found.upper, first->upper) << name << ' ' << trial;
      EXPECT_EQ(found.at.u, first->at.u) << name << ' ' << trial;
      EXPECT_EQ(found.at.v, first->at.v) << name << ' ' << trial;
    });
  }
}

}  // namespace
}  // namespace snug::quadratic_distance_test
