#include <oracle/limit_twin.h>

#include <gtest/gtest.h>
#include <oracle/contact_twin.h>
#include <oracle/polygon_twin.h>
#include <oracle/tagged_shapes.h>
#include <oracle/test_meshes.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace oracle::limit_twin_test {
namespace {

using namespace meshes;

struct Case {
  TaggedMesh mesh;
  Rules rules;
};

/// Every shape under every boundary rule, with random tags on two of three.
std::vector<Case> assorted(PrimalScheme scheme) {
  std::mt19937_64 random(41);
  std::vector<Case> list;
  int number = 0;
  for (const TaggedMesh& plain :
       {cube(), quad_grid(4, 3), prism(5), pyramid(3), pyramid(7), mixed_strip(), book(3),
        two_cubes_at_a_vertex(), moebius(5), valence_two_inside(), pole(9, true), pole(9, false)})
    for (const Boundary boundary : {Boundary::none, Boundary::edge_only, Boundary::edge_and_corner}) {
      if (scheme == PrimalScheme::loop && plain.points.size() == 17)
        continue;  // two edges between two vertices
      TaggedMesh mesh = shaken(scheme == PrimalScheme::loop ? triangulated(plain) : plain, 0.2, random);
      Rules rules;
      rules.scheme = scheme;
      rules.boundary = boundary;
      rules.clamp_dart_edges = true;
      if (++number % 3 > 0) {
        rules.chaikin = random() % 2 == 0;
        rules.smooth_triangles = scheme == PrimalScheme::catmull_clark && random() % 2 == 0;
        const double values[] = {0.3, 1, 2.5, 10, 1.7, 10};
        for (const auto& p : mesh.polygons)
          for (std::size_t k = 0; k < p.size(); ++k)
            if (random() % 4 == 0)
              mesh.creases.push_back({p[k], p[(k + 1) % p.size()], values[random() % 6]});
        if (random() % 2 == 0) mesh.corners.push_back({0, values[random() % 6]});
        if (random() % 3 == 0) mesh.holes = {0};
      }
      list.push_back({std::move(mesh), rules});
    }
  return list;
}

TEST(limit_twin, limit_points_are_those_of_the_polygon_twin) {
  for (const PrimalScheme scheme : {PrimalScheme::catmull_clark, PrimalScheme::loop}) {
    std::size_t compared = 0;
    for (const Case& c : assorted(scheme)) {
      const std::vector<FaceSample> samples = sample_faces(c.mesh, c.rules, 3);
      const auto rules = std::make_shared<LimitRules>(c.rules);
      if (samples.empty()) {
        EXPECT_THROW(LimitTwin(c.mesh, rules), std::invalid_argument);
        continue;
      }
      LimitTwin twin(c.mesh, rules);
      for (std::size_t i = 0; i < samples.size(); i += 3) {
        const FaceSample& s = samples[i];
        const Point p = twin.limit_point(s.face, s.part, s.u, s.v);
        for (std::size_t x = 0; x < 3; ++x)
          ASSERT_NEAR(p[x], s.position[x], 1e-11) << s.face << '.' << s.part;
        ++compared;
      }
    }
    EXPECT_GT(compared, 1000U);
  }
}

/// A search for samples from a hair beside them ends near them, and its bounds hold the hair.
TEST(limit_twin, distances_of_samples_are_none) {
  for (const PrimalScheme scheme : {PrimalScheme::catmull_clark, PrimalScheme::loop})
    for (const Case& c : assorted(scheme)) {
      const std::vector<FaceSample> samples = sample_faces(c.mesh, c.rules, 2);
      if (samples.empty()) continue;
      LimitTwin twin(c.mesh, std::make_shared<LimitRules>(c.rules));
      for (std::size_t i = 0; i < samples.size(); i += 17) {
        EXPECT_TRUE(twin.on_surface(kUnmoved, samples[i].position, 1e-9, samples[i].face)) << i;
        Point beside = samples[i].position;
        beside[i % 3] += 1e-3;
        ContactGoal goal;
        goal.precision = {1e-7, 0};
        const ContactBounds found = twin.distance_to(kUnmoved, beside, goal);
        EXPECT_LE(found.lower, 1e-3 + 1e-12);
        EXPECT_GE(found.upper, found.lower);
      }
    }
}

TEST(limit_twin, samples_of_dual_schemes_are_on_the_patches_of_their_owners) {
  std::mt19937_64 random(43);
  for (const DualScheme scheme : {DualScheme::doo_sabin, DualScheme::midedge}) {
    const auto rules = std::make_shared<LimitRules>(scheme);
    for (const TaggedMesh& plain : {cube(), quad_grid(4, 4), prism(5), pyramid(3), pyramid(7), mixed_strip(),
                                    triangulated(prism(6)), pole(9, false)}) {
      const TaggedMesh mesh = shaken(plain, 0.2, random);
      const std::vector<DualSample> samples = sample_dual(mesh, scheme, 3);
      LimitTwin twin(mesh, rules);
      for (std::size_t i = 0; i < samples.size(); i += 2)
        for (const std::uint32_t owner : samples[i].owners)
          EXPECT_TRUE(twin.on_surface(kUnmoved, samples[i].position, 1e-9, owner)) << i;
      // And nowhere else: limit points of patches are near samples, nearer than their spacing.
      for (std::size_t i = 0; i < 40; ++i) {
        const Point p = twin.some_limit_point(i);
        double least = 1;
        for (const DualSample& s : samples)
          least =
              std::min(least, std::hypot(p[0] - s.position[0], p[1] - s.position[1], p[2] - s.position[2]));
        EXPECT_LE(least, 1e-12);
      }
    }
  }
}

TEST(limit_twin, bounds_overlap_those_of_the_loop_twin) {
  std::mt19937_64 random(44);
  Rules loop;
  loop.scheme = PrimalScheme::loop;
  const auto rules = std::make_shared<LimitRules>(loop);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 60; ++trial) {
    const TwinMesh a = disturbed(icosahedron(), trial % 7, 0.15, random),
                   b = disturbed(bipyramid(3 + static_cast<std::uint32_t>(random() % 9)), 2, 0.1, random);
    const auto tagged = [](const TwinMesh& mesh) {
      TaggedMesh result;
      result.points = mesh.points;
      for (const Triangle& t : mesh.triangles) result.polygons.push_back({t[0], t[1], t[2]});
      return result;
    };
    Placement place = kUnmoved;
    for (std::size_t x = 0; x < 3; ++x) place[4 * x + 3] = 1.5 * unit(random);
    ContactSurface known_a(a), known_b(b);
    LimitTwin twin_a(tagged(a), rules), twin_b(tagged(b), rules);
    ContactGoal goal;
    goal.precision = {1e-4, 1e-3};
    const ContactBounds known = contact_bounds(known_a, kUnmoved, known_b, place, goal),
                        found = contact_bounds(twin_a, kUnmoved, twin_b, place, goal);
    EXPECT_LE(found.lower, known.upper);
    EXPECT_LE(known.lower, found.upper);
    EXPECT_FALSE(found.spent);
  }
}

