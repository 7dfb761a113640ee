#include <snug/bvh/blocks.h>

#include <gtest/gtest.h>
#include <testing/containment.h>
#include <testing/instruction_sets.h>

#include <optional>
#include <random>
#include <vector>

namespace snug {
namespace {

using testing::Extended;

// The hull of some points.
class Cloud final : public Enclosed {
 public:
  explicit Cloud(std::vector<Point3> points) : points_(std::move(points)) {}
  [[nodiscard]] Extent extent(const Vector3& direction) const override {
    Extent all{INFINITY, -INFINITY};
    for (const Point3& p : points_) {
      const double height = dot(direction, p - Point3{});
      all.lower = std::min(all.lower, height - 1e-15);
      all.upper = std::max(all.upper, height + 1e-15);
    }
    return all;
  }
  [[nodiscard]] std::span<const Point3> points() const override { return points_; }

 private:
  std::vector<Point3> points_;
};

std::vector<Point3> any_points(std::mt19937_64& random, const Point3& centre, double size) {
  std::uniform_real_distribution<double> unit(-size, size);
  const double flat = random() % 3 == 0 ? 1e-6 : 0.1;
  std::vector<Point3> points;
  for (std::size_t i = 0; i < 1 + random() % 6; ++i) {
    points.push_back(centre + Vector3{unit(random), 0.4 * unit(random), flat * unit(random)});
  }
  return points;
}

PlacedFrame any_frame(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  // Gram-Schmidt in doubles: rigid to a few roundings.
  Vector3 a{normal(random), normal(random), normal(random)},
      b{normal(random), normal(random), normal(random)};
  a = (1 / length(a)) * a;
  b = b - dot(a, b) * a;
  b = (1 / length(b)) * b;
  PlacedFrame frame;
  frame.rows = {a, b, cross(a, b)};
  frame.scale = random() % 2 ? 1.0 : 0.25;
  frame.translation = {normal(random), normal(random), normal(random)};
  frame.defect = 1e-15;
  if (random() % 4 == 0) {  // as far from rigid as is allowed
    frame.rows[0] = (1 + 4e-10) * frame.rows[0];
    frame.rows[1] = frame.rows[1] + 3e-10 * frame.rows[2];
    frame.defect = 1e-9;
  }
  return frame;
}

Extended image(const PlacedFrame& frame, const Point3& p) {
  Extended q;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3& row = frame.rows[k];
    q[k] = static_cast<long double>(frame.scale) *
               (static_cast<long double>(p.x) * row.x + static_cast<long double>(p.y) * row.y +
                static_cast<long double>(p.z) * row.z) +
           frame.translation[k];
  }
  return q;
}

// Distance of two hulls from above: a few steps from the nearest pair of points towards combinations of others.
long double distance_from_above(const std::vector<Extended>& a, const std::vector<Extended>& b,
                                std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  long double best = INFINITY;
  const auto mix = [&](const std::vector<Extended>& points) {
    Extended p{};
    long double sum = 0;
    std::vector<long double> weights;
    for (std::size_t i = 0; i < points.size(); ++i) {
      weights.push_back(random() % 2 ? 0.0L : static_cast<long double>(unit(random)));
      sum += weights.back();
    }
    if (sum == 0) return points[random() % points.size()];
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) p[k] += weights[i] / sum * points[i][k];
    }
    return p;
  };
  for (int trial = 0; trial < 60; ++trial) {
    const Extended d = testing::minus(mix(a), mix(b));
    best = std::min(best, std::sqrt(testing::inner(d, d)));
  }
  return best;
}

class EachVolume : public ::testing::TestWithParam<Volume> {};

