#include <oracle/contact_twin.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <oracle/test_meshes.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace oracle::contact_twin_test {
namespace {

using namespace meshes;

Placement translation(double x, double y, double z) { return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}; }

// Turned about an axis that is no coordinate axis; rigid to roundings.
Placement turned(double angle, const Point& t) {
  const double c = std::cos(angle), s = std::sin(angle), x = 2.0 / 3, y = -1.0 / 3, z = 2.0 / 3;
  return {c + x * x * (1 - c),     x * y * (1 - c) - z * s, x * z * (1 - c) + y * s, t[0],
          y * x * (1 - c) + z * s, c + y * y * (1 - c),     y * z * (1 - c) - x * s, t[1],
          z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c),     t[2]};
}

Point moved(const Placement& m, const Point& p) {
  Point q{};
  for (std::size_t r = 0; r < 3; ++r)
    q[r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
  return q;
}

std::vector<TwinMesh> assorted() {
  std::mt19937_64 random(3);
  std::vector<TwinMesh> list{disturbed(icosahedron(), 10, 0.15, random),
                             disturbed(bipyramid(3), 2, 0.1, random),
                             disturbed(bipyramid(12), 4, 0.1, random), quartered(octahedron())};
  for (const Boundary rule : {Boundary::edge_and_corner, Boundary::edge_only, Boundary::none})
    list.push_back(disturbed(grid(3, 3, rule), 4, 0.2, random));
  return list;
}

TEST(contact_twin, limit_points_are_those_of_the_quad_twin) {
  for (const TwinMesh& mesh : assorted()) {
    ContactSurface surface(mesh);
    for (const LimitSample& s : sample_uniform(mesh, 3)) {
      const Point p = surface.limit_point(s.face, s.u, s.v);
      for (std::size_t x = 0; x < 3; ++x) EXPECT_NEAR(p[x], s.position[x], 1e-13);
    }
  }
  const TwinMesh mesh = octahedron();
  const double u = 0.25 + 0x1p-31, v = 0.5 + 0x1p-30;
  const LimitSample s = sample_at(mesh, 3, u, v).at(0);
  const Point p = ContactSurface(mesh).limit_point(3, u, v);
  for (std::size_t x = 0; x < 3; ++x) EXPECT_NEAR(p[x], s.position[x], 1e-13);
}

TEST(contact_twin, bounds_overlap_those_of_the_slow_twin) {
  const std::vector<TwinMesh> list = assorted();
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  int apart = 0, touching = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const TwinMesh &a = list[random() % list.size()], &b = list[random() % list.size()];
    const Placement place_a = turned(3 * unit(random), {0.3, 0.2, 0.1}),
                    place_b = turned(3 * unit(random), {unit(random), unit(random), unit(random)});
    ContactSurface twin_a(a), twin_b(b);
    const ContactBounds fast = contact_bounds(twin_a, place_a, twin_b, place_b, {{1e-4, 1e-3}});
    const TwinDistance slow = brute_distance(a, place_a, b, place_b, 1e-3);
    EXPECT_FALSE(fast.spent) << trial;
    EXPECT_LE(fast.lower, slow.upper) << trial;
    EXPECT_LE(slow.lower, fast.upper) << trial;
    EXPECT_LE(fast.upper - fast.lower, std::max(1e-4, 1e-3 * fast.upper) + 1e-11) << trial;
    EXPECT_TRUE(on_surface(a, place_a, fast.on_a, 1e-11)) << trial;
    EXPECT_TRUE(on_surface(b, place_b, fast.on_b, 1e-11)) << trial;
    ++(slow.lower > 0 ? apart : touching);
    // One-sided questions at thresholds around the truth.
    if (slow.lower < 0.01) continue;
    for (const double factor : {0.5, 0.99, 1.01, 2.0}) {
      ContactGoal goal;
      goal.threshold = factor * fast.upper;
      const ContactBounds found = contact_bounds(twin_a, place_a, twin_b, place_b, goal);
      EXPECT_FALSE(found.spent);
      if (factor < 1)
        EXPECT_GT(found.lower, *goal.threshold) << trial;
      else
        EXPECT_LE(found.upper, *goal.threshold) << trial;
    }
  }
  EXPECT_GT(apart, 10);
  EXPECT_GT(touching, 10);
}

