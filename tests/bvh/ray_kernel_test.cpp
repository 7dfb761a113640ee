// Segments against eight boxes, and eight segments against a box or a quadratic triangle, against points of both.

#include <snug/bvh/ray_kernel.h>
#include <snug/bvh/wide_node.h>

#include <gtest/gtest.h>
#include <snug/geometry/rounding.h>
#include <support/direction.h>
#include <testing/boxes.h>
#include <testing/counts.h>
#include <testing/instruction_sets.h>
#include <testing/placed_points.h>

#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

namespace snug::ray_kernel_test {
namespace {

using kernels::SeenSegments;

// Segments as they are meant, and as a node sees them.
struct Segments {
  std::array<Point3, 8> middle;
  std::array<Vector3, 8> along;
  std::array<double, 8> half, slack;

  [[nodiscard]] SeenSegments seen(const Point3& origin) const {
    SeenSegments result{};
    for (std::size_t i = 0; i < 8; ++i) {
      const Vector3 from = middle[i] - origin;
      for (std::size_t k = 0; k < 3; ++k) {
        result.middle[k][i] = static_cast<float>(from[k]);
        result.direction[k][i] = static_cast<float>(along[i][k]);
      }
      result.origin[i] = static_cast<float>(-dot(along[i], from));
      result.half[i] = float_up(half[i] * (1 + 0x1p-20));
      result.slack[i] = float_up(slack[i] + 0x1p-118);
    }
    return result;
  }
};

double unit(std::mt19937_64& random) { return std::uniform_real_distribution<double>(-1, 1)(random); }
Vector3 any_direction(std::mt19937_64& random) {
  Vector3 d{unit(random), unit(random), unit(random)};
  if (random() % 4 == 0) d[random() % 3] = 0;
  return length(d) > 0 ? normalized(d) : Vector3{0, 0, 1};
}

// At some of the points: through them, beside them by their slack, ending at them; or anywhere.
Segments any_segments(std::mt19937_64& random, const std::vector<Point3>& points, double size) {
  Segments result;
  for (std::size_t i = 0; i < 8; ++i) {
    const Point3& target = points[random() % points.size()];
    const Vector3 along = any_direction(random);
    const double away = size * 4 * unit(random);
    result.along[i] = along;
    result.half[i] = random() % 4 == 0 ? std::fabs(away) : size * 8 * std::fabs(unit(random));
    result.slack[i] = random() % 2 == 0 ? 0 : size * std::ldexp(1.0, -static_cast<int>(random() % 20));
    Vector3 aside = cross(along, any_direction(random));
    aside = random() % 3 == 0 || !(length(aside) > 0) ? Vector3{} : ((1 - 1e-9) / length(aside)) * aside;
    result.middle[i] = target + result.slack[i] * aside - away * along;
    if (random() % 4 == 0) result.middle[i] = result.middle[i] + size * any_direction(random);
  }
  return result;
}

// How far a point is from a segment, and where along it, from its middle.
struct Nearest {
  double distance, along;
};
Nearest nearest(const Segments& s, std::size_t i, const Point3& p) {
  const double along = dot(s.along[i], p - s.middle[i]);
  return {length(p - (s.middle[i] + std::clamp(along, -s.half[i], s.half[i]) * s.along[i])), along};
}

TEST(ray_kernel, boxes_that_a_segment_meets_are_found) {
  std::mt19937_64 random(91);
  std::size_t met = 0, missed = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(20'000)); ++trial) {
    const double size = std::ldexp(1.0, -static_cast<int>(random() % 20));
    std::vector<std::vector<Point3>> clouds;
    std::vector<Obb> boxes;
    std::vector<Point3> all;
    for (std::size_t l = 0; l < 1 + random() % 8; ++l) {
      const Point3 centre =
          Point3{0.3, -0.7, 1.1} + 4 * size * Vector3{unit(random), unit(random), unit(random)};
      clouds.push_back(testing::any_points(random, centre, size));
      boxes.push_back(testing::box_around(clouds.back()));
      all.insert(all.end(), clouds.back().begin(), clouds.back().end());
    }
    const WideNode node(boxes);
    const Segments segments = any_segments(random, all, size);
    const SeenSegments seen = segments.seen(node.origin());
    for (std::size_t i = 0; i < 8; ++i) {
      std::array<float, 8> begins, of_lanes;
      const std::uint32_t places = kernels::boxes_met(node, seen, i, begins);
      EXPECT_EQ(places >> boxes.size(), 0u);
      for (std::size_t l = 0; l < boxes.size(); ++l) {
        const bool found = (places >> l & 1u) != 0;
        (found ? met : missed)++;
        // The same either way.
        ASSERT_EQ(kernels::segments_meeting(node, l, seen, of_lanes) >> i & 1u, found ? 1u : 0u);
        ASSERT_EQ(of_lanes[i], begins[l]);
        for (const Point3& p : clouds[l]) {
          const Nearest there = nearest(segments, i, p);
          if (!(there.distance + 1e-15 <= segments.slack[i])) continue;
          ASSERT_TRUE(found) << trial << ", segment " << i << ", box " << l << ", size " << size;
          ASSERT_LE(static_cast<double>(begins[l]), there.along + 1e-15) << trial;
        }
      }
    }
  }
  EXPECT_GT(met, testing::fewer(100'000));
  EXPECT_GT(missed, testing::fewer(100'000));
}

TEST(ray_kernel, what_is_not_finite_is_met) {
  const Obb infinite = box_of(Obb{}.axes, {unbounded, unbounded, unbounded});
  const WideNode node({&infinite, 1});
  std::mt19937_64 random(92);
  const SeenSegments seen = any_segments(random, {Point3{50, 60, -70}}, 1).seen(node.origin());
  std::array<float, 8> begins;
  EXPECT_EQ(kernels::boxes_met(node, seen, 3, begins), 1u);
  EXPECT_EQ(begins[0], -INFINITY);
  EXPECT_EQ(kernels::segments_meeting(node, 0, seen, begins), 0xffu);
  const std::array<float, 18> net{};
  EXPECT_EQ(kernels::segments_meeting({net.data(), INFINITY, 1}, seen).near, 0xffu);
}

Vector3 at(const std::array<float, 18>& net, double u, double v) {
  const double r = 1 - u - v;
  const std::array<double, 6> weights{r * r, u * u, v * v, 2 * r * u, 2 * u * v, 2 * r * v};
  Vector3 sum;
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t a = 0; a < 3; ++a) sum[a] += weights[k] * static_cast<double>(net[3 * k + a]);
  }
  return sum;
}

TEST(ray_kernel, segments_that_meet_a_quadratic_triangle_are_found) {
  std::mt19937_64 random(93);
  constexpr int steps = 16;
  std::size_t inside = 0, beside = 0, missed = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(20'000)); ++trial) {
    const double size = std::ldexp(1.0, -static_cast<int>(random() % 20));
    // Nearly flat, bent, folded, a needle, a line, a point.
    const double bent = std::array{0.01, 0.3, 2.0}[random() % 3],
                 thin = std::array{1.0, 1e-4, 0.0}[random() % 3];
    std::array<float, 18> net;
    float reach = 0;
    std::array<Vector3, 6> exact;
    for (std::size_t k = 0; k < 3; ++k) {
      exact[k] =
          size * Vector3{unit(random), thin * unit(random), (random() % 8 == 0 ? 0 : 1) * unit(random)};
    }
    for (std::size_t k = 0; k < 3; ++k) {
      exact[3 + k] = 0.5 * (exact[k] + exact[(k + 1) % 3]) +
                     bent * size * Vector3{unit(random), thin * unit(random), unit(random)};
    }
    for (std::size_t k = 0; k < 6; ++k) {
      float sum = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        net[3 * k + a] = static_cast<float>(exact[k][a]);
        sum += std::fabs(net[3 * k + a]);
      }
      reach = std::max(reach, sum);
    }
    const double error = random() % 3 == 0 ? 0 : size * std::ldexp(1.0, -static_cast<int>(random() % 20));
    // Points of the set: of the triangle, of its sides, moved by the error.
    std::vector<Point3> points;
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const Vector3 q = at(net, i / double{steps}, j / double{steps});
        points.push_back(Point3{} + q + (0.999 * error) * any_direction(random));
      }
    }
    const Segments segments = any_segments(random, points, size);
    const kernels::Meeting met =
        kernels::segments_meeting({net.data(), float_up(error), reach}, segments.seen({}));
    EXPECT_EQ(met.inside & ~met.near, 0u);
    for (std::size_t i = 0; i < 8; ++i) {
      const bool near = (met.near >> i & 1u) != 0;
      (near ? (met.inside >> i & 1u) != 0 ? inside : beside : missed)++;
      if (near) continue;
      for (const Point3& p : points) {
        ASSERT_GT(nearest(segments, i, p).distance + 1e-15, segments.slack[i]) << trial << ", segment " << i;
      }
    }
  }
  EXPECT_GT(inside, testing::fewer(10'000));
  EXPECT_GT(beside, testing::fewer(10'000));
  EXPECT_GT(missed, testing::fewer(10'000));
}

// Squares of single precision underflow from 2^-75 on, products from 2^-126.
TEST(ray_kernel, sides_may_be_shorter_than_what_single_precision_has_squares_for) {
  std::mt19937_64 random(95);
  std::size_t near_ones = 0, missed = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(20'000)); ++trial) {
    const float side =
        static_cast<float>(std::ldexp(1 + std::fabs(unit(random)), -static_cast<int>(random() % 149)));
    const double error = random() % 4 == 0 ? 0 : std::ldexp(1.0, -static_cast<int>(random() % 30));
    // Two corners that are hardly apart, at the node's origin, which has the finest numbers; the third, too, or not.
    std::array<float, 18> net{};
    const std::size_t k = random() % 3, across = random() % 3, tip = (k + 2) % 3;
    const auto put = [&](std::size_t point, const Vector3& v) {
      for (std::size_t a = 0; a < 3; ++a) net[3 * point + a] = static_cast<float>(v[a]);
    };
    for (std::size_t a = 0; a < 3; ++a) {
      if (a == across || random() % 2 == 0)
        net[3 * ((k + 1) % 3) + a] = side * static_cast<float>(unit(random));
    }
    const double far = random() % 4 == 0 ? static_cast<double>(side) : 1.0;
    put(tip, far * any_direction(random));
    const auto corner = [&](std::size_t i) {
      return Vector3{static_cast<double>(net[3 * i]), static_cast<double>(net[3 * i + 1]),
                     static_cast<double>(net[3 * i + 2])};
    };
    for (std::size_t i = 0; i < 3; ++i) put(3 + i, 0.5 * (corner(i) + corner((i + 1) % 3)));
    float reach = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      reach = std::max(reach, std::fabs(net[3 * i]) + std::fabs(net[3 * i + 1]) + std::fabs(net[3 * i + 2]));
    }
    std::vector<Point3> points;
    for (int i = 0; i <= 8; ++i) {
      for (int j = 0; i + j <= 8; ++j) {
        points.push_back(Point3{} + at(net, i / 8.0, j / 8.0) + (0.999 * error) * any_direction(random));
      }
    }
    const Segments segments = any_segments(random, points, std::max(far, error));
    const kernels::Meeting met =
        kernels::segments_meeting({net.data(), float_up(error), reach}, segments.seen({}));
    for (std::size_t i = 0; i < 8; ++i) {
      const bool near = (met.near >> i & 1u) != 0;
      (near ? near_ones : missed)++;
      if (near) continue;
      for (const Point3& p : points) {
        ASSERT_GT(nearest(segments, i, p).distance + 1e-15, segments.slack[i])
            << trial << ", segment " << i << ", side " << side << ", error " << error;
      }
    }
  }
  EXPECT_GT(near_ones, testing::fewer(10'000));
  EXPECT_GT(missed, testing::fewer(10'000));
}

TEST(ray_kernel, segments_are_placed_with_one_rounding_to_single_precision) {
  testing::EachInstructionSet().run([](const char* name) {
    std::mt19937_64 random(95);
    for (int trial = 0; trial < 500; ++trial) {
      const Point3 origin{unit(random), unit(random), unit(random)};
      const Segments segments =
          any_segments(random, {origin}, std::ldexp(1.0, -static_cast<int>(random() % 20)));
      kernels::SegmentPlaces places{};
      for (std::size_t i = 0; i < 8; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          places.middle[k][i] = segments.middle[i][k];
          places.direction[k][i] = segments.along[i][k];
        }
      }
      SeenSegments placed{};
      kernels::place_segments(places, origin, placed);
      const SeenSegments wanted = segments.seen(origin);
      ASSERT_EQ(placed.middle, wanted.middle) << name << ", trial " << trial;
      ASSERT_EQ(placed.origin, wanted.origin) << name << ", trial " << trial;
    }
  });
}

TEST(ray_kernel, results_are_the_same_on_every_instruction_set) {
  std::vector<std::vector<std::uint32_t>> results;
  testing::EachInstructionSet().run([&](const char*) {
    std::mt19937_64 random(94);
    std::vector<std::uint32_t>& list = results.emplace_back();
    for (int trial = 0; trial < 500; ++trial) {
      std::vector<Obb> boxes;
      std::vector<Point3> all;
      for (std::size_t l = 0; l < 8; ++l) {
        const auto cloud = testing::any_points(random, Point3{unit(random), unit(random), unit(random)}, 1);
        boxes.push_back(testing::box_around(cloud));
        all.insert(all.end(), cloud.begin(), cloud.end());
      }
      const WideNode node(boxes);
      const SeenSegments seen = any_segments(random, all, 1).seen(node.origin());
      std::array<float, 8> begins;
      list.push_back(kernels::boxes_met(node, seen, trial % 8, begins));
      for (const float begin : begins) list.push_back(std::bit_cast<std::uint32_t>(begin));
      std::array<float, 18> net;
      for (float& x : net) x = static_cast<float>(unit(random));
      const kernels::Meeting met = kernels::segments_meeting({net.data(), 0.01F, 3}, seen);
      list.push_back(met.near);
      list.push_back(met.inside);
    }
  });
  ASSERT_GT(results.size(), 1u);
  for (const auto& list : results) EXPECT_EQ(list, results.front());
}

}  // namespace
}  // namespace snug::ray_kernel_test