TEST_P(EachVolume, distance_never_exceeds_that_of_the_contents) {
  const Volume volume = GetParam();
  std::mt19937_64 random(23);
  int gaps = 0, total = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const double size = std::pow(10.0, -static_cast<double>(random() % 9));
    Blocks blocks_a(volume), blocks_b(volume);
    std::vector<std::vector<Point3>> clouds;
    std::vector<BoundingVolume> sets;
    std::vector<std::uint32_t> names;
    const Point3 centre_a{0.3, -0.7, 1.1};
    for (std::uint32_t l = 0; l < 1 + static_cast<std::uint32_t>(trial) % 8; ++l) {
      clouds.push_back(any_points(random, centre_a + Vector3{0, size * l, 0}, size));
      sets.push_back(fit(volume, Cloud(clouds.back())));
      names.push_back(l);
    }
    ASSERT_EQ(blocks_a.add(sets, names), 0u);
    const PlacedFrame frame_a = any_frame(random);
    PlacedFrame frame_b = any_frame(random);
    const std::vector<Point3> cloud_b = any_points(random, {-0.2, 0.4, 0.5}, size);
    // B next to A, so that gaps are as small as the sets.
    const Extended at_a = image(frame_a, centre_a), at_b = image(frame_b, cloud_b[0]);
    std::uniform_real_distribution<double> unit(-3 * size, 3 * size);
    for (std::size_t k = 0; k < 3; ++k) {
      frame_b.translation[k] += static_cast<double>(at_a[k] - at_b[k]) + unit(random);
    }
    const BoundingVolume set_b = fit(volume, Cloud(cloud_b));
    blocks_b.add({&set_b, 1}, {names.data(), 1});
    const View view(volume, frame_a, frame_b);
    ASSERT_TRUE(view.frame.comparable);
    PlacedVolume seen;
    blocks_b.placed({0, 0}, view, seen);
    Blocks::Distances gaps_found;
    blocks_a.distances(0, seen, view.frame.slack, random() % 2 ? INFINITY : 0, gaps_found);
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
TEST_P(EachVolume, distance_of_a_point_holds_for_sets_of_any_size) {
  const Volume volume = GetParam();
  std::mt19937_64 random(24);
  std::uniform_real_distribution<double> unit(-3, 3);
  int gaps = 0;
  for (int exponent = 0; exponent < 160; ++exponent) {
    const double size = std::ldexp(1.0, -exponent);
    BoundingVolume set;
    set.box.half = {size, size, size / 2};
    const auto directions = directions_of(volume);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const Vector3& d = all_directions[directions[i]];
      set.upper[i] = size * (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z) / 2);
      set.lower[i] = -set.upper[i];
    }
    Blocks blocks(volume);
    const std::uint32_t name = 0;
    blocks.add({&set, 1}, {&name, 1});
    for (int trial = 0; trial < 200; ++trial) {
      const Point3 p{size * unit(random), size * unit(random), size * unit(random)};
      Blocks::Distances found;
      blocks.distances(0, p, 0, found);
      if (!(found[0] > 0)) continue;
      ++gaps;
      const Vector3 beyond{std::max(0.0, std::fabs(p.x) - size), std::max(0.0, std::fabs(p.y) - size),
                           std::max(0.0, std::fabs(p.z) - size / 2)};
      ASSERT_LE(static_cast<double>(found[0]), std::hypot(beyond.x, beyond.y, beyond.z)) << exponent;
    }
  }
  EXPECT_GT(gaps, 10'000);
}

TEST_P(EachVolume, sets_around_infinite_ones_are_infinite) {
  class Endless final : public Enclosed {
   public:
    [[nodiscard]] Extent extent(const Vector3&) const override { return {-INFINITY, INFINITY}; }
    [[nodiscard]] std::span<const Point3> points() const override { return {}; }
  };
  const Volume volume = GetParam();
  std::mt19937_64 random(25);
  const BoundingVolume infinite = fit(volume, Endless()),
                       finite = fit(volume, Cloud(any_points(random, {0.3, -0.7, 1.1}, 0.1)));
  for (const auto& parts : {std::vector{infinite}, {infinite, finite}, {finite, infinite}}) {
    const BoundingVolume around = merge(volume, parts);
    EXPECT_EQ(ball_around(volume, around).radius, INFINITY);
    Blocks blocks(volume);
    const std::uint32_t name = 0;
    blocks.add({&around, 1}, {&name, 1});
    Blocks::Distances found;
    blocks.distances(0, Point3{50, 60, -70}, 0, found);
    EXPECT_LE(found[0], 0);
  }
}

