#include <snug/io/weld.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "io_testing.h"

namespace snug {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// The rule as it is written, in quadratic time.
Numbers slow_first_of_welded(const std::vector<Point3>& points, double distance) {
  Numbers first(points.size());
  std::iota(first.begin(), first.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < points.size(); ++j) {
        const Vector3 between = points[i] - points[j];
        const bool near = points[i] == points[j] || std::hypot(between.x, between.y, between.z) <= distance;
        if (near && first[i] < first[j]) {
          first[j] = first[i];
          changed = true;
        }
      }
    }
  }
  return first;
}

TEST(weld, equal_points_become_the_first_of_them) {
  EXPECT_EQ(first_of_welded(
                std::vector<Point3>{{1, 2, 3}, {1, 2, 4}, {1, 2, 3}, {0, 0, 0}, {-0.0, 0, -0.0}, {1, 2, 3}}),
            (Numbers{0, 1, 0, 3, 3, 0}));
  EXPECT_EQ(first_of_welded({}), Numbers{});
}

TEST(weld, no_distance_welds_nothing_that_differs) {
  EXPECT_EQ(first_of_welded(
                std::vector<Point3>{{0, 0, 0}, {5e-324, 0, 0}, {1, 0, 0}, {std::nextafter(1, 2), 0, 0}}),
            (Numbers{0, 1, 2, 3}));
}

TEST(weld, chains_of_near_points_become_one) {
  EXPECT_EQ(first_of_welded(std::vector<Point3>{{9, 0, 0}, {0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {3.5, 0, 0}}, 1),
            (Numbers{0, 1, 1, 1, 4}));
}

TEST(weld, the_distance_itself_still_welds) {
  EXPECT_EQ(first_of_welded(std::vector<Point3>{{0, 0, 0}, {3, 4, 0}}, 5), (Numbers{0, 0}));
  EXPECT_EQ(first_of_welded(std::vector<Point3>{{0, 0, 0}, {3, 4, 0}}, std::nextafter(5, 0)),
            (Numbers{0, 1}));
}

TEST(weld, cells_are_neither_too_large_nor_too_small) {
  // The far corners of a cube whose diagonal is longer than the distance; then pairs that lie just within it.
  EXPECT_EQ(first_of_welded(std::vector<Point3>{{0, 0, 0}, {0.59, 0.59, 0.59}}, 1), (Numbers{0, 1}));
  for (int i = 0; i < 1000; ++i) {
    const double x = 1e-3 * i;
    EXPECT_EQ(first_of_welded(std::vector<Point3>{{x, 0, 0}, {x + 0.999, 0, 0}}, 1), (Numbers{0, 0})) << x;
  }
}

TEST(weld, agrees_with_the_rule_on_random_and_on_aligned_points) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<Point3> points(60);
    const bool aligned = trial % 2 == 0;
    const int cells = 2 + trial % 11;
    for (Point3& point : points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = std::uniform_real_distribution<double>(-cells, cells)(random);
        point[axis] = aligned ? std::round(x) : x;
      }
    }
    for (const double distance : {0.5, 1.0, 1.5}) {
      ASSERT_EQ(first_of_welded(points, distance), slow_first_of_welded(points, distance)) << trial;
    }
  }
}

TEST(weld, distances_beneath_the_grid_of_coordinates_are_refused) {
  for (const double distance : {1e-9, 5e-324}) {
    try {
      static_cast<void>(first_of_welded(std::vector<Point3>{{1e6, 0, 0}, {0, 0, 0}}, distance));
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_EQ(error.problem(), InputProblem::refused);
    }
  }
  EXPECT_EQ(first_of_welded(std::vector<Point3>{{1e308, 0, 0}, {-1e308, 0, 0}}, 1e308), (Numbers{0, 1}));
}

}  // namespace
}  // namespace snug
