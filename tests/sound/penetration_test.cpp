// Penetration depths against brute force: supports of convex solids along dense directions; for others,
// translations that an independent search proves to separate them, which none may be shorter than the lower
// bound.

#include <snug/collide.h>
#include <snug/evaluate.h>

#include <gtest/gtest.h>
#include <oracle/contact_twin.h>
#include <testing/placements.h>
#include <testing/surfaces.h>
#include <testing/tagged.h>

#include <cmath>
#include <iostream>

namespace snug::penetration_test {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// Limit points all over a surface.
std::vector<Point3> samples_of(const Surface& surface, unsigned steps) {
  std::vector<Point3> points;
  for (std::uint32_t f = 0; f < surface.owner_count(); ++f) {
    for (unsigned i = 0; i <= steps; ++i) {
      for (unsigned j = 0; i + j <= steps; ++j) {
        points.push_back(
            evaluate(surface, {f, 0, static_cast<double>(i) / steps, static_cast<double>(j) / steps}).point);
      }
    }
  }
  return points;
}

// An ellipsoid, nearly.
oracle::TwinMesh egg(std::mt19937_64& random) {
  oracle::TwinMesh mesh = random() % 2 == 0 ? oracle::meshes::icosahedron() : oracle::meshes::octahedron();
  const std::array<double, 3> size{0.4 + unit(random), 0.4 + unit(random), 0.4 + unit(random)};
  for (oracle::Point& p : mesh.points) {
    for (std::size_t x = 0; x < 3; ++x) p[x] *= size[x];
  }
  return mesh;
}

double highest(const std::vector<Point3>& points, const Motion& pose, const Vector3& n) {
  double most = -INFINITY;
  for (const Point3& p : points) most = std::max(most, dot(n, pose.apply(p) - Point3{}));
  return most;
}

TEST(penetration, of_convex_solids_is_the_least_overlap_of_their_supports) {
  std::mt19937_64 random(91);
  double worst_upper = 0, worst_lower = INFINITY;
  int deep = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const Surface a = testing::public_surface(egg(random)), b = testing::public_surface(egg(random));
    const Motion place_a = testing::random_placement(random, testing::random_vector(random, 0.5)),
                 place_b = testing::random_placement(random, testing::random_vector(random, 0.5));
    const Penetration found = penetration(a.at(place_a), b.at(place_b));
    const std::vector<Point3> on_a = samples_of(a, 12), on_b = samples_of(b, 12);
    double least = INFINITY;
    Vector3 best{1, 0, 0};
    const auto look = [&](const Vector3& n) {
      const double overlap = highest(on_a, place_a, n) + highest(on_b, place_b, -n);
      if (overlap < least) least = overlap, best = n;
    };
    for (int i = 0; i < 400; ++i) {
      const Vector3 v = testing::random_vector(random, 1);
      look((1 / length(v)) * v);
    }
    for (int i = 0; i < 400; ++i) {
      const Vector3 v = best + std::exp2(-i / 50.0) * testing::random_vector(random, 1);
      look((1 / length(v)) * v);
    }
    if (least <= 0) {
      EXPECT_EQ(found.depth.lower, 0) << trial;
      continue;
    }
    ++deep;
    // Samples miss at most a hundredth of the bulge between them.
    EXPECT_GE(found.depth.upper, least * (1 - 1e-2) - 1e-3) << trial;
    EXPECT_LE(found.depth.lower, least + 2e-3) << trial;
    EXPECT_GT(found.depth.lower, 0) << trial;
    worst_upper = std::max(worst_upper, found.depth.upper / least);
    worst_lower = std::min(worst_lower, found.depth.lower / least);
    const Motion apart = place_b.with_offset(place_b.offset() + found.translation);
    EXPECT_LE(length(found.translation), found.depth.upper * (1 + 1e-12));
    oracle::ContactSurface twin_a(testing::twin_mesh(a.mesh(), BoundaryRule::edge_and_corner)),
        twin_b(testing::twin_mesh(b.mesh(), BoundaryRule::edge_and_corner));
    const oracle::ContactGoal goal{{1e-9, 0}, 0, 200'000};
    const oracle::ContactBounds gap =
        oracle::contact_bounds(twin_a, place_a.numbers(), twin_b, apart.numbers(), goal);
    EXPECT_GT(gap.lower, 0) << trial;
  }
  std::cout << "  " << deep << " overlaps; upper at most " << worst_upper << ", lower at least "
            << worst_lower << " times the depth\n";
  EXPECT_GE(deep, 6);
  EXPECT_LT(worst_upper, 1.05);
  EXPECT_GT(worst_lower, 0.5);
}

TEST(penetration, bounds_hold_for_solids_with_dents) {
  std::mt19937_64 random(92);
  int deep = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const Surface a = testing::public_surface(
                      oracle::meshes::disturbed(oracle::meshes::icosahedron(), 6, 0.4, random)),
                  b = testing::public_surface(
                      oracle::meshes::disturbed(oracle::meshes::octahedron(), 6, 0.4, random));
    const Motion place_b = testing::random_placement(random, testing::random_vector(random, 0.7));
    const Penetration found = penetration(a, b.at(place_b));
    EXPECT_LE(found.depth.lower, found.depth.upper);
    if (found.depth.upper == 0) continue;
    ++deep;
    oracle::ContactSurface twin_a(testing::twin_mesh(a.mesh(), BoundaryRule::edge_and_corner)),
        twin_b(testing::twin_mesh(b.mesh(), BoundaryRule::edge_and_corner));
    const oracle::ContactGoal goal{{1e-7, 0}, 0, 20'000};
    const auto apart = [&](const Vector3& d) {
      const Motion moved = place_b.with_offset(place_b.offset() + d);
      return oracle::contact_bounds(twin_a, Motion().numbers(), twin_b, moved.numbers(), goal).lower > 0;
    };
    EXPECT_TRUE(apart(found.translation)) << trial;
    // Surfaces that shorter translations part: one solid must lie in the other.
    for (int i = 0; i < 40; ++i) {
      const Vector3 v = testing::random_vector(random, 1);
      const Vector3 d = (found.depth.lower * unit(random) / length(v)) * v;
      if (!apart(d)) continue;
      const Motion moved = place_b.with_offset(place_b.offset() + d);
      EXPECT_TRUE(collide(a, b.at(moved), {.tolerance = 0, .solid = true}).contained) << trial;
    }
  }
  EXPECT_GE(deep, 5);
}

// A square frame, 4 wide and 1 high, around a hole that is 2 wide.
ControlMesh frame() {
  constexpr std::array<double, 4> line{0, 1, 3, 4};
  ControlMesh mesh;
  for (const double z : {0.0, 1.0}) {
    for (const double y : line) {
      for (const double x : line) mesh.points.push_back({x, y, z});
    }
  }
  const auto quad = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    mesh.add_face(std::array{VertexId(a), VertexId(b), VertexId(c)});
    mesh.add_face(std::array{VertexId(a), VertexId(c), VertexId(d)});
  };
  const auto at = [](std::size_t i, std::size_t k) { return i + 4 * k; };
  // Upright, seen from the right of the way from the first to the second.
  const auto wall = [&](std::size_t a, std::size_t b) { quad(a, b, 16 + b, 16 + a); };
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (i == 1 && k == 1) continue;
      const std::size_t a = at(i, k), b = at(i + 1, k), c = at(i + 1, k + 1), d = at(i, k + 1);
      quad(16 + a, 16 + b, 16 + c, 16 + d);
      quad(d, c, b, a);
    }
    wall(at(i, 0), at(i + 1, 0)), wall(at(i + 1, 3), at(i, 3));
    wall(at(0, i + 1), at(0, i)), wall(at(3, i), at(3, i + 1));
  }
  wall(at(2, 1), at(1, 1)), wall(at(1, 2), at(2, 2)), wall(at(1, 1), at(1, 2)), wall(at(2, 2), at(2, 1));
  mesh.tags.scheme = Scheme::flat;
  return mesh;
}

