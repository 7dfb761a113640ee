// Bounds of the area of a part hold, and their order is what it is meant to be.

#include <snug/patch/area_piece.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace snug {
namespace {

using Coefficients = AreaPiece::Coefficients;

constexpr std::size_t degree_on(Domain domain) { return domain == Domain::triangle ? 6 : 5; }

double power(double x, std::size_t n) { return n == 0 ? 1 : x * power(x, n - 1); }

double choose(std::size_t n, std::size_t k) {
  double b = 1;
  for (std::size_t i = 1; i <= k; ++i) b = b * static_cast<double>(n + 1 - i) / static_cast<double>(i);
  return b;
}

// Length of the polynomial with these Bezier coefficients, rows of u innermost.
long double length_at(Domain domain, const Coefficients& normal, double u, double v) {
  const std::size_t d = degree_on(domain);
  long double sum[3]{};
  std::size_t k = 0;
  for (std::size_t j = 0; j <= d; ++j) {
    for (std::size_t i = 0; i <= (domain == Domain::triangle ? d - j : d); ++i, ++k) {
      const double basis =
          domain == Domain::triangle
              ? choose(d, j) * choose(d - j, i) * power(u, i) * power(v, j) * power(1 - u - v, d - i - j)
              : choose(d, i) * choose(d, j) * power(u, i) * power(1 - u, d - i) * power(v, j) *
                    power(1 - v, d - j);
      for (std::size_t a = 0; a < 3; ++a) sum[a] += static_cast<long double>(basis) * normal[a][k];
    }
  }
  return std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}

// Gauss's rule with three points on each of n cells, of a triangle by folding a square.
long double area(Domain domain, const Coefficients& normal, int n) {
  const long double root = std::sqrt(0.6L) / 2;
  const long double at[] = {0.5L - root, 0.5L, 0.5L + root}, weight[] = {5 / 18.0L, 4 / 9.0L, 5 / 18.0L};
  long double sum = 0;
  for (int y = 0; y < 3 * n; ++y) {
    for (int x = 0; x < 3 * n; ++x) {
      const long double u = (x / 3 + at[x % 3]) / n, t = (y / 3 + at[y % 3]) / n;
      const long double share = weight[x % 3] * weight[y % 3] / (static_cast<long double>(n) * n);
      const long double v = domain == Domain::triangle ? t * (1 - u) : t;
      sum += share * (domain == Domain::triangle ? 1 - u : 1) *
             length_at(domain, normal, static_cast<double>(u), static_cast<double>(v));
    }
  }
  return sum;
}

// 0: anywhere; 1: near one direction; 2: of very different lengths; 3: in a plane through 0; 4: vanishing at a
// corner; 5: constant; 6: nothing at all.
Coefficients random_normal(int kind, std::mt19937_64& random) {
  Coefficients normal{};
  std::uniform_real_distribution<double> number(-1, 1);
  const double constant = number(random);
  for (std::size_t k = 0; k < AreaPiece::max_count; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      double& x = normal[a][k];
      x = number(random);
      if (kind == 1) x = 0.1 * x + (a == 2 ? 1 : 0);
      if (kind == 2) x = std::exp2(10 * x) * (a == 1 ? 1 : 0.3);
      if (kind == 3 && a == 2) x = 0;
      if (kind == 4) x = k == 0 ? 0 : 0.3 * x + (a == 0 ? 1 : 0);
      if (kind == 5) x = constant;
      if (kind == 6) x = 0;
    }
  }
  return normal;
}

TEST(area_piece, holds_the_area_however_it_is_split) {
  std::mt19937_64 random(1);
  for (const Domain domain : {Domain::triangle, Domain::square}) {
    for (int trial = 0; trial < 70; ++trial) {
      const Coefficients normal = random_normal(trial % 7, random);
      const long double truth = area(domain, normal, 24),
                        error = std::fabs(truth - area(domain, normal, 16)) * 4 + 1e-13L * truth;
      std::vector<AreaPiece> pieces{AreaPiece(domain, normal, 0)};
      for (int step = 0; step < 6; ++step) {
        long double lower = 0, upper = 0;
        for (AreaPiece& piece : pieces) {
          const double coarse = piece.gap();
          if (step % 2 == 1) piece.tighten();
          EXPECT_LE(piece.gap(), coarse);
          lower += piece.area().lower;
          upper += piece.area().upper;
        }
        ASSERT_LE(lower, truth + error) << trial << ' ' << step;
        ASSERT_GE(upper, truth - error) << trial << ' ' << step;
        std::vector<AreaPiece> halves;
        for (const AreaPiece& piece : pieces) {
          auto [a, b] = piece.split();
          halves.push_back(a);
          halves.push_back(b);
        }
        pieces = std::move(halves);
      }
    }
  }
}

// Linear, with its zero inside, on the border or just outside: the least of |N| decides there.
TEST(area_piece, holds_near_zeros_of_the_normal) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> number(-0.2, 1.2);
  for (const Domain domain : {Domain::triangle, Domain::square}) {
    const std::size_t d = degree_on(domain);
    for (int trial = 0; trial < 60; ++trial) {
      const double u = number(random), v = number(random), away = std::exp2(-trial % 12);
      Coefficients normal{};
      std::size_t k = 0;
      for (std::size_t j = 0; j <= d; ++j) {
        for (std::size_t i = 0; i <= (domain == Domain::triangle ? d - j : d); ++i, ++k) {
          normal[0][k] = static_cast<double>(i) / static_cast<double>(d) - u;
          normal[1][k] = trial % 3 == 0 ? 0 : static_cast<double>(j) / static_cast<double>(d) - v;
          normal[2][k] = trial % 2 == 0 ? away : 0;
        }
      }
      const long double truth = area(domain, normal, 40),
                        error = std::fabs(truth - area(domain, normal, 24)) * 4 + 1e-13L * truth;
      AreaPiece piece(domain, normal, 0);
      piece.tighten();
      EXPECT_LE(piece.area().lower, truth + error) << trial;
      EXPECT_GE(piece.area().upper, truth - error) << trial;
    }
  }
}

TEST(area_piece, counts_the_error_of_the_normal) {
  std::mt19937_64 random(2);
  for (const Domain domain : {Domain::triangle, Domain::square}) {
    for (const double error : {1e-3, 1e-8}) {
      const Coefficients normal = random_normal(1, random);
      AreaPiece piece(domain, normal, error);
      piece.tighten();
      // All that is within the error.
      for (const double sign : {-1.0, 1.0}) {
        Coefficients other = normal;
        for (double& x : other[2]) x += sign * error;
        const long double truth = area(domain, other, 24);
        EXPECT_LE(piece.area().lower, truth + 1e-12L);
        EXPECT_GE(piece.area().upper, truth - 1e-12L);
      }
    }
  }
}

// Errors fall with more than the sixth power of the size: of the bounds by lengths with the second.
TEST(area_piece, tightens_quickly) {
  std::mt19937_64 random(3);
  for (const Domain domain : {Domain::triangle, Domain::square}) {
    AreaPiece piece(domain, random_normal(1, random), 0);
    for (int step = 0; step < 8; ++step) piece = piece.split().first;
    const double coarse = piece.gap();
    piece.tighten();
    EXPECT_LE(piece.gap(), 1e-3 * coarse);
    EXPECT_LE(piece.gap(), 1e-6 * piece.area().upper);
  }
}

}  // namespace
}  // namespace snug