TEST(contact_twin, a_hair_between_parallel_sheets_is_found) {
  const TwinMesh sheet = grid(3, 3);
  ContactSurface a(sheet), b(sheet);
  for (const double h : {1e-3, 1e-7, 1e-10, 2e-12}) {
    const Placement place = turned(0.7, {0.1, 0.2, 0.3});
    Placement other = place;
    for (std::size_t r = 0; r < 3; ++r) other[4 * r + 3] += h * place[4 * r + 2];
    const ContactBounds found = contact_bounds(a, place, b, other, {{0, 0}, 0.0});
    EXPECT_GT(found.lower, 0) << h;
    EXPECT_LE(found.lower, h * 1.001) << h;
  }
}

TEST(contact_twin, surfaces_far_away_are_as_exact_as_near_ones) {
  const TwinMesh mesh = octahedron();
  ContactSurface a(mesh), b(mesh);
  const double gap = 4 - 48.0 / 55;
  for (const double far : {0.0, 0x1p20, 0x1p40}) {
    const ContactBounds d =
        contact_bounds(a, translation(far, -far, far), b, translation(far + 4, -far, far), {{1e-9, 0}});
    EXPECT_LE(d.lower, gap);
    EXPECT_GE(d.upper, gap);
    EXPECT_LE(d.upper - d.lower, 1.1e-9) << far;
  }
}

TEST(contact_twin, a_surface_and_itself_have_no_gap) {
  std::mt19937_64 random(8);
  ContactSurface a(disturbed(icosahedron(), 5, 0.1, random));
  const Placement place = turned(1, {5, 6, 7});
  const ContactBounds d = contact_bounds(a, place, a, place, {{0, 0}, 1e-12});
  EXPECT_EQ(d.lower, 0);
  EXPECT_LE(d.upper, 1e-12);
}

TEST(contact_twin, points_are_on_the_surface_or_not) {
  std::mt19937_64 random(6);
  for (const Boundary boundary : {Boundary::edge_and_corner, Boundary::edge_only, Boundary::none}) {
    const TwinMesh mesh = disturbed(grid(4, 4, boundary), 8, 0.2, random);
    ContactSurface twin(mesh);
    const Placement place = turned(0.4, {1e6, 0, -3e5});
    const auto samples = sample_uniform(mesh, 4);
    for (std::size_t i = 0; i < samples.size(); i += 7) {
      const Point p = moved(place, samples[i].position);
      EXPECT_TRUE(twin.on_surface(place, p, 1e-9));
      EXPECT_TRUE(twin.on_surface(place, p, 1e-9, samples[i].face));
    }
  }
  ContactSurface twin(octahedron());
  const double corner = 24.0 / 55;
  EXPECT_FALSE(twin.on_surface(kUnmoved, {corner + 1e-9, 0, 0}, 1e-10));
  EXPECT_TRUE(twin.on_surface(kUnmoved, {corner + 1e-9, 0, 0}, 1e-8));
  EXPECT_FALSE(twin.on_surface(kUnmoved, {corner, 0, 0}, 1e-3, 1));  // face 1 does not reach that corner
  const ContactBounds far = twin.distance_to(kUnmoved, {10, 0, 0}, {{1e-8, 0}});
  EXPECT_LE(far.lower, 10 - corner);
  EXPECT_GE(far.upper, 10 - corner);
  EXPECT_LE(far.upper - far.lower, 1.1e-8);
}

TEST(contact_twin, segments_that_miss_and_segments_that_cross) {
  ContactSurface shell(quartered(icosahedron()));
  const Placement place = turned(0.9, {3, 2, 1});
  const Point centre{3, 2, 1};
  int missed = 0;
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.4 * i, height = -0.9 + 0.045 * i, r = std::sqrt(1 - height * height);
    const Point direction{r * std::cos(angle), r * std::sin(angle), height};
    const auto at = [&](double t) {
      return Point{centre[0] + t * direction[0], centre[1] + t * direction[1], centre[2] + t * direction[2]};
    };
    EXPECT_FALSE(shell.misses(place, centre, at(2)));
    missed += shell.misses(place, at(0.7), centre) && shell.misses(place, at(1.01), at(9));
  }
  EXPECT_EQ(missed, 40);
}

TEST(contact_twin, refuses_what_has_no_surface) {
  EXPECT_THROW(ContactSurface(grid(1, 1, Boundary::none)), std::invalid_argument);
  ContactSurface twin(grid(3, 3, Boundary::none));
  EXPECT_THROW((void)twin.limit_point(0, 0.2, 0.2), std::invalid_argument);
  EXPECT_THROW((void)twin.limit_point(8, 0.7, 0.7), std::invalid_argument);
  EXPECT_THROW((void)twin.on_surface(translation(std::nan(""), 0, 0), {0, 0, 0}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace oracle::contact_twin_test
