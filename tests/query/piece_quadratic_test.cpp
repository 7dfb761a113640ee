#include <snug/query/piece_quadratic.h>

#include <gtest/gtest.h>
#include <testing/instruction_sets.h>
#include <testing/scheme_surfaces.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <random>

namespace snug::piece_quadratic_test {
namespace {

using Extended = std::array<long double, 3>;

// The Bezier triangle itself, in extended precision.
Extended value(const QuadraticTriangle& q, long double u, long double v) {
  const long double w = 1 - u - v;
  Extended sum;
  for (std::size_t a = 0; a < 3; ++a) {
    sum[a] = w * w * q.corners[0][a] + u * u * q.corners[1][a] + v * v * q.corners[2][a] +
             2 * w * u * q.middles[0][a] + 2 * u * v * q.middles[1][a] + 2 * w * v * q.middles[2][a];
  }
  return sum;
}

struct Case {
  QuadraticTriangle near;
  PiecePath path;
  FlatTriangle triangle;
};

// Near or far from the origin, bent or nearly flat; the triangle the whole piece or a part, its corners on the
// quadratic or off it.
Case random_case(std::mt19937_64& random) {
  const auto coordinate = [&](double size) { return size * (2 * testing::unit(random) - 1); };
  const double size = std::ldexp(1.0, -static_cast<int>(random() % 30)), off = random() % 2 == 0 ? 0 : 1.5,
               bend = std::ldexp(1.0, -static_cast<int>(random() % 3) * 8);
  Case c;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a) c.near.corners[k][a] = off + coordinate(size);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3 p = c.near.corners[k], q = c.near.corners[(k + 1) % 3];
    for (std::size_t a = 0; a < 3; ++a) c.near.middles[k][a] = (p[a] + q[a]) / 2 + coordinate(bend * size);
  }
  c.near.error = random() % 2 == 0 ? 0 : 0.01 * bend * size;
  for (std::size_t level = random() % 4; level > 0; --level)
    c.path = c.path.child(static_cast<unsigned>(random() % 4));
  std::array<std::array<double, 2>, 3> local{{{0, 0}, {1, 0}, {0, 1}}};
  if (random() % 2 == 0) {
    for (auto& p : local) {
      const auto i = random() % 17, j = random() % (17 - i);
      p = {static_cast<double>(i) / 16, static_cast<double>(j) / 16};
    }
  }
  const double gap = random() % 2 == 0 ? 0 : 0.1 * bend * size;
  for (std::size_t k = 0; k < 3; ++k) {
    c.triangle.at[k] = to_face(c.path, {local[k][0], local[k][1]});
    const Extended p = value(c.near, local[k][0], local[k][1]);
    for (std::size_t a = 0; a < 3; ++a) c.triangle.corner[k][a] = static_cast<double>(p[a]) + coordinate(gap);
  }
  return c;
}

// The largest distance over a lattice of parameters.
long double sampled(const Case& c, int steps) {
  long double largest = 0;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const long double b = static_cast<long double>(i) / steps, d = static_cast<long double>(j) / steps;
      std::array<long double, 2> local{};
      for (std::size_t k = 0; k < 3; ++k) {
        const long double weight = k == 0 ? 1 - b - d : k == 1 ? b : d;
        const TriangleParameter at = c.path.local(c.triangle.at[k]);
        local[0] += weight * at.u;
        local[1] += weight * at.v;
      }
      const Extended p = value(c.near, local[0], local[1]);
      long double sq = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const long double x = c.triangle.corner[0][a], y = c.triangle.corner[1][a],
                          z = c.triangle.corner[2][a], off = p[a] - (x + b * (y - x) + d * (z - x));
        sq += off * off;
      }
      largest = std::max(largest, std::sqrt(sq));
    }
  }
  return largest;
}