// A cube over a corner of the hole leaves through the top, or slants into the hole.
TEST(penetration, finds_ways_into_holes) {
  std::mt19937_64 random(94);
  ControlMesh cube = testing::control_mesh(oracle::meshes::triangulated(oracle::meshes::cube()));
  const Surface ring(frame()), box(cube, {.scheme = Scheme::flat});
  int slanted = 0, reached = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const double x = 0.05 + 0.9 * unit(random), y = 0.05 + 0.9 * unit(random);
    const double into_hole = std::hypot(1 - x, 1 - y), depth = std::min(1.0, into_hole);
    const Penetration found = penetration(ring, box.at(Motion::translation({x, y, 0})));
    ASSERT_LE(found.depth.lower, depth) << trial;
    ASSERT_GE(found.depth.upper, depth * (1 - 1e-12)) << trial;
    EXPECT_LE(found.depth.upper, 1.04 * depth) << trial << ' ' << x << ' ' << y;
    slanted += into_hole < 1 ? 1 : 0;
    reached += (found.outcome == Outcome::complete) ? 1 : 0;
  }
  std::cout << slanted << " into the hole, " << reached << " reached\n";
  EXPECT_GT(slanted, 10);
}

TEST(penetration, of_separated_solids_is_zero_and_open_surfaces_are_refused) {
  const Surface ball = testing::public_surface(oracle::meshes::icosahedron()),
                sheet = testing::public_surface(oracle::meshes::grid(2, 2));
  const Penetration none = penetration(ball, ball.at(Motion::translation({5, 0, 0})));
  EXPECT_EQ(none.depth.upper, 0);
  EXPECT_EQ(none.outcome, Outcome::complete);
  EXPECT_THROW(static_cast<void>(penetration(ball, sheet)), InputError);
  // One in the middle of itself: as deep as it is thick.
  const Penetration whole = penetration(ball, ball);
  EXPECT_GT(whole.depth.lower, 1.2);
  EXPECT_LT(whole.depth.upper, 2);
}

}  // namespace
}  // namespace snug::penetration_test
