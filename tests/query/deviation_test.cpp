// Deviations that are known, what is refused, and that neither threads nor budgets make them wrong.

#include <snug/distance.h>

#include <gtest/gtest.h>
#include <snug/evaluate.h>
#include <snug/tessellate.h>
#include <support/error.h>
#include <testing/candidates.h>
#include <testing/tagged.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snug::deviation_test {
namespace {

using testing::TriangleSet;

Surface surface_of(const oracle::TaggedMesh& mesh, Scheme scheme) {
  return Surface(testing::control_mesh(mesh), {.scheme = scheme});
}

/// [0, 1]^3, changed.
oracle::TaggedMesh cube(double side = 1, const oracle::Point& corner = {}) {
  oracle::TaggedMesh mesh = oracle::meshes::cube();
  for (oracle::Point& p : mesh.points)
    for (std::size_t x = 0; x < 3; ++x) p[x] = corner[x] + side * p[x];
  return mesh;
}

std::vector<Triangle> triangles(const oracle::TaggedMesh& mesh) {
  return testing::candidate_of(testing::triangles_of(mesh));
}

Deviation compared(const Surface& surface, const std::vector<Triangle>& candidate, double precision = 1e-6,
                   bool solid = false) {
  DeviationOptions options;
  options.absolute = precision;
  options.solid = solid;
  return deviation(surface, candidate, options);
}

void expect_distance(const OneSidedDistance& found, double truth, double precision = 1e-6) {
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * truth;
  EXPECT_LE(found.distance.lower, truth + rounding);
  EXPECT_GE(found.distance.upper, truth - rounding);
  EXPECT_LE(found.distance.upper - found.distance.lower, precision);
  const double apart = std::hypot(found.from.point.x - found.to.x, found.from.point.y - found.to.y,
                                  found.from.point.z - found.to.z);
  EXPECT_GE(apart, found.distance.lower - 2 * found.from.error);
}

TEST(deviation, of_cubes_is_known) {
  for (const Scheme scheme : {Scheme::bilinear, Scheme::flat}) {
    const Surface unit =
        surface_of(scheme == Scheme::flat ? oracle::meshes::triangulated(oracle::meshes::cube())
                                          : oracle::meshes::cube(),
                   scheme);
    const Deviation same = compared(unit, triangles(cube()));
    expect_distance(same.from_surface, 0);
    expect_distance(same.from_candidate, 0);
    EXPECT_EQ(same.outcome, Outcome::complete);
    const Deviation moved = compared(unit, triangles(cube(1, {0.25, 0, 0})));
    expect_distance(moved.from_surface, 0.25);
    expect_distance(moved.from_candidate, 0.25);
    const Deviation larger = compared(unit, triangles(cube(3, {-1, -1, -1})));
    expect_distance(larger.from_surface, 1);
    expect_distance(larger.from_candidate, std::sqrt(3.0));
    const Deviation beside = compared(unit, triangles(cube(1, {1e6, 0, 0})), 1e-3);
    expect_distance(beside.from_surface, 1e6, 1e-3);
    expect_distance(beside.from_candidate, 1e6, 1e-3);
    EXPECT_EQ(beside.outcome, Outcome::complete);
    EXPECT_FALSE(beside.inside || beside.outside);
  }
}

TEST(deviation, finds_what_is_missing_and_what_is_too_much) {
  const Surface unit = surface_of(cube(), Scheme::bilinear);
  TriangleSet open = testing::triangles_of(cube());
  std::erase_if(open, [](const oracle::Corners& t) { return t[0][2] == 1 && t[1][2] == 1 && t[2][2] == 1; });
  ASSERT_EQ(open.size(), 10u);
  const Deviation missing = compared(unit, testing::candidate_of(open));
  expect_distance(missing.from_surface, 0.5);
  expect_distance(missing.from_candidate, 0);
  // A speck far away.
  open.push_back({{{0.5, 0.5, 4}, {0.5, 0.5, 4}, {0.5, 0.5, 4}}});
  const Deviation speck = compared(unit, testing::candidate_of(open));
  expect_distance(speck.from_surface, 0.5);
  expect_distance(speck.from_candidate, 3);
  EXPECT_EQ(speck.from_candidate.from.point, (Point3{0.5, 0.5, 4}));
  EXPECT_FALSE(speck.from_candidate.from.at.has_value());
  ASSERT_TRUE(speck.from_surface.from.at.has_value());
  const Point3 there = evaluate(unit, *speck.from_surface.from.at).point;
  const Point3& from = speck.from_surface.from.point;
  EXPECT_LE(std::hypot(there.x - from.x, there.y - from.y, there.z - from.z), 1e-12);
}

TEST(deviation, of_one_triangle_from_another_and_from_points_is_known) {
  oracle::TaggedMesh one;
  one.points = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  one.polygons = {{0, 1, 2}};
  const Surface surface = surface_of(one, Scheme::flat);
  const Deviation above = compared(surface, {{{{0, 0, 2}, {3, 0, 2}, {0, 4, 2}}}});
  expect_distance(above.from_surface, 2);
  expect_distance(above.from_candidate, 2);
  const Deviation dot = compared(surface, {{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}});
  expect_distance(dot.from_surface, 4);
  expect_distance(dot.from_candidate, 0);
  // From the far corner along the long side.
  const Deviation edge = compared(surface, {{{{3, 0, 0}, {0, 4, 0}, {0, 4, 0}}}});
  expect_distance(edge.from_surface, 2.4);
  expect_distance(edge.from_candidate, 0);
}

TEST(deviation, of_a_tessellation_is_small_and_that_of_the_control_mesh_is_known) {
  // The limit of a tetrahedron's vertex, and of the middles of its faces, lies inside.
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    const oracle::TaggedMesh shape = scheme == Scheme::loop
                                         ? oracle::meshes::triangulated(oracle::meshes::cube())
                                         : oracle::meshes::cube();
    const Surface ball = surface_of(shape, scheme);
    double before = 1;
    for (const unsigned level : {2u, 3u, 4u}) {
      const Deviation found = compared(ball,
                                       testing::candidate_of(testing::triangles_of(
                                           subdivided(ball.mesh(), level, true, {.scheme = scheme}))),
                                       1e-4);
      EXPECT_EQ(found.outcome, Outcome::complete);
      EXPECT_LT(found.from_surface.distance.upper, before / 2);
      EXPECT_LE(found.from_candidate.distance.lower, found.from_surface.distance.upper + 0.1);
      before = std::max(found.from_surface.distance.upper, found.from_candidate.distance.upper);
    }
    EXPECT_LT(before, 0.02);
    // A corner of the cube is as far from the surface as the limit of that corner, by symmetry.
    const Deviation cage = compared(ball, triangles(cube()), 1e-5);
    if (scheme == Scheme::catmark) {
      const Point3 corner = evaluate(ball, {.owner = 0, .corner = 0, .u = 0, .v = 0}).point;
      const double off = std::fabs(corner.x - std::round(corner.x));
      expect_distance(cage.from_candidate, std::sqrt(3.0) * off, 1e-5);
    }
    EXPECT_GT(cage.from_candidate.distance.lower, 0.1);
  }
}