// Two blocks near each other as two frames place them.
struct TwoBlocks {
  TwoBlocks(Volume volume, std::mt19937_64& random)
      : blocks{Blocks(volume), Blocks(volume)}, frames{any_frame(random), any_frame(random)} {
    const double size = std::pow(10.0, -static_cast<double>(random() % 9));
    std::uniform_real_distribution<double> unit(-4 * size, 4 * size);
    const std::array<Point3, 2> centres{{{0.3, -0.7, 1.1}, {-0.2, 0.4, 0.5}}};
    for (std::size_t s = 0; s < 2; ++s) {
      std::vector<BoundingVolume> sets;
      std::vector<std::uint32_t> names;
      for (std::uint32_t l = 0; l < 1 + random() % 8; ++l) {
        const Point3 centre = centres[s] + Vector3{unit(random), unit(random), unit(random)};
        clouds[s].push_back(any_points(random, centre, random() % 4 == 0 ? 0.1 * size : size));
        sets.push_back(fit(volume, Cloud(clouds[s].back())));
        names.push_back(l);
      }
      blocks[s].add(sets, names);
    }
    const Extended at_a = image(frames[0], centres[0]), at_b = image(frames[1], centres[1]);
    for (std::size_t k = 0; k < 3; ++k) {
      frames[1].translation[k] += static_cast<double>(at_a[k] - at_b[k]) + unit(random);
    }
    view = View(volume, frames[0], frames[1]);
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
    enough = static_cast<float>(random() % 3 == 0 ? INFINITY : random() % 2 ? 0.0 : size);
  }

  std::array<Blocks, 2> blocks;
  std::array<PlacedFrame, 2> frames;
  std::array<std::vector<std::vector<Point3>>, 2> clouds;
  View view;
  float enough;
};

TEST_P(EachVolume, distances_of_all_pairs_never_exceed_those_of_the_contents) {
  std::mt19937_64 random(27);
  std::size_t gaps = 0, dropped = 0, total = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const TwoBlocks two(GetParam(), random);
    ASSERT_TRUE(two.view.frame.comparable);
    Blocks::Pairs found;
    const float others = two.blocks[0].distances(0, two.blocks[1], 0, two.view, two.enough, found);
    if (others < INFINITY) {
      EXPECT_GT(others, two.enough);
    }
    std::array<std::array<float, 8>, 8> gap;
    for (auto& row : gap) row.fill(others);
    for (std::size_t k = 0; k < found.count; ++k) {
      const kernels::LanePair& pair = found.pairs[k];
      EXPECT_EQ(gap[pair.own][pair.other], others) << "a pair twice";
      gap[pair.own][pair.other] = pair.gap;
      EXPECT_LE(pair.gap, two.enough);
    }
    dropped += two.blocks[0].count(0) * two.blocks[1].count(0) - found.count;
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

TEST_P(EachVolume, distances_are_the_same_on_every_instruction_set) {
  std::mt19937_64 random(28);
  const testing::EachInstructionSet sets;
  for (int trial = 0; trial < 300; ++trial) {
    const TwoBlocks two(GetParam(), random);
    PlacedVolume seen;
    two.blocks[1].placed({0, 0}, two.view, seen);
    std::optional<std::vector<float>> first;
    sets.run([&](const char* name) {
      Blocks::Pairs pairs;
      Blocks::Distances one;
      std::vector<float> all{two.blocks[0].distances(0, two.blocks[1], 0, two.view, two.enough, pairs)};
      for (std::size_t k = 0; k < pairs.count; ++k) {
        const kernels::LanePair& pair = pairs.pairs[k];
        all.insert(all.end(), {static_cast<float>(pair.own), static_cast<float>(pair.other), pair.gap});
      }
      const Blocks::Near near = two.blocks[0].distances(0, seen, two.view.frame.slack, two.enough, one);
      all.push_back(near.others);
      all.push_back(static_cast<float>(near.lanes));
      for (std::size_t l = 0; l < two.blocks[0].count(0); ++l) all.push_back(one[l]);
      if (!first) first = all;
      EXPECT_EQ(all, *first) << name << ' ' << trial;
    });
  }
}

TEST_P(EachVolume, distance_to_a_point_never_exceeds_that_of_the_contents) {
  const Volume volume = GetParam();
  std::mt19937_64 random(24);
  int gaps = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double size = std::pow(10.0, -static_cast<double>(random() % 7));
    const std::vector<Point3> cloud = any_points(random, {0.4, 0.1, -1}, size);
    const BoundingVolume set = fit(volume, Cloud(cloud));
    const std::uint32_t name = 7;
    Blocks blocks(volume);
    blocks.add({&set, 1}, {&name, 1});
    std::uniform_real_distribution<double> unit(-2 * size, 2 * size);
    const Point3 p = cloud[0] + Vector3{unit(random), unit(random), unit(random)};
    Blocks::Distances found;
    blocks.distances(0, p, 0, found);
    std::vector<Extended> points;
    for (const Point3& q : cloud) points.push_back(testing::extended(q));
    gaps += found[0] > 0;
    ASSERT_LE(found[0], distance_from_above(points, {testing::extended(p)}, random)) << trial;
  }
  EXPECT_GT(gaps, 1000);
}

