#include <snug/bvh/wide_node.h>

#include <gtest/gtest.h>
#include <testing/instruction_sets.h>
#include <testing/placed_points.h>

#include <optional>
#include <random>
#include <vector>

namespace snug {
namespace {

using testing::any_frame;
using testing::any_points;
using testing::distance_from_above;
using testing::Extended;
using testing::image;

// A box around some points.
Obb box_around(const std::vector<Point3>& points) {
  return fit_box(principal_axes(points), [&](const Vector3& direction) {
    Extent all;
    for (const Point3& p : points) {
      const double height = dot(direction, p - Point3{});
      all.add({height - 1e-15, height + 1e-15});
    }
    return all;
  });
}

TEST(wide_nodes, distance_never_exceeds_that_of_the_contents) {
  std::mt19937_64 random(23);
  int gaps = 0, total = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const double size = std::pow(10.0, -static_cast<double>(random() % 9));
    WideNodes nodes_a, nodes_b;
    std::vector<std::vector<Point3>> clouds;
    std::vector<Obb> sets;
    std::vector<std::uint32_t> names;
    const Point3 centre_a{0.3, -0.7, 1.1};
    for (std::uint32_t l = 0; l < 1 + static_cast<std::uint32_t>(trial) % 8; ++l) {
      clouds.push_back(any_points(random, centre_a + Vector3{0, size * l, 0}, size));
      sets.push_back(box_around(clouds.back()));
      names.push_back(l);
    }
    ASSERT_EQ(nodes_a.add(sets, names), 0u);
    const PlacedFrame frame_a = any_frame(random);
    PlacedFrame frame_b = any_frame(random);
    const std::vector<Point3> cloud_b = any_points(random, {-0.2, 0.4, 0.5}, size);
    // B next to A, so that gaps are as small as the sets.
    const Extended at_a = image(frame_a, centre_a), at_b = image(frame_b, cloud_b[0]);
    std::uniform_real_distribution<double> unit(-3 * size, 3 * size);
    for (std::size_t k = 0; k < 3; ++k) {
      frame_b.translation[k] += static_cast<double>(at_a[k] - at_b[k]) + unit(random);
    }
    const Obb set_b = box_around(cloud_b);
    nodes_b.add({&set_b, 1}, {names.data(), 1});
    const View view(frame_a, frame_b);
    ASSERT_TRUE(view.frame.comparable);
    const PlacedBox seen = nodes_b.placed({0, 0}, view);
    WideNodes::Distances gaps_found;
    nodes_a.distances(0, seen, view.frame.slack, random() % 2 ? INFINITY : 0, gaps_found);
    std::vector<Extended> images_b;
    for (const Point3& p : cloud_b) images_b.push_back(image(frame_b, p));
    for (std::size_t l = 0; l < sets.size(); ++l) {
      ++total;
      if (!(gaps_found[l] > 0)) continue;
      ++gaps;
      std::vector<Extended> images_a;
      for (const Point3& p : clouds[l]) images_a.push_back(image(frame_a, p));
      ASSERT_LE(static_cast<double>(gaps_found[l]) * view.frame.to_world,
                distance_from_above(images_a, images_b, random))
          << trial;
    }
  }
  EXPECT_GT(gaps, total / 4);
}

// Small beside the unit, squares and then the lengths themselves leave single precision.
TEST(wide_nodes, distance_of_a_point_holds_for_sets_of_any_size) {
  std::mt19937_64 random(24);
  std::uniform_real_distribution<double> unit(-3, 3);
  int gaps = 0;
  for (int exponent = 0; exponent < 160; ++exponent) {
    const double size = std::ldexp(1.0, -exponent);
    Obb set;
    set.half = {size, size, size / 2};
    WideNodes nodes;
    const std::uint32_t name = 0;
    nodes.add({&set, 1}, {&name, 1});
    for (int trial = 0; trial < 200; ++trial) {
      const Point3 p{size * unit(random), size * unit(random), size * unit(random)};
      WideNodes::Distances found;
      nodes.distances(0, p, 0, found);
      if (!(found[0] > 0)) continue;
      ++gaps;
      const Vector3 beyond{std::max(0.0, std::fabs(p.x) - size), std::max(0.0, std::fabs(p.y) - size),
                           std::max(0.0, std::fabs(p.z) - size / 2)};
      ASSERT_LE(static_cast<double>(found[0]), std::hypot(beyond.x, beyond.y, beyond.z)) << exponent;
    }
  }
  EXPECT_GT(gaps, 10'000);
}

TEST(wide_nodes, sets_around_infinite_ones_are_infinite) {
  std::mt19937_64 random(25);
  const Obb infinite = box_of(Obb{}.axes, {unbounded, unbounded, unbounded}),
            finite = box_around(any_points(random, {0.3, -0.7, 1.1}, 0.1));
  for (const auto& parts : {std::vector{infinite}, {infinite, finite}, {finite, infinite}}) {
    const Obb around = merge(parts);
    EXPECT_EQ(ball_around(around).radius, INFINITY);
    WideNodes nodes;
    const std::uint32_t name = 0;
    nodes.add({&around, 1}, {&name, 1});
    WideNodes::Distances found;
    nodes.distances(0, Point3{50, 60, -70}, 0, found);
    EXPECT_LE(found[0], 0);
  }
}

// Two nodes near each other as two frames place them.
struct TwoNodes {
  explicit TwoNodes(std::mt19937_64& random) : frames{any_frame(random), any_frame(random)} {
    const double size = std::pow(10.0, -static_cast<double>(random() % 9));
    std::uniform_real_distribution<double> unit(-4 * size, 4 * size);
    const std::array<Point3, 2> centres{{{0.3, -0.7, 1.1}, {-0.2, 0.4, 0.5}}};
    for (std::size_t s = 0; s < 2; ++s) {
      std::vector<Obb> sets;
      std::vector<std::uint32_t> names;
      for (std::uint32_t l = 0; l < 1 + random() % 8; ++l) {
        const Point3 centre = centres[s] + Vector3{unit(random), unit(random), unit(random)};
        clouds[s].push_back(any_points(random, centre, random() % 4 == 0 ? 0.1 * size : size));
        sets.push_back(box_around(clouds[s].back()));
        names.push_back(l);
      }
      nodes[s].add(sets, names);
    }
    const Extended at_a = image(frames[0], centres[0]), at_b = image(frames[1], centres[1]);
    for (std::size_t k = 0; k < 3; ++k) {
      frames[1].translation[k] += static_cast<double>(at_a[k] - at_b[k]) + unit(random);
    }
    view = View(frames[0], frames[1]);
    switch (random() % 3) {
      case 0:
        break;
      case 1:
        view.look_along({unit(random), unit(random), unit(random)});
        break;
      default: {
        // From one of A's points to one of B's, as A's frame sees them.
        view.look_along(view.frame.apply(clouds[1][0][0]) - clouds[0][0][0]);
      }
    }
    prune_distance = static_cast<float>(random() % 3 == 0 ? INFINITY : random() % 2 ? 0.0 : size);
  }

  std::array<WideNodes, 2> nodes;
  std::array<PlacedFrame, 2> frames;
  std::array<std::vector<std::vector<Point3>>, 2> clouds;
  View view;
  float prune_distance;
};

TEST(wide_nodes, distances_of_all_pairs_never_exceed_those_of_the_contents) {
  std::mt19937_64 random(27);
  std::size_t gaps = 0, dropped = 0, total = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const TwoNodes two(random);
    ASSERT_TRUE(two.view.frame.comparable);
    WideNodes::Pairs found;
    const float others = two.nodes[0].distances(0, two.nodes[1], 0, two.view, two.prune_distance, found);
    if (others < INFINITY) {
      EXPECT_GT(others, two.prune_distance);
    }
    std::array<std::array<float, 8>, 8> gap;
    for (auto& row : gap) row.fill(others);
    for (std::size_t k = 0; k < found.count; ++k) {
      const kernels::ChildPair& pair = found.pairs[k];
      EXPECT_EQ(gap[pair.own][pair.other], others) << "a pair twice";
      gap[pair.own][pair.other] = pair.gap;
      EXPECT_LE(pair.gap, two.prune_distance);
    }
    dropped += two.nodes[0].count(0) * two.nodes[1].count(0) - found.count;
    std::array<std::vector<std::vector<Extended>>, 2> images;
    for (std::size_t s = 0; s < 2; ++s) {
      for (const auto& cloud : two.clouds[s]) {
        auto& out = images[s].emplace_back();
        for (const Point3& p : cloud) out.push_back(image(two.frames[s], p));
      }
    }
    for (std::size_t i = 0; i < images[0].size(); ++i) {
      for (std::size_t j = 0; j < images[1].size(); ++j) {
        ++total;
        if (!(gap[i][j] > 0)) continue;
        ++gaps;
        ASSERT_LE(static_cast<double>(gap[i][j]) * two.view.frame.to_world,
                  distance_from_above(images[0][i], images[1][j], random))
            << trial << ": " << i << ' ' << j;
      }
    }
  }
  EXPECT_GT(gaps, total / 3);
  EXPECT_GT(dropped, total / 8);
}

TEST(wide_nodes, distances_are_the_same_on_every_instruction_set) {
  std::mt19937_64 random(28);
  const testing::EachInstructionSet sets;
  for (int trial = 0; trial < 300; ++trial) {
    const TwoNodes two(random);
    const PlacedBox seen = two.nodes[1].placed({0, 0}, two.view);
    std::optional<std::vector<float>> first;
    sets.run([&](const char* name) {
      WideNodes::Pairs pairs;
      WideNodes::Distances one;
      std::vector<float> all{two.nodes[0].distances(0, two.nodes[1], 0, two.view, two.prune_distance, pairs)};
      for (std::size_t k = 0; k < pairs.count; ++k) {
        const kernels::ChildPair& pair = pairs.pairs[k];
        all.insert(all.end(), {static_cast<float>(pair.own), static_cast<float>(pair.other), pair.gap});
      }
      const WideNodes::Near near =
          two.nodes[0].distances(0, seen, two.view.frame.slack, two.prune_distance, one);
      all.push_back(near.others);
      all.push_back(static_cast<float>(near.places));
      for (std::size_t l = 0; l < two.nodes[0].count(0); ++l) all.push_back(one[l]);
      if (!first) first = all;
      EXPECT_EQ(all, *first) << name << ' ' << trial;
    });
  }
}

TEST(wide_nodes, distance_to_a_point_never_exceeds_that_of_the_contents) {
  std::mt19937_64 random(24);
  int gaps = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double size = std::pow(10.0, -static_cast<double>(random() % 7));
    const std::vector<Point3> cloud = any_points(random, {0.4, 0.1, -1}, size);
    const Obb set = box_around(cloud);
    const std::uint32_t name = 7;
    WideNodes nodes;
    nodes.add({&set, 1}, {&name, 1});
    std::uniform_real_distribution<double> unit(-2 * size, 2 * size);
    const Point3 p = cloud[0] + Vector3{unit(random), unit(random), unit(random)};
    WideNodes::Distances found;
    nodes.distances(0, p, 0, found);
    std::vector<Extended> points;
    for (const Point3& q : cloud) points.push_back(testing::extended(q));
    gaps += found[0] > 0;
    ASSERT_LE(found[0], distance_from_above(points, {testing::extended(p)}, random)) << trial;
  }
  EXPECT_GT(gaps, 1000);
}