TEST(piece_quadratic, flatness_bounds_dense_samples) {
  std::mt19937_64 random(41);
  std::vector<double> ratios;
  for (int n = 0; n < 3000; ++n) {
    const Case c = random_case(random);
    const double bound = PieceQuadratic(c.near, c.path).flatness(c.triangle).error - c.near.error;
    const long double found = sampled(c, 16);
    ASSERT_GE(bound, static_cast<double>(found) * (1 - 1e-12)) << "case " << n;
    if (found > 1e-10) ratios.push_back(static_cast<double>(bound / found));
  }
  std::sort(ratios.begin(), ratios.end());
  std::cout << "bound over sampled distance: median " << ratios[ratios.size() / 2] << ", largest "
            << ratios.back() << '\n';
  EXPECT_LE(ratios[ratios.size() / 2], 1.15);
}

TEST(piece_quadratic, flatness_of_some_at_once_is_that_of_each_on_every_instruction_set) {
  std::mt19937_64 random(43);
  for (std::size_t count = 1; count <= PieceQuadratic::max_lanes; ++count) {
    std::vector<PieceQuadratic> quadratics;
    std::vector<FlatTriangle> triangles;
    std::vector<Flatness> each;
    for (std::size_t i = 0; i < count; ++i) {
      const Case c = random_case(random);
      quadratics.emplace_back(c.near, c.path);
      triangles.push_back(c.triangle);
      each.push_back(quadratics[i].flatness(c.triangle));
    }
    std::vector<const PieceQuadratic*> pieces;
    for (const PieceQuadratic& q : quadratics) pieces.push_back(&q);
    testing::EachInstructionSet().run([&](const char* name) {
      std::vector<Flatness> found(count);
      PieceQuadratic::flatness(pieces, triangles, found);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(found[i].error, each[i].error) << name;
        EXPECT_EQ(found[i].corner_gap, each[i].corner_gap) << name;
      }
    });
  }
}

TEST(piece_quadratic, the_error_of_the_quadratic_is_part_of_the_bound) {
  Case c;
  c.near = {{Point3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {Point3{0.5, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}}, 0.25};
  c.triangle = {{Point3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{{0, 0}, {1, 0}, {0, 1}}}};
  EXPECT_GE(PieceQuadratic(c.near, {}).flatness(c.triangle).error, 0.25);
  EXPECT_LE(PieceQuadratic(c.near, {}).flatness(c.triangle).error, 0.25 * (1 + 0x1p-22));
  c.near.error = INFINITY;
  EXPECT_EQ(PieceQuadratic(c.near, {}).flatness(c.triangle).error, INFINITY);
}

TEST(piece_quadratic, flatness_is_not_finite_where_a_coordinate_is_not) {
  std::mt19937_64 random(44);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), static_cast<double>(INFINITY)}) {
    for (std::size_t k = 0; k < 9; ++k) {
      Case c = random_case(random);
      (k < 3 ? c.near.corners[k] : k < 6 ? c.near.middles[k - 3] : c.triangle.corner[k - 6]).y = bad;
      testing::EachInstructionSet().run([&](const char* name) {
        EXPECT_EQ(PieceQuadratic(c.near, c.path).flatness(c.triangle).error, INFINITY) << name << " " << k;
      });
    }
  }
}

TEST(piece_quadratic, bow_is_the_middle_of_the_chord_less_the_curve) {
  std::mt19937_64 random(42);
  for (int n = 0; n < 300; ++n) {
    const Case c = random_case(random);
    const PieceQuadratic q(c.near, c.path);
    const TriangleParameter a = c.path.local(c.triangle.at[0]), b = c.path.local(c.triangle.at[1]);
    const Extended p = value(c.near, a.u, a.v), r = value(c.near, b.u, b.v),
                   m = value(c.near, (a.u + b.u) / 2, (a.v + b.v) / 2);
    const Vector3 bow = q.bow(c.triangle.at[0], c.triangle.at[1]);
    double second_order = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3 corner = c.near.corners[k], next = c.near.corners[(k + 1) % 3];
      second_order =
          std::max(second_order, max_abs((corner - c.near.middles[k]) + (next - c.near.middles[k])));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(bow[k], static_cast<double>((p[k] + r[k]) / 2 - m[k]), 1e-14 + 0x1p-22 * second_order);
    }
  }
}

}  // namespace
}  // namespace snug::piece_quadratic_test