// Bent pieces that come back to where they were: corners beside each other have their feet on different sheets of them.
TEST(deviation, is_narrow_where_a_plane_surface_comes_back) {
  oracle::TaggedMesh l;
  l.points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}};
  l.polygons = {{0, 1, 2, 3, 4, 5}};
  for (const Scheme scheme : {Scheme::catmark, Scheme::bilinear}) {
    const Surface surface = surface_of(l, scheme);
    const Tessellation fine = tessellate(surface, {.error = 5e-3});
    std::vector<Triangle> candidate;
    for (const auto& t : fine.triangles)
      candidate.push_back({fine.positions[t[0]], fine.positions[t[1]], fine.positions[t[2]]});
    const Deviation found = deviation(surface, candidate, {}, {.max_splits = 500'000});
    EXPECT_EQ(found.outcome, Outcome::complete);
    EXPECT_LT(found.from_surface.distance.upper, fine.error_bound + 2e-4);
    EXPECT_LT(found.from_candidate.distance.upper, fine.error_bound + 2e-4);
  }
}

TEST(deviation, of_two_surfaces_is_that_of_their_triangles) {
  const Surface unit = surface_of(cube(), Scheme::bilinear),
                other = surface_of(cube(1, {0.25, 0, 0}), Scheme::bilinear);
  const Deviation found = deviation(unit, other, {.absolute = 1e-6});
  expect_distance(found.from_surface, 0.25);
  expect_distance(found.from_candidate, 0.25);
  EXPECT_TRUE(found.from_surface.from.at && found.from_candidate.from.at);
  const Surface ball = surface_of(cube(), Scheme::catmark);
  const Deviation itself = deviation(ball, ball, {.absolute = 1e-4});
  expect_distance(itself.from_surface, 0, 1e-4);
  expect_distance(itself.from_candidate, 0, 1e-4);
}

TEST(deviation, on_each_side_of_a_solid_is_known) {
  const Surface unit = surface_of(cube(), Scheme::bilinear);
  const auto expect_sides = [&](const oracle::TaggedMesh& candidate, double inside, double outside,
                                double precision = 1e-6) {
    const Deviation found = compared(unit, triangles(candidate), precision, true);
    ASSERT_TRUE(found.inside && found.outside);
    expect_distance(*found.inside, inside, precision);
    expect_distance(*found.outside, outside, precision);
    expect_distance(found.from_candidate, std::max(inside, outside), precision);
    EXPECT_EQ(found.outcome, Outcome::complete);
  };
  expect_sides(cube(0.5, {0.25, 0.25, 0.25}), 0.25, 0);
  expect_sides(cube(3, {-1, -1, -1}), 0, std::sqrt(3.0));
  // Faces in the surface: what is near their borders is told late.
  expect_sides(cube(1, {0.25, 0, 0}), 0.25, 0.25, 1e-3);
  expect_sides(cube(1, {5, 0, 0}), 0, 5);
  // The solid is the same if the faces turn the other way.
  oracle::TaggedMesh turned = cube();
  for (auto& face : turned.polygons) std::reverse(face.begin(), face.end());
  const Deviation found =
      compared(surface_of(turned, Scheme::bilinear), triangles(cube(0.5, {0.25, 0.25, 0.25})), 1e-6, true);
  ASSERT_TRUE(found.inside && found.outside);
  expect_distance(*found.inside, 0.25);
  expect_distance(*found.outside, 0);
  const Surface two = surface_of(cube(0.5, {0.25, 0.25, 0.25}), Scheme::bilinear);
  const Deviation surfaces = deviation(unit, two, {.absolute = 1e-6, .solid = true});
  ASSERT_TRUE(surfaces.inside && surfaces.outside);
  expect_distance(*surfaces.inside, 0.25);
  expect_distance(*surfaces.outside, 0);
}

TEST(deviation, answers_a_tolerance_and_no_more) {
  const Surface unit = surface_of(cube(), Scheme::bilinear);
  const std::vector<Triangle> moved = triangles(cube(1, {0.25, 0, 0}));
  for (const double tolerance : {0.0, 1e-9, 0.1, 0.2499, 0.2501, 1.0, 1e9}) {
    DeviationOptions options;
    options.absolute = 1e-6;
    options.threshold = tolerance;
    const Deviation found = deviation(unit, moved, options);
    EXPECT_EQ(found.outcome, Outcome::complete) << tolerance;
    for (const Interval& d : {found.from_surface.distance, found.from_candidate.distance}) {
      EXPECT_TRUE(d.contains(0.25)) << tolerance;
      EXPECT_EQ(d.lower > tolerance, tolerance < 0.25);
      EXPECT_EQ(d.upper <= tolerance, tolerance >= 0.25);
    }
    EXPECT_EQ(found.verdict, tolerance < 0.25 ? DeviationVerdict::exceeds : DeviationVerdict::within);
  }
  // Where nothing is between: the interval, as narrow as it was asked for.
  DeviationOptions options;
  options.absolute = 1e-6;
  options.threshold = 0.25;
  const Deviation found = deviation(unit, moved, options);
  EXPECT_EQ(found.outcome, Outcome::complete);
  EXPECT_TRUE(found.from_surface.distance.contains(0.25));
  EXPECT_EQ(found.verdict, DeviationVerdict::undecided);
  EXPECT_STREQ(name_of(*found.verdict), "undecided");
  // Farther one way than the other: the half of a plate is on it.
  const Surface plate = surface_of(cube(1), Scheme::bilinear);
  const std::vector<Triangle> half{triangles(cube(1))[0]};
  options.threshold = 1e-3;
  const Deviation part = deviation(plate, half, options);
  EXPECT_LE(part.from_candidate.distance.upper, 1e-3);
  EXPECT_EQ(part.verdict, DeviationVerdict::exceeds);
  EXPECT_EQ(deviation(plate, half, {.absolute = 1e-3}).verdict, std::nullopt);
}

TEST(deviation, is_true_with_any_budget) {
  const Surface ball = surface_of(cube(), Scheme::catmark);
  const std::vector<Triangle> candidate =
      testing::candidate_of(testing::triangles_of(subdivided(ball.mesh(), 1, true)));
  const Deviation truth = compared(ball, candidate, 1e-4);
  ASSERT_EQ(truth.outcome, Outcome::complete);
  const auto overlap = [](const Interval& a, const Interval& b) {
    return a.lower <= b.upper && b.lower <= a.upper;
  };
  for (const std::uint64_t budget : {0u, 1u, 2u, 10u, 100u, 1000u, 10000u}) {
    for (const bool solid : {false, true}) {
      DeviationOptions options;
      options.absolute = 1e-4;
      options.solid = solid;
      const Deviation found = deviation(ball, candidate, options, {.max_splits = budget});
      EXPECT_TRUE(overlap(found.from_surface.distance, truth.from_surface.distance)) << budget;
      EXPECT_TRUE(overlap(found.from_candidate.distance, truth.from_candidate.distance)) << budget;
      const bool narrow = found.from_surface.distance.upper - found.from_surface.distance.lower <= 1e-4 &&
                          found.from_candidate.distance.upper - found.from_candidate.distance.lower <= 1e-4;
      EXPECT_TRUE(narrow || found.outcome == Outcome::budget_spent) << budget;
    }
  }
}

TEST(deviation, depends_on_no_threads) {
  const Surface ball = surface_of(cube(), Scheme::catmark);
  const std::vector<Triangle> candidate =
      testing::candidate_of(testing::triangles_of(subdivided(ball.mesh(), 2, true)));
  DeviationOptions options;
  options.absolute = 1e-3;
  options.solid = true;
  const Deviation one = deviation(ball, candidate, options, {.threads = 1});
  for (const int threads : {2, 3, 0}) {
    const Deviation many = deviation(ball, candidate, options, {.threads = threads});
    for (const auto& [a, b] : {std::pair{&one.from_surface, &many.from_surface},
                               {&one.from_candidate, &many.from_candidate},
                               {&*one.inside, &*many.inside},
                               {&*one.outside, &*many.outside}}) {
      EXPECT_EQ(a->distance, b->distance);
      EXPECT_EQ(a->from, b->from);
      EXPECT_EQ(a->to, b->to);
      EXPECT_EQ(a->from.error, b->from.error);
    }
  }
}

TEST(deviation, does_not_depend_on_the_unit) {
  const Surface plain = surface_of(cube(), Scheme::catmark);
  const std::vector<Triangle> candidate = triangles(cube(0.75));
  const Deviation truth = compared(plain, candidate, 1e-4);
  for (const int power : {-1000, -300, 300, 1000}) {
    oracle::TaggedMesh mesh = cube();
    for (oracle::Point& p : mesh.points)
      for (double& x : p) x = std::ldexp(x, power);
    std::vector<Triangle> scaled = candidate;
    for (Triangle& t : scaled)
      for (Point3& p : t)
        for (std::size_t x = 0; x < 3; ++x) p[x] = std::ldexp(p[x], power);
    const Deviation found = compared(surface_of(mesh, Scheme::catmark), scaled, std::ldexp(1e-4, power));
    for (const auto& [a, b] : {std::pair{&truth.from_surface, &found.from_surface},
                               {&truth.from_candidate, &found.from_candidate}}) {
      EXPECT_LE(std::ldexp(b->distance.lower, -power), a->distance.upper);
      EXPECT_GE(std::ldexp(b->distance.upper, -power), a->distance.lower);
    }
    EXPECT_EQ(found.outcome, Outcome::complete);
  }
}

void expect_refused(InputProblem problem, const std::string& text, const std::function<void()>& work) {
  try {
    work();
    ADD_FAILURE() << "no error: " << text;
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), problem) << error.what();
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(deviation, refuses_what_has_no_answer) {
  const Surface unit = surface_of(cube(), Scheme::bilinear);
  const std::vector<Triangle> good = triangles(cube());
  const auto ask = [&](const std::vector<Triangle>& candidate, const DeviationOptions& options) {
    return [&unit, candidate, options] { static_cast<void>(deviation(unit, candidate, options)); };
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  expect_refused(InputProblem::value, "no triangles", ask({}, {}));
  for (const double x : {double{NAN}, infinity, -infinity}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<Triangle> bad = good;
      bad[7][2][axis] = x;
      expect_refused(InputProblem::value, "triangle 7", ask(bad, {}));
    }
    expect_refused(InputProblem::value, "precision", ask(good, {.absolute = x}));
    expect_refused(InputProblem::value, "threshold", ask(good, {.threshold = x}));
  }
  expect_refused(InputProblem::value, "precision", ask(good, {.absolute = 0}));
  expect_refused(InputProblem::value, "precision", ask(good, {.absolute = -1e-3}));
  expect_refused(InputProblem::value, "precision", ask(good, {.absolute = 1e-13}));
  expect_refused(InputProblem::value, "precision",
                 ask(good, {.absolute = std::numeric_limits<double>::denorm_min()}));
  expect_refused(InputProblem::value, "threshold", ask(good, {.threshold = -1e-300}));
  EXPECT_NO_THROW(ask(good, {.threshold = 0})());
  // Coordinates of the candidate count, too.
  expect_refused(InputProblem::value, "precision", ask(triangles(cube(1, {1e9, 0, 0})), {.absolute = 1e-6}));

  oracle::TaggedMesh open = cube();
  open.polygons.pop_back();
  const Surface sheet = surface_of(open, Scheme::bilinear);
  DeviationOptions solid;
  solid.solid = true;
  expect_refused(InputProblem::refused, "closed", [&] { static_cast<void>(deviation(sheet, good, solid)); });
  expect_refused(InputProblem::refused, "closed", [&] { static_cast<void>(deviation(sheet, unit, solid)); });
  // The candidate may be open.
  EXPECT_NO_THROW(static_cast<void>(deviation(unit, sheet, solid)));

  oracle::TaggedMesh quad = oracle::meshes::quad_grid(1, 1);
  const Surface none(testing::control_mesh(quad),
                     {.scheme = Scheme::catmark, .boundary = BoundaryRule::none});
  for (const DeviationOptions& options : {DeviationOptions{}, solid}) {
    expect_refused(InputProblem::refused, "", [&] { static_cast<void>(deviation(none, good, options)); });
    expect_refused(InputProblem::refused, "", [&] { static_cast<void>(deviation(unit, none, options)); });
  }
  // As far apart as no double tells.
  expect_refused(InputProblem::unrepresentable, "", [&] {
    oracle::TaggedMesh mesh = cube(1e307, {1.5e308, 1.5e308, 1.5e308});
    static_cast<void>(deviation(surface_of(mesh, Scheme::bilinear),
                                triangles(cube(1e307, {-1.6e308, -1.6e308, -1.6e308}))));
  });
}

TEST(deviation, can_be_watched_and_stopped) {
  const Surface ball = surface_of(cube(), Scheme::catmark);
  const std::vector<Triangle> candidate = triangles(cube());
  std::atomic<bool> stop{true};
  WorkMonitor stopped;
  stopped.stop = &stop;
  EXPECT_THROW(static_cast<void>(deviation(ball, candidate, {}, {.monitor = &stopped})), Interrupted);
  EXPECT_THROW(static_cast<void>(deviation(ball, ball, {}, {.monitor = &stopped})), Interrupted);
  // In the middle, too; then it is as it was.
  stop = false;
  std::atomic<int> reports{0};
  stopped.on_progress = [&](double done) {
    EXPECT_GE(done, 0);
    EXPECT_LE(done, 1);
    if (++reports == 2) stop = true;
  };
  EXPECT_THROW(static_cast<void>(deviation(ball, candidate, {}, {.monitor = &stopped})), Interrupted);
  stop = false;
  reports = 100;
  EXPECT_EQ(deviation(ball, candidate, {}, {.monitor = &stopped}).outcome, Outcome::complete);
}

}  // namespace
}  // namespace snug::deviation_test