TEST(wide_nodes, boxes_side_by_side_are_as_far_as_they_are) {
  const auto cube = [](double x) {
    std::vector<Point3> corners;
    for (int i = 0; i < 8; ++i) {
      corners.push_back({x + (i & 1), static_cast<double>(i >> 1 & 1), static_cast<double>(i >> 2)});
    }
    return box_around(corners);
  };
  const Obb a = cube(0), b = cube(3);
  const std::uint32_t name = 0;
  WideNodes one, two;
  one.add({&a, 1}, {&name, 1});
  two.add({&b, 1}, {&name, 1});
  PlacedFrame here;
  here.rows = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const View view(here, here);
  const PlacedBox seen = two.placed({0, 0}, view);
  WideNodes::Distances found;
  one.distances(0, seen, view.frame.slack, INFINITY, found);
  EXPECT_NEAR(found[0], 2, 1.3);  // a cube has no principal axes
  EXPECT_LE(found[0], 2);
}

TEST(wide_nodes, what_is_not_finite_is_apart_from_nothing) {
  for (const double bad : std::array<double, 3>{INFINITY, NAN, 1e300}) {
    const Extent far{-1, bad};
    const Obb a = box_of(Obb{}.axes, {far, far, far}), b = box_around({{9, 9, 9}});
    const std::uint32_t name = 0;
    WideNodes one, two;
    one.add({&a, 1}, {&name, 1});
    two.add({&b, 1}, {&name, 1});
    PlacedFrame here;
    here.rows = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const View view(here, here);
    WideNodes::Distances found;
    PlacedBox seen = two.placed({0, 0}, view);
    one.distances(0, seen, view.frame.slack, INFINITY, found);
    EXPECT_FALSE(found[0] > 0) << bad;
    seen = one.placed({0, 0}, view);
    two.distances(0, seen, view.frame.slack, INFINITY, found);
    EXPECT_FALSE(found[0] > 0) << bad;
  }
}

TEST(wide_nodes, merging_keeps_the_contents) {
  std::mt19937_64 random(25);
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<Obb> parts;
    std::vector<Point3> points;
    for (int i = 0; i < 5; ++i) {
      const auto cloud = any_points(random, {0.1 * i, 1 - 0.3 * i, 0.5}, 0.2);
      points.insert(points.end(), cloud.begin(), cloud.end());
      parts.push_back(box_around(cloud));
    }
    const Obb all = merge(parts);
    const Ball ball = ball_around(all);
    for (const Point3& p : points) {
      EXPECT_LE(distance(p, ball.centre), ball.radius);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE(std::fabs(dot(all.axes[k], p - all.centre)), all.half[k]);
      }
    }
  }
}

}  // namespace
}  // namespace snug
