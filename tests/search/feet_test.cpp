#include <snug/search/feet.h>

#include <gtest/gtest.h>
#include <snug/geometry/rounding.h>
#include <support/direction.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace snug::feet_test {
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double within(double a) { return a * (2 * unit() - 1); }
  Vector3 vector(double a) { return {within(a), within(a), within(a)}; }
  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  TriangleParameter parameter() {
    const double u = unit(), v = unit();
    return u + v <= 1 ? TriangleParameter{u, v} : TriangleParameter{1 - u, 1 - v};
  }
  // Flat, bent a little, bent a lot; large, small, needles, points.
  QuadraticTriangle quadratic() {
    const double size = std::pow(10, -3 * unit());
    const Point3 o = Point3{} + vector(1);
    Triangle t{o, o + vector(size), o + vector(size)};
    if (below(8) == 0) t[2] = t[0] + unit() * (t[1] - t[0]) + vector(1e-9);
    if (below(30) == 0) t[1] = t[2] = t[0];
    QuadraticTriangle q = flat_quadratic(t);
    const double bend = std::array{0.0, 0.01, 0.1, 0.6}[below(4)];
    if (bend > 0) {
      for (Point3& m : q.middles) m = m + vector(bend * size);
      q.error = below(2) == 0 ? 0 : 0.01 * size * unit();
    }
    return q;
  }

 private:
  std::mt19937_64 random_;
};

double sampled_distance(const QuadraticTriangle& q, const Point3& p, int steps) {
  double least = INFINITY;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const TriangleParameter at{static_cast<double>(i) / steps, static_cast<double>(j) / steps};
      least = std::min(least, distance(point_of(q, at), p));
    }
  }
  return least;
}

TEST(feet, restrictions_are_the_same_points) {
  Draw draw(1);
  for (int i = 0; i < 1000; ++i) {
    const QuadraticTriangle q = draw.quadratic();
    const std::array<TriangleParameter, 3> corners{draw.parameter(), draw.parameter(), draw.parameter()};
    const QuadraticTriangle part = restricted(q, corners);
    const TriangleParameter at = draw.parameter();
    const double w = 1 - at.u - at.v;
    const TriangleParameter there{w * corners[0].u + at.u * corners[1].u + at.v * corners[2].u,
                                  w * corners[0].v + at.u * corners[1].v + at.v * corners[2].v};
    EXPECT_LT(distance(point_of(part, at), point_of(q, there)), 1e-14);
    EXPECT_EQ(part.error, q.error);
  }
}

// Lower bounds hold against samples, and are as near to the nearest foot as they say.
TEST(feet, certain_distances_hold_and_are_narrow) {
  Draw draw(2);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<QuadraticTriangle> quadratics(1 + draw.below(60));
    for (QuadraticTriangle& q : quadratics) q = draw.quadratic();
    PieceSet set(quadratics);
    set.prepare(1);
    for (int i = 0; i < 20; ++i) {
      Point3 p = Point3{} + draw.vector(1.5);
      if (i % 3 == 0)
        p = point_of(quadratics[draw.below(quadratics.size())], draw.parameter()) + draw.vector(1e-3);
      QuadraticFoot foot = nearest_foot(set, p);
      const double gap = 1e-4, certain = certain_distance(set, p, gap, foot);
      double sampled = INFINITY, max_error = 0;
      for (const QuadraticTriangle& q : quadratics) {
        sampled = std::min(sampled, sampled_distance(q, p, 24) - q.error);
        max_error = std::max(max_error, q.error);
      }
      EXPECT_LE(certain, std::max(0.0, sampled));
      EXPECT_GE(certain, foot.distance - gap - max_error - 1e-11);
      EXPECT_LE(foot.distance, sampled + max_error + gap) << "there is a nearer point";
      EXPECT_NEAR(distance(foot.point, p), foot.distance, 1e-15);
      EXPECT_LT(distance(point_of(quadratics[foot.piece], foot.at), foot.point), 1e-12);
    }
  }
}

TEST(feet, nearest_feet_are_the_nearest_of_all_pieces) {
  Draw draw(8);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<QuadraticTriangle> quadratics(1 + draw.below(60));
    for (QuadraticTriangle& q : quadratics) q = draw.quadratic();
    PieceSet set(quadratics);
    set.prepare(1);
    for (int i = 0; i < 20; ++i) {
      const Point3 p = Point3{} + draw.vector(std::array{0.5, 1.5, 5.0}[draw.below(3)]);
      double least = INFINITY;
      for (std::uint32_t piece = 0; piece < set.size(); ++piece)
        least = std::min(least, foot_on(set, piece, p).distance);
      EXPECT_NEAR(nearest_foot(set, p).distance, least, 1e-14);
    }
  }
}

TEST(feet, feet_on_triangles_are_the_nearest) {
  Draw draw(3);
  for (int i = 0; i < 20'000; ++i) {
    const Point3 o = Point3{} + draw.vector(1);
    const std::vector<QuadraticTriangle> one{flat_quadratic({o, o + draw.vector(1), o + draw.vector(1)})};
    PieceSet set(one);
    set.prepare(1);
    const Point3 p = Point3{} + draw.vector(2);
    QuadraticFoot foot = foot_on(set, 0, p);
    EXPECT_NEAR(certain_distance(set, p, 0, foot), foot.distance, 1e-11);
  }
}