TEST(limit_twin, winding_numbers_tell_inside_from_outside) {
  Rules rules;
  LimitTwin ball(cube(), std::make_shared<LimitRules>(rules));
  EXPECT_EQ(ball.winding_number({0.5, 0.5, 0.5}), 1);
  EXPECT_EQ(ball.winding_number({1.5, 0.5, 0.5}), 0);
  EXPECT_EQ(ball.winding_number({0.02, 0.02, 0.02}), 0);  // inside the cube, outside of what it becomes
  TaggedMesh sharp = cube();
  for (std::uint32_t v = 0; v < 8; ++v) sharp.corners.push_back({v, 10});
  for (const auto& p : sharp.polygons)
    for (std::size_t k = 0; k < 4; ++k) sharp.creases.push_back({p[k], p[(k + 1) % 4], 10});
  LimitTwin box(sharp, std::make_shared<LimitRules>(rules));
  EXPECT_EQ(box.winding_number({0.15, 0.15, 0.15}), 1);
  EXPECT_EQ(box.winding_number({-0.02, 0.15, 0.15}), 0);
  for (const DualScheme scheme : {DualScheme::doo_sabin, DualScheme::midedge}) {
    LimitTwin dual(prism(5), std::make_shared<LimitRules>(scheme));
    EXPECT_EQ(dual.winding_number({0.1, 0.1, 0.1}), 1);
    EXPECT_EQ(dual.winding_number({0.1, 2, 0.1}), 0);
  }
  EXPECT_EQ(ball.winding_number(ball.some_limit_point(0)), std::nullopt);
  LimitTwin open(quad_grid(2, 2), std::make_shared<LimitRules>(rules));
  EXPECT_THROW((void)open.winding_number({1, 1, 0.5}), std::invalid_argument);
}

TEST(limit_twin, high_valences_are_answered) {
  for (const bool dart : {false, true}) {
    Rules rules;
    TaggedMesh mesh = pole(240, false);
    if (dart) mesh.creases = {{0, 1, 10}};
    LimitTwin twin(mesh, std::make_shared<LimitRules>(rules));
    const Point top = sample_faces(mesh, rules, 0).front().position;  // the middle of the pole
    EXPECT_TRUE(twin.on_surface(kUnmoved, top, 1e-7));
    EXPECT_FALSE(twin.on_surface(kUnmoved, {top[0], top[1], top[2] + 0.01}, 1e-4));
  }
  TaggedMesh mesh = pole(240, false);
  LimitTwin dual(mesh, std::make_shared<LimitRules>(DualScheme::doo_sabin));
  EXPECT_TRUE(dual.on_surface(kUnmoved, sample_dual(mesh, DualScheme::doo_sabin, 1).front().position, 1e-7));
}

}  // namespace
}  // namespace oracle::limit_twin_test
