#include <snug/bvh/box_tree.h>

#include <gtest/gtest.h>
#include <oracle/quad.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <random>

namespace snug::box_tree_test {
namespace {

constexpr double inf = INFINITY;
constexpr Box3 everywhere{{-inf, -inf, -inf}, {inf, inf, inf}};

Box3 box_at(const Point3& lower, double x, double y, double z) {
  return {lower, {lower.x + x, lower.y + y, lower.z + z}};
}

// Boxes of all sizes, on a lattice so that many touch, some far away, flat or infinite.
std::vector<Box3> mixed_boxes(std::mt19937_64& random, std::size_t count) {
  const double sizes[] = {0, 1e-9, 0.5, 1, 7, 1e6};
  const double spreads[] = {0, 4, 1e3, 1e12, 1e300};
  std::vector<Box3> boxes;
  while (boxes.size() < count) {
    if (random() % 97 == 0) {
      boxes.push_back(everywhere);
      continue;
    }
    const double spread = spreads[random() % 5];
    const auto lattice = [&] { return spread * (static_cast<double>(random() % 17) - 8) / 8; };
    const auto size = [&] { return sizes[random() % 6]; };
    boxes.push_back(box_at({lattice(), lattice(), lattice()}, size(), size(), size()));
  }
  return boxes;
}

TEST(box_tree, finds_what_a_look_at_every_box_finds) {
  std::mt19937_64 random(71);
  for (const std::size_t count : {1u, 2u, 4u, 5u, 33u, 500u}) {
    const std::vector<Box3> boxes = mixed_boxes(random, count);
    const BoxTree tree(boxes);
    for (const double reach : {0.0, 0.5, 3.0, 1e7}) {
      for (std::uint32_t i = 0; i < count; ++i) {
        std::vector<std::uint32_t> found, expected;
        tree.find_near(boxes[i], reach, i, [&](std::uint32_t k) { found.push_back(k); });
        for (std::uint32_t k = i + 1; k < count; ++k) {
          if (!certainly_apart(boxes[i], boxes[k], reach)) expected.push_back(k);
        }
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected) << count << " boxes, reach " << reach << ", box " << i;
      }
    }
  }
}

TEST(box_tree, holds_a_thousand_equal_boxes_and_none) {
  const std::vector<Box3> boxes(1000, box_at({1, 2, 3}, 1, 1, 1));
  const BoxTree tree(boxes), empty(std::span<const Box3>{});
  std::size_t found = 0;
  tree.find_near(boxes[0], 0, 0, [&](std::uint32_t) { ++found; });
  EXPECT_EQ(found, 999u);
  EXPECT_LT(tree.bytes(), 1000 * 120u);
  empty.find_near(boxes[0], 0, 0, [&](std::uint32_t) { FAIL(); });
}

TEST(box_tree, touching_boxes_are_not_apart_and_the_next_double_is) {
  const Box3 a = box_at({0, 0, 0}, 1, 1, 1);
  for (const double reach : {0.0, 0.1, 1e-300, 3.0}) {
    Box3 b = box_at({1 + reach, 0, 0}, 1, 1, 1);
    if (b.lower.x - 1 <= reach) {
      EXPECT_FALSE(certainly_apart(a, b, reach)) << reach;
    }
    b.lower.x = std::nextafter(1 + 2 * reach, inf);
    EXPECT_TRUE(certainly_apart(a, b, reach)) << reach;
    EXPECT_TRUE(certainly_apart(b, a, reach)) << reach;
  }
  EXPECT_FALSE(certainly_apart(a, everywhere, 0));
  EXPECT_FALSE(certainly_apart(everywhere, everywhere, 0));
}

// Squares in 113 bits; differences of these doubles are exact there.
TEST(box_gaps, are_lower_bounds_and_near_the_distance) {
  std::mt19937_64 random(72);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 200'000; ++trial) {
    const double size = std::ldexp(1, static_cast<int>(random() % 20) - 10);
    const auto place = [&] { return random() % 4 == 0 ? 0 : size * unit(random); };
    const Box3 a = box_at({place(), place(), place()}, 0.1, size * 0.1, 0.1 * std::fabs(place()));
    const Box3 b = box_at({place(), place(), place()}, 0.1, size * 0.2, 0.1 * std::fabs(place()));
    oracle::Quad exact_sq = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const oracle::Quad right = static_cast<oracle::Quad>(b.lower[axis]) - a.upper[axis];
      const oracle::Quad left = static_cast<oracle::Quad>(a.lower[axis]) - b.upper[axis];
      const oracle::Quad gap = right > left ? right : left;
      if (gap > 0) exact_sq += gap * gap;
    }
    const double gap = gap_of(a, b);
    ASSERT_LE(static_cast<oracle::Quad>(gap) * gap, exact_sq) << trial;
    ASSERT_GE(gap * (1 + 1e-14) + 1e-300, std::sqrt(static_cast<double>(exact_sq))) << trial;
    ASSERT_EQ(gap, gap_of(b, a));
  }
}

TEST(box_gaps, are_finite_wherever_boxes_are) {
  const Box3 far_left = box_at({-DBL_MAX, 0, 0}, 1, 1, 1), far_right = box_at({DBL_MAX / 2, 0, 0}, 1, 1, 1);
  EXPECT_GT(gap_of(far_left, far_right), DBL_MAX / 2);
  EXPECT_LE(gap_of(far_left, far_right), DBL_MAX);
  EXPECT_EQ(gap_of(far_left, everywhere), 0);
  EXPECT_EQ(gap_of(everywhere, everywhere), 0);
  const Box3 tiny = box_at({0, 0, 0}, 0, 0, 0), beside = box_at({DBL_TRUE_MIN, 0, 0}, 0, 0, 0);
  EXPECT_LE(gap_of(tiny, beside), DBL_TRUE_MIN);
}

}  // namespace
}  // namespace snug::box_tree_test
