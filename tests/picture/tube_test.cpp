#include <picture/tube.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

namespace snug::tube_test {
namespace {

using Chain = std::vector<Point3>;

double distance_to_segment(Point3 p, Point3 a, Point3 b) {
  const Vector3 ab = b - a;
  const double square = dot(ab, ab);
  const double t = square > 0 ? std::clamp(dot(p - a, ab) / square, 0.0, 1.0) : 0;
  return length(p - (a + t * ab));
}

double distance_to(const Chain& chain, Point3 p) {
  double least = length(p - chain.front());
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    least = std::min(least, distance_to_segment(p, chain[i], chain[i + 1]));
  }
  return least;
}

PictureScene scene_of(const Chain& chain, double radius, unsigned sides) {
  const Tube tube(chain, radius);
  PictureScene scene;
  tube.add_to(scene, sides, 7);
  EXPECT_EQ(scene.triangles.size(), tube.triangle_count(sides));
  return scene;
}

// Closed. It leaves its plane, so that rings that turn as little as possible come back turned.
Chain knot(int steps) {
  Chain chain;
  for (int i = 0; i <= steps; ++i) {
    const double a = 2 * std::numbers::pi * (i % steps) / steps;
    chain.push_back({std::sin(a) + 2 * std::sin(2 * a), std::cos(a) - 2 * std::cos(2 * a), -std::sin(3 * a)});
  }
  return chain;
}

// Is every edge between two triangles, which run along it in opposite directions?
bool is_closed(const PictureScene& scene) {
  std::map<std::array<double, 6>, int> balance;
  for (const ShadedTriangle& t : scene.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Point3 a = t.corner[i], b = t.corner[(i + 1) % 3];
      ++balance[{a.x, a.y, a.z, b.x, b.y, b.z}];
      --balance[{b.x, b.y, b.z, a.x, a.y, a.z}];
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

TEST(tube, stays_at_its_radius_and_faces_outwards) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int round = 0; round < 40; ++round) {
    Chain chain;
    for (int i = 0; i < 8; ++i) chain.push_back({coordinate(random), coordinate(random), coordinate(random)});
    if (round % 2 == 1) chain.push_back(chain.front());
    const double radius = 0.01;
    for (const unsigned sides : {5u, 6u, 13u}) {
      for (const ShadedTriangle& t : scene_of(chain, radius, sides).triangles) {
        EXPECT_EQ(t.material, 7u);
        for (int i = 0; i < 3; ++i) {
          EXPECT_LE(distance_to(chain, t.corner[i]), radius * (1 + 1e-9));
          EXPECT_NEAR(length(t.normal[i]), 1, 1e-12);
          const Vector3 facing = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
          EXPECT_GE(dot(facing, t.normal[i]), -1e-15);
        }
      }
    }
  }
}

TEST(tube, of_a_smooth_closed_chain_has_no_seam_and_no_ball) {
  for (const unsigned sides : {6u, 7u, 12u}) {
    const PictureScene scene = scene_of(knot(150), 0.02, sides);
    EXPECT_EQ(scene.triangles.size(), 150u * 2 * sides);
    EXPECT_TRUE(is_closed(scene));
    // Where it closes, quads are twisted by half a side at most: so far from the chain is the middle of their
    // diagonals.
    for (const ShadedTriangle& t : scene.triangles) {
      for (int i = 0; i < 3; ++i) {
        const Point3 middle = t.corner[i] + 0.5 * (t.corner[(i + 1) % 3] - t.corner[i]);
        EXPECT_GE(distance_to(knot(150), middle), 0.02 * 0.97 * std::cos(1.5 * std::numbers::pi / sides));
      }
    }
  }
}

TEST(tube, is_round_at_ends_and_where_it_turns_sharply) {
  const double radius = 0.1;
  const unsigned sides = 12;
  const std::size_t tube = std::size_t{2} * sides, ball = std::size_t{2} * sides * (sides / 2 - 1);
  const Point3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{2, 0.1, 0};
  const auto count = [&](const Chain& chain) { return scene_of(chain, radius, sides).triangles.size(); };
  EXPECT_EQ(count({a, b}), tube + 2 * ball);
  EXPECT_EQ(count({a, b, c}), 2 * tube + 3 * ball);
  EXPECT_EQ(count({a, b, d}), 2 * tube + 2 * ball);  // by 6 degrees
  EXPECT_EQ(count({a, b, a}), 2 * tube + 2 * ball);  // closed
  EXPECT_EQ(count({a, b, c, a}), 3 * tube + 3 * ball);
  // Every direction is reached around each of them.
  for (const Point3 end : {a, b, c}) {
    const PictureScene scene = scene_of({a, b, c}, radius, sides);
    for (const Vector3 side : {Vector3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
      double farthest = 0;
      for (const ShadedTriangle& t : scene.triangles) {
        for (const Point3& p : t.corner) {
          if (length(p - end) < radius * 1.001) farthest = std::max(farthest, dot(p - end, side));
        }
      }
      EXPECT_GE(farthest, 0.96 * radius);
    }
  }
}

TEST(tube, of_one_place_is_a_ball) {
  const Point3 p{1, 2, 3}, beside{1, 2, 3 + 1e-9};
  for (const Chain& chain : {Chain{p}, Chain{p, p}, Chain{p, p, p}, Chain{p, beside, p}, Chain{p, beside}}) {
    const PictureScene scene = scene_of(chain, 0.5, 10);
    EXPECT_EQ(scene.triangles.size(), 10u * 2 * 4);
    EXPECT_TRUE(is_closed(scene));
    for (const ShadedTriangle& t : scene.triangles) {
      for (const Point3& corner : t.corner) EXPECT_NEAR(length(corner - p), 0.5, 1e-12);
    }
  }
}

TEST(tube, keeps_its_ends_and_leaves_out_points_that_crowd) {
  Chain chain;
  for (int i = 0; i <= 1000; ++i) chain.push_back({i * 1e-4, 0, 0});
  const PictureScene scene = scene_of(chain, 0.1, 6);
  EXPECT_LE(scene.triangles.size(), 60u * 12 + 2 * 24);
  double least = 1, most = 0;
  for (const ShadedTriangle& t : scene.triangles) {
    for (int i = 0; i < 3; ++i) {
      const double centre = t.corner[i].x - 0.1 * t.normal[i].x;
      least = std::min(least, centre);
      most = std::max(most, centre);
    }
  }
  EXPECT_NEAR(least, 0, 1e-12);
  EXPECT_NEAR(most, 0.1, 1e-12);
}

TEST(tube, lies_in_its_outline) {
  const Chain chain = knot(31);
  std::vector<Point3> outline;
  Tube(chain, 0.05).add_outline(outline);
  for (const Vector3 side : {Vector3{1, 2, 3}, {-1, 0, 0}, {0, 1, -1}, {3, -2, 1}}) {
    double inside = -9, outside = -9;
    for (const Point3& p : outline) outside = std::max(outside, dot(p - Point3{}, side));
    for (const ShadedTriangle& t : scene_of(chain, 0.05, 9).triangles) {
      for (const Point3& p : t.corner) inside = std::max(inside, dot(p - Point3{}, side));
    }
    EXPECT_LE(inside, outside + 1e-12);
  }
}

}  // namespace
}  // namespace snug::tube_test