TEST_P(EachVolume, boxes_side_by_side_are_as_far_as_they_are) {
  const Volume volume = GetParam();
  const auto cube = [](double x) {
    std::vector<Point3> corners;
    for (int i = 0; i < 8; ++i) {
      corners.push_back({x + (i & 1), static_cast<double>(i >> 1 & 1), static_cast<double>(i >> 2)});
    }
    return Cloud(corners);
  };
  const BoundingVolume a = fit(volume, cube(0)), b = fit(volume, cube(3));
  const std::uint32_t name = 0;
  Blocks one(volume), two(volume);
  one.add({&a, 1}, {&name, 1});
  two.add({&b, 1}, {&name, 1});
  PlacedFrame here;
  here.rows = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const View view(volume, here, here);
  PlacedVolume seen;
  two.placed({0, 0}, view, seen);
  Blocks::Distances found;
  one.distances(0, seen, view.frame.slack, INFINITY, found);
  EXPECT_NEAR(found[0], 2, volume == Volume::obb ? 1.3 : 1e-4);  // a cube has no principal axes
  EXPECT_LE(found[0], 2);
}

TEST_P(EachVolume, what_is_not_finite_is_apart_from_nothing) {
  struct Bad final : Enclosed {
    double far = 0;
    std::array<Point3, 1> middle{};
    [[nodiscard]] Extent extent(const Vector3&) const override { return {-1, far}; }
    [[nodiscard]] std::span<const Point3> points() const override { return middle; }
  };
  const Volume volume = GetParam();
  for (const double bad : std::array<double, 3>{INFINITY, NAN, 1e300}) {
    Bad set;
    set.far = bad;
    const BoundingVolume a = fit(volume, set), b = fit(volume, Cloud({{9, 9, 9}}));
    const std::uint32_t name = 0;
    Blocks one(volume), two(volume);
    one.add({&a, 1}, {&name, 1});
    two.add({&b, 1}, {&name, 1});
    PlacedFrame here;
    here.rows = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const View view(volume, here, here);
    PlacedVolume seen;
    Blocks::Distances found;
    two.placed({0, 0}, view, seen);
    one.distances(0, seen, view.frame.slack, INFINITY, found);
    EXPECT_FALSE(found[0] > 0) << bad;
    one.placed({0, 0}, view, seen);
    two.distances(0, seen, view.frame.slack, INFINITY, found);
    EXPECT_FALSE(found[0] > 0) << bad;
  }
}

TEST_P(EachVolume, merging_keeps_the_contents) {
  const Volume volume = GetParam();
  std::mt19937_64 random(25);
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<BoundingVolume> parts;
    std::vector<Point3> points;
    for (int i = 0; i < 5; ++i) {
      const auto cloud = any_points(random, {0.1 * i, 1 - 0.3 * i, 0.5}, 0.2);
      points.insert(points.end(), cloud.begin(), cloud.end());
      parts.push_back(fit(volume, Cloud(cloud)));
    }
    const BoundingVolume all = merge(volume, parts);
    const Ball ball = ball_around(volume, all);
    for (const Point3& p : points) {
      EXPECT_LE(distance(p, ball.centre), ball.radius);
      for (std::size_t k = 0; volume == Volume::obb && k < 3; ++k) {
        EXPECT_LE(std::fabs(dot(all.box.axes[k], p - all.box.centre)), all.box.half[k]);
      }
      const auto directions = directions_of(volume);
      for (std::size_t i = 0; i < directions.size(); ++i) {
        const double height = dot(all_directions[directions[i]], p - Point3{});
        EXPECT_LE(all.lower[i], height);
        EXPECT_GE(all.upper[i], height);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(blocks, EachVolume, ::testing::ValuesIn(all_volumes), [](const auto& volume) {
  std::string name = name_of(volume.param);
  std::erase(name, '-');
  return name;
});

}  // namespace
}  // namespace snug