// Corners at the same point, on a line, and nearly so, in any order.
TEST(feet, feet_on_narrow_triangles_are_the_nearest) {
  Draw draw(6);
  constexpr std::array widths{0.0, 1e-300, 1e-15, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2};
  for (std::size_t i = 0; i < 20'000; ++i) {
    const double width = widths[i % widths.size()];
    const Point3 o = Point3{} + draw.vector(1);
    const Vector3 along = draw.vector(1);
    const double share = std::array{0.0, 1.0, 1e-8, 0.25, -0.5, 1.5, draw.unit()}[draw.below(7)];
    std::array<Point3, 3> corners{o, o + along, (o + share * along) + draw.vector(width)};
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(draw.below(3)), corners.end());
    if (draw.below(2) == 0) std::swap(corners[0], corners[1]);
    const std::vector<QuadraticTriangle> one{flat_quadratic(corners)};
    PieceSet set(one);
    set.prepare(1);
    const double near = std::array{1e-5, 1e-2, 2.0}[draw.below(3)];
    const Point3 p = point_of(one[0], draw.parameter()) + draw.vector(near);
    QuadraticFoot foot = foot_on(set, 0, p);
    // A foot off by roundings turns the plane the more the nearer p is.
    EXPECT_NEAR(certain_distance(set, p, 0, foot), foot.distance, near < 1e-3 ? 1e-5 : 1e-7)
        << width << ' ' << share << ' ' << near;
  }
}

// Newton's method may end at another point: not too often for points of plane pieces whose parameters are uneven, which lie on them.
TEST(feet, feet_on_bent_pieces_are_mostly_the_nearest) {
  Draw draw(7);
  constexpr std::array bends{0.15, 0.3, 0.6};
  constexpr std::size_t trials = 3000;
  std::size_t missed = 0;
  for (std::size_t i = 0; i < trials; ++i) {
    const auto plane = [&](double most) { return Vector3{draw.within(most), draw.within(most), 0}; };
    const Point3 o = Point3{} + plane(1);
    QuadraticTriangle q = flat_quadratic({o, o + plane(1), o + plane(1)});
    for (Point3& m : q.middles) m = m + plane(bends[i % bends.size()]);
    const PieceSet set(std::vector<QuadraticTriangle>{q});
    missed += foot_on(set, 0, point_of(q, draw.parameter())).distance > 1e-4;
  }
  EXPECT_LT(100 * missed, 9 * trials);
}

TEST(feet, below_is_the_restriction_to_feet) {
  Draw draw(4);
  for (int i = 0; i < 1000; ++i) {
    const std::vector<QuadraticTriangle> one{draw.quadratic()};
    PieceSet set(one);
    set.prepare(1);
    std::array<QuadraticFoot, 3> feet;
    for (QuadraticFoot& foot : feet) foot = foot_on(set, 0, Point3{} + draw.vector(1.5));
    const QuadraticTriangle part = below(set, feet),
                            expected = restricted(one[0], {feet[0].at, feet[1].at, feet[2].at});
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT(distance(part.corners[k], expected.corners[k]), 1e-14);
      EXPECT_LT(distance(part.middles[k], expected.middles[k]), 1e-14);
    }
  }
}

// Unmarked pieces are farther away than the reach; pieces that cannot meet are apart.
TEST(feet, marks_all_that_is_near_and_denies_no_contact) {
  Draw draw(5);
  int denied = 0, pairs = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<QuadraticTriangle> quadratics(1 + draw.below(30));
    for (QuadraticTriangle& q : quadratics) q = draw.quadratic();
    PieceSet set(quadratics);
    set.prepare(1);
    QuadraticTriangle part = draw.quadratic();
    const std::size_t chosen = draw.below(quadratics.size());
    if (trial % 2 == 0) {
      // Where two points meet, up to both errors.
      const Vector3 between =
          point_of(quadratics[chosen], draw.parameter()) - point_of(part, draw.parameter());
      const Vector3 gap = (quadratics[chosen].error + part.error) * 0.999 * normalized(draw.vector(1));
      for (std::size_t k = 0; k < 3; ++k) {
        part.corners[k] = part.corners[k] + between + gap;
        part.middles[k] = part.middles[k] + between + gap;
      }
      EXPECT_TRUE(may_meet(set, part));
    } else {
      ++pairs;
      denied += !may_meet(set, part);
    }
    const double reach = 0.3 * draw.unit();
    std::vector<std::uint8_t> marks(quadratics.size());
    mark_near(set, part, reach, marks);
    for (std::size_t i = 0; i < quadratics.size(); ++i) {
      if (marks[i] != 0) continue;
      for (int s = 0; s < 50; ++s) {
        const double apart =
            distance(point_of(quadratics[i], draw.parameter()), point_of(part, draw.parameter()));
        EXPECT_GT(apart + quadratics[i].error + part.error, reach);
      }
    }
  }
  EXPECT_GT(denied, pairs / 4);
}

}  // namespace
}  // namespace snug::feet_test
