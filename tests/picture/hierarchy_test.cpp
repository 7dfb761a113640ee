#include <picture/hierarchy.h>

#include <gtest/gtest.h>
#include <testing/counts.h>

#include <algorithm>
#include <random>

namespace snug::hierarchy_test {
namespace {

std::vector<std::uint32_t> found(const BeamHierarchy& hierarchy, const Beam& beam, double limit) {
  std::vector<std::uint32_t> ids;
  BeamHierarchy::Stack stack;
  hierarchy.search(beam, limit, stack, [&](std::uint32_t id) {
    ids.push_back(id);
    return limit;
  });
  std::sort(ids.begin(), ids.end());
  return ids;
}

TEST(hierarchy, finds_every_box_with_a_point_in_the_beam) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1), share(0, 1);
  std::vector<Box3> boxes;
  for (int i = 0; i < 500; ++i) {
    const Point3 p{unit(random), unit(random), 1.5 + unit(random)};
    Box3 box;
    box.add(p);
    // flat and pointlike boxes among them
    box.add(p + Vector3{0.1 * (i % 2), 0.1 * (i % 3), 0.1 * (i % 5)});
    boxes.push_back(box);
  }
  const BeamHierarchy hierarchy(boxes);
  for (int trial = 0; trial < static_cast<int>(testing::fewer(500)); ++trial) {
    SCOPED_TRACE(trial);
    const double x = unit(random), y = unit(random), limit = 3 * share(random);
    const Beam beam{x, x + 0.05, y, y + 0.05};
    const std::vector<std::uint32_t> ids = found(hierarchy, beam, limit);
    EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
    for (std::uint32_t id = 0; id < boxes.size(); ++id) {
      const Box3& b = boxes[id];
      bool inside = false;
      for (int k = 0; k < 50 && !inside; ++k) {
        const auto at = [&](double low, double high) {
          return k < 8 ? (share(random) < 0.5 ? low : high) : low + share(random) * (high - low);
        };
        const Point3 p{at(b.lower.x, b.upper.x), at(b.lower.y, b.upper.y), at(b.lower.z, b.upper.z)};
        inside = 0 < p.z && p.z <= limit && beam.x_low * p.z <= p.x && p.x <= beam.x_high * p.z &&
                 beam.y_low * p.z <= p.y && p.y <= beam.y_high * p.z;
      }
      EXPECT_TRUE(!inside || std::binary_search(ids.begin(), ids.end(), id)) << id;
    }
  }
}

TEST(hierarchy, separates_boxes_that_are_apart) {
  std::vector<Box3> boxes;
  for (int i = 0; i < 1000; ++i) boxes.push_back({{i / 1000.0, -0.01, 1}, {(i + 0.5) / 1000.0, 0.01, 1.01}});
  const BeamHierarchy hierarchy(boxes);
  EXPECT_LE(found(hierarchy, {0.5, 0.5001, 0, 0.0001}, 10).size(), 16U);
  EXPECT_TRUE(found(hierarchy, {0.5, 0.5001, 0.5, 0.5001}, 10).empty());
}

TEST(hierarchy, holds_many_boxes_at_one_place) {
  const std::vector<Box3> boxes(1000, Box3{{0, 0, 1}, {0, 0, 1}});
  EXPECT_EQ(found(BeamHierarchy(boxes), {-0.1, 0.1, -0.1, 0.1}, 10).size(), 1000U);
}

TEST(hierarchy, of_nothing_finds_nothing) {
  EXPECT_TRUE(found(BeamHierarchy(std::span<const Box3>{}), {-1, 1, -1, 1}, 10).empty());
}

}  // namespace
}  // namespace snug::hierarchy_test
