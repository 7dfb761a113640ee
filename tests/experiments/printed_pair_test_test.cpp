#include <experiments/printed_pair_test.h>

#include <gtest/gtest.h>
#include <snug/geometry/triangle_distance.h>
#include <testing/containment.h>

#include <optional>
#include <random>
#include <vector>

namespace snug::printed_pair_test_test {
namespace {

using testing::Extended;
using testing::inner;
using testing::minus;

// The point of least norm in the flat through one to three points, if it lies in their simplex.
std::optional<Extended> min_in_flat(const std::vector<Extended>& points) {
  // Least |p0 + s e1 + t e2|: the normal equations, by Cramer's rule.
  const Extended& p = points[0];
  if (points.size() == 1) return p;
  const Extended e1 = minus(points[1], p);
  const long double g11 = inner(e1, e1), r1 = -inner(p, e1);
  long double s = 0, t = 0;
  Extended e2{};
  if (points.size() == 2) {
    if (!(g11 > 0)) return {};
    s = r1 / g11;
  } else {
    e2 = minus(points[2], p);
    const long double g12 = inner(e1, e2), g22 = inner(e2, e2), r2 = -inner(p, e2),
                      det = g11 * g22 - g12 * g12;
    if (!(det > 0)) return {};
    s = (r1 * g22 - r2 * g12) / det;
    t = (g11 * r2 - g12 * r1) / det;
  }
  if (s < 0 || t < 0 || s + t > 1) return {};
  Extended least;
  for (std::size_t k = 0; k < 3; ++k) least[k] = p[k] + s * e1[k] + t * e2[k];
  return least;
}

struct BruteDistance {
  long double lower, upper;
};

// Distance of two disjoint triangles as that of the origin to the hull of the nine differences of their
// corners: its nearest point lies in a corner, on a segment or in a triangle of them, so all are tried. The
// plane across the best one found bounds the distance from below.
BruteDistance brute_distance(const Triangle& a, const Triangle& b) {
  std::vector<Extended> hull;
  for (const Point3& p : a) {
    for (const Point3& q : b) hull.push_back(minus(testing::extended(q), testing::extended(p)));
  }
  BruteDistance result{0, INFINITY};
  Extended best{};
  const auto attempt = [&](const std::vector<Extended>& points) {
    const std::optional<Extended> least = min_in_flat(points);
    if (!least) return;
    const long double size = std::sqrt(inner(*least, *least));
    if (size < result.upper) {
      result.upper = size;
      best = *least;
    }
  };
  for (std::size_t i = 0; i < hull.size(); ++i) {
    attempt({hull[i]});
    for (std::size_t j = 0; j < i; ++j) {
      attempt({hull[i], hull[j]});
      for (std::size_t k = 0; k < j; ++k) attempt({hull[i], hull[j], hull[k]});
    }
  }
  long double support = INFINITY;
  for (const Extended& p : hull) support = std::min(support, inner(p, best) / result.upper);
  result.lower = std::max(0.0L, support);
  return result;
}

// Loss of the certified distance: nearest points with an error of a few units in the last place give a
// direction with that error over the distance, and the support of triangles of size 1 is off by as much.
double slack_at(long double distance) { return static_cast<double>(1e-14L / distance); }

// The pairs of docs/derivations/leaf_rule.md have radii of 1/16.
OffsetTriangle beside(const Triangle& base) { return {base, 1.0 / 16, 0}; }

TEST(printed_pair_test, calls_overlapping_offset_triangles_separated_in_one_plane) {
  const OffsetTriangle a = beside({Point3{0, -1, 0}, {0, 1, 0}, {1, 0, 0}});
  const OffsetTriangle b = beside({Point3{-1.0 / 64, -1, 0}, {-1.0 / 64, 1, 0}, {-1, 0, 0}});
  EXPECT_NEAR(nearest(a.base, b.base).certain_distance, 1.0 / 64, 1e-14);
  EXPECT_EQ(brute_distance(a.base, b.base).lower, 1.0L / 64);
  EXPECT_EQ(brute_distance(a.base, b.base).upper, 1.0L / 64);
  EXPECT_TRUE(printed_test_says_separated(a, b, 1.0 / 16));
  EXPECT_FALSE(certainly_separated(a, b, 0));
}

TEST(printed_pair_test, calls_overlapping_offset_triangles_separated_across_a_gap) {
  const OffsetTriangle a = beside({Point3{0, -1, 0}, {0, 1, 0}, {1, 0, 0}});
  const OffsetTriangle b = beside({Point3{-1.0 / 64, 0, -1}, {-1.0 / 64, 0, 1}, {-1, 0, 0}});
  EXPECT_NEAR(nearest(a.base, b.base).certain_distance, 1.0 / 64, 1e-14);
  EXPECT_EQ(brute_distance(a.base, b.base).lower, 1.0L / 64);
  EXPECT_EQ(brute_distance(a.base, b.base).upper, 1.0L / 64);
  EXPECT_TRUE(printed_test_says_separated(a, b, 1.0 / 16));
  EXPECT_FALSE(certainly_separated(a, b, 0));
}

// With no radius and hardly an epsilon it is Moeller's test, and right: what fails is epsilon's new meaning.
TEST(printed_pair_test, is_right_about_triangles_without_a_radius) {
  std::mt19937_64 random(41);
  for (const PairFamily family : all_pair_families) {
    for (int trial = 0; trial < 2000; ++trial) {
      NearPair pair = near_pair(family, random);
      const NearestTriangles near = nearest(pair.a.base, pair.b.base);
      pair.a.radius = pair.b.radius = 0;
      if (near.certain_distance > 1e-6) {
        EXPECT_TRUE(printed_test_says_separated(pair.a, pair.b, 1e-12)) << name_of(family) << trial;
      }
      // The centre of one on a point well inside of the other: they meet.
      const auto centre = [](const Triangle& t) {
        return t[0] + (1.0 / 3) * ((t[1] - t[0]) + (t[2] - t[0]));
      };
      const Vector3 by = centre(pair.a.base) - centre(pair.b.base);
      for (Point3& p : pair.b.base) p = p + by;
      EXPECT_FALSE(printed_test_says_separated(pair.a, pair.b, 1e-12)) << name_of(family) << trial;
      EXPECT_FALSE(printed_test_says_separated(pair.b, pair.a, 1e-12)) << name_of(family) << trial;
    }
  }
}

TEST(printed_pair_test, near_pairs_are_as_near_as_they_say) {
  std::mt19937_64 random(42);
  for (const PairFamily family : all_pair_families) {
    for (int trial = 0; trial < 2000; ++trial) {
      const NearPair pair = near_pair(family, random);
      const BruteDistance truth = brute_distance(pair.a.base, pair.b.base);
      ASSERT_GT(truth.lower, 0) << name_of(family) << trial;
      ASSERT_LE(truth.upper, pair.tolerance()) << name_of(family) << trial;
      ASSERT_LE(truth.upper - truth.lower, 1e-12L) << name_of(family) << trial;
      const NearestTriangles near = nearest(pair.a.base, pair.b.base);
      ASSERT_GT(near.certain_distance, 0);
      ASSERT_LE(near.certain_distance, truth.upper);
      ASSERT_GE(near.certain_distance, truth.lower - slack_at(truth.upper));
      ASSERT_LT(pair.a.radius, 0.5 * pair.epsilon);
      ASSERT_LT(pair.b.radius, 0.5 * pair.epsilon);
    }
  }
}

TEST(printed_pair_test, misses_many_near_pairs_of_every_family_and_rule_a_none) {
  std::mt19937_64 random(43);
  for (const PairFamily family : all_pair_families) {
    constexpr int pairs = 2000;
    int missed = 0;
    for (int trial = 0; trial < pairs; ++trial) {
      const NearPair pair = near_pair(family, random);
      missed += printed_test_says_separated(pair.a, pair.b, pair.epsilon);
      ASSERT_FALSE(certainly_separated(pair.a, pair.b, pair.epsilon)) << name_of(family) << trial;
    }
    EXPECT_GT(missed, pairs / 5) << name_of(family);
    EXPECT_LT(missed, pairs) << name_of(family);
  }
}

// Rule (a) is right above without being shy: a hair less tolerance and it separates the same pairs.
TEST(printed_pair_test, rule_a_separates_what_is_a_hair_farther_apart) {
  std::mt19937_64 random(44);
  for (const PairFamily family : all_pair_families) {
    for (int trial = 0; trial < 2000; ++trial) {
      NearPair pair = near_pair(family, random);
      const auto truth = static_cast<double>(brute_distance(pair.a.base, pair.b.base).upper);
      pair.a.radius = 0.25 * truth;
      pair.b.radius = 0.5 * truth;
      EXPECT_TRUE(certainly_separated(pair.a, pair.b, 0.25 * truth - slack_at(truth)))
          << name_of(family) << trial;
      EXPECT_FALSE(certainly_separated(pair.a, pair.b, 0.25 * truth)) << name_of(family) << trial;
    }
  }
}

// Corners exactly on the other plane: whichever they are, the triangle cuts the common line from -1 to 1.
TEST(printed_pair_test, finds_the_interval_of_triangles_with_corners_on_the_plane) {
  const OffsetTriangle a{{Point3{0, -1, 0}, {0, 1, 0}, {1, 0, 0}}, 0, 0};
  for (const Triangle& cut : {Triangle{Point3{-1, 0, 0}, {3, 0, -1}, {-1, 0, 1}},
                              Triangle{Point3{-1, 0, 0}, {1, 0, 0}, {0, 0, 1}}}) {
    for (std::size_t first = 0; first < 3; ++first) {
      const OffsetTriangle b{{cut[first], cut[(first + 1) % 3], cut[(first + 2) % 3]}, 0, 0};
      EXPECT_FALSE(printed_test_says_separated(a, b, 1e-12)) << first;
      EXPECT_FALSE(printed_test_says_separated(b, a, 1e-12)) << first;
      const Vector3 beyond{2.125, 0, 0};
      const OffsetTriangle apart{{b.base[0] + beyond, b.base[1] + beyond, b.base[2] + beyond}, 0, 0};
      EXPECT_TRUE(printed_test_says_separated(a, apart, 1e-12)) << first;
      EXPECT_TRUE(printed_test_says_separated(apart, a, 1e-12)) << first;
    }
  }
}

// A plane farther from a triangle than the tolerance does separate: the first step of the test is sound.
TEST(printed_pair_test, is_right_about_the_side_of_a_plane) {
  const OffsetTriangle a = beside({Point3{0, -1, 0}, {0, 1, 0}, {1, 0, 0}});
  const Triangle above{Point3{0, 0, 0.25}, {1, 0, 0.5}, {0, 1, 0.25}};
  EXPECT_TRUE(printed_test_says_separated(a, beside(above), 1.0 / 16));
  EXPECT_FALSE(printed_test_says_separated(a, beside(above), 3.0 / 16));
}

}  // namespace
}  // namespace snug::printed_pair_test_test
