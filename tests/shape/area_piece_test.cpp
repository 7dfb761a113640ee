// Bounds of the area of a part hold, and their order is what it is meant to be.

#include <snug/shape/area_piece.h>

#include <gtest/gtest.h>

#include <testing/counts.h>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace snug::area_piece_test {
namespace {

using Coefficients = AreaPiece::Coefficients;

constexpr std::size_t degree_on(Domain domain) { return domain == Domain::triangle ? 6 : 5; }

double power(double x, std::size_t n) { return n == 0 ? 1 : x * power(x, n - 1); }

double choose(std::size_t n, std::size_t k) {
  double b = 1;
  for (std::size_t i = 1; i <= k; ++i) b = b * static_cast<double>(n + 1 - i) / static_cast<double>(i);
  return b;
}

// A rule for means over the domain, with the basis functions at its places, rows of u innermost.
struct Rule {
  std::vector<std::array<double, AreaPiece::max_count>> basis;
  std::vector<long double> weight;
};

// Gauss's with three points each way on each of n by n cells, of a triangle by folding a square.
Rule make_rule(Domain domain, int n) {
  const std::size_t d = degree_on(domain);
  const long double root = std::sqrt(0.6L) / 2;
  const long double at[] = {0.5L - root, 0.5L, 0.5L + root}, weight[] = {5 / 18.0L, 4 / 9.0L, 5 / 18.0L};
  Rule rule;
  for (int y = 0; y < 3 * n; ++y) {
    for (int x = 0; x < 3 * n; ++x) {
      const long double s = (x / 3 + at[x % 3]) / n, t = (y / 3 + at[y % 3]) / n;
      const long double share = weight[x % 3] * weight[y % 3] / (static_cast<long double>(n) * n);
      const bool triangle = domain == Domain::triangle;
      const auto u = static_cast<double>(s), v = static_cast<double>(triangle ? t * (1 - s) : t);
      rule.weight.push_back(triangle ? share * (1 - s) : share);
      auto& basis = rule.basis.emplace_back();
      std::size_t k = 0;
      for (std::size_t j = 0; j <= d; ++j) {
        for (std::size_t i = 0; i <= (triangle ? d - j : d); ++i, ++k) {
          const double along = triangle ? choose(d - j, i) * power(1 - u - v, d - i - j)
                                        : choose(d, i) * power(1 - u, d - i) * power(1 - v, d - j);
          basis[k] = along * choose(d, j) * power(u, i) * power(v, j);
        }
      }
    }
  }
  return rule;
}

// The area that belongs to these Bezier coefficients, and how far off it may be.
struct Area {
  long double value, error;
};
long double area_by(const Rule& rule, const Coefficients& normal) {
  long double sum = 0;
  for (std::size_t r = 0; r < rule.weight.size(); ++r) {
    std::array<double, 3> n{};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t k = 0; k < AreaPiece::max_count; ++k) n[a] += rule.basis[r][k] * normal[a][k];
    }
    sum += rule.weight[r] * std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  }
  return sum;
}
Area area(Domain domain, const Coefficients& normal) {
  static const std::array<Rule, 2> rough{make_rule(Domain::triangle, 10), make_rule(Domain::square, 10)},
      fine{make_rule(Domain::triangle, 17), make_rule(Domain::square, 17)};
  const std::size_t which = domain == Domain::triangle ? 0 : 1;
  const long double value = area_by(fine[which], normal);
  return {value, 2 * std::fabs(value - area_by(rough[which], normal)) + 1e-13L * value};
}

void expect_holds(const AreaPiece& piece, const Area& truth, int trial) {
  EXPECT_LE(piece.area().lower, truth.value + truth.error) << trial;
  EXPECT_GE(piece.area().upper, truth.value - truth.error) << trial;
}

// 0: anywhere; 1: near one direction; 2: of very different lengths; 3: in a plane through 0; 4: vanishing at a
// corner; 5: constant; 6: nothing at all; 7: short everywhere but at a corner; 8: linear, with its zero inside, on
// the border or near it.
Coefficients random_normal(int kind, Domain domain, std::mt19937_64& random) {
  Coefficients normal{};
  std::uniform_real_distribution<double> number(-1, 1);
  const double constant = number(random), away = number(random), small = std::exp2(-9 + 4 * number(random));
  const std::size_t d = degree_on(domain);
  std::size_t k = 0;
  for (std::size_t j = 0; j <= d; ++j) {
    for (std::size_t i = 0; i <= (domain == Domain::triangle ? d - j : d); ++i, ++k) {
      const std::array<double, 3> linear{
          static_cast<double>(i) / static_cast<double>(d) - std::max(0.0, constant),
          static_cast<double>(j) / static_cast<double>(d) - away, small};
      for (std::size_t a = 0; a < 3; ++a) {
        double& x = normal[a][k];
        x = number(random);
        if (kind == 1) x = 0.1 * x + (a == 2 ? 1 : 0);
        if (kind == 2) x = std::exp2(10 * x) * (a == 1 ? 1 : 0.3);
        if (kind == 3 && a == 2) x = 0;
        if (kind == 4) x = k == 0 ? 0 : 0.3 * x + (a == 0 ? 1 : 0);
        if (kind == 5) x = constant;
        if (kind == 6) x = 0;
        if (kind == 7) x = k == 0 ? 1 : small * x;
        if (kind == 8) x = linear[a];
      }
    }
  }
  return normal;
}

TEST(area_piece, holds_the_area_however_it_is_split) {
  std::mt19937_64 random(1);
  for (const Domain domain : {Domain::triangle, Domain::square}) {
    for (int trial = 0; trial < static_cast<int>(testing::fewer(160)); ++trial) {
      const Coefficients normal = random_normal(trial % 8, domain, random);
      const auto [truth, error] = area(domain, normal);
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

// The least length decides there.
TEST(area_piece, holds_where_the_normal_is_short) {
  std::mt19937_64 random(4);
  for (const Domain domain : {Domain::triangle, Domain::square}) {
    for (int trial = 0; trial < static_cast<int>(testing::fewer(1500)); ++trial) {
      const Coefficients normal = random_normal(trial % 5 == 0 ? 8 : 7, domain, random);
      AreaPiece piece(domain, normal, 0);
      piece.tighten();
      expect_holds(piece, area(domain, normal), trial);
    }
  }
}

TEST(area_piece, counts_the_error_of_the_normal) {
  std::mt19937_64 random(2);
  for (const Domain domain : {Domain::triangle, Domain::square}) {
    for (const double error : {1e-3, 1e-8}) {
      const Coefficients normal = random_normal(1, domain, random);
      AreaPiece piece(domain, normal, error);
      piece.tighten();
      // All that is within the error.
      for (const double sign : {-1.0, 1.0}) {
        Coefficients other = normal;
        for (double& x : other[2]) x += sign * error;
        expect_holds(piece, area(domain, other), 0);
      }
    }
  }
}

// Errors fall with more than the sixth power of the size: of the bounds by lengths with the second.
TEST(area_piece, tightens_quickly) {
  std::mt19937_64 random(3);
  for (const Domain domain : {Domain::triangle, Domain::square}) {
    AreaPiece piece(domain, random_normal(1, domain, random), 0);
    for (int step = 0; step < 8; ++step) piece = piece.split().first;
    const double coarse = piece.gap();
    piece.tighten();
    EXPECT_LE(piece.gap(), 1e-3 * coarse);
    EXPECT_LE(piece.gap(), 1e-6 * piece.area().upper);
  }
}

}  // namespace
}  // namespace snug::area_piece_test
