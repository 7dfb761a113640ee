// First times of contact where control points move, against limit points of the twins, which go along lines too: two of
// them are brought together at a known time, of every scheme, tag and way to deform; walls and boxes have known times.

#include <snug/time_of_contact.h>

#include <gtest/gtest.h>
#include <snug/search/crossing.h>
#include <support/error.h>
#include <testing/cad_parts.h>
#include <testing/counts.h>
#include <testing/deformations.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

namespace snug::deforming_contact_test {
namespace {

using testing::Body;
using testing::deformed;
using testing::random_placement;
using testing::random_vector;
using testing::Shape;
using testing::shapes;
using testing::Tally;
using testing::translated;
using testing::unit;
using testing::way_count;

TEST(deforming_contact, is_not_later_than_points_that_meet) {
  Tally tally = testing::points_that_meet(21, testing::trials(36), 100'000);
  tally.print();
  EXPECT_GT(tally.sharp, static_cast<int>(tally.looks.size() / 2));
  EXPECT_LE(tally.median(), 20);
}

// A surface of flat faces before a wall meets it with a vertex, at the least of the times at which these are in its
// plane; a curved one not later than any limit point.
TEST(deforming_contact, with_a_wall_is_that_of_the_first_point) {
  std::mt19937_64 random(22);
  const std::vector<Shape> all = shapes(32);
  Tally tally;
  int proved = 0, misses = 0;
  for (std::size_t trial = 0; trial < testing::trials(90); ++trial) {
    const Shape& shape = all[random() % all.size()];
    const bool flat = trial % 3 != 0;
    SchemeOptions options = shape.options;
    ControlMesh mesh = shape.mesh;
    if (flat) {
      mesh = ControlMesh{};
      const oracle::TaggedMesh plain =
          oracle::meshes::triangulated(oracle::meshes::prism(3 + static_cast<std::uint32_t>(trial % 5)));
      mesh = testing::control_mesh(oracle::meshes::shaken(plain, 0.2, random));
      options = {Scheme::flat};
    }
    const double far = 3 + unit(random);
    mesh.points = translated(mesh.points, {far, 0, 0});
    std::vector<Point3> end = deformed(mesh.points, static_cast<int>(trial % way_count), random);
    end = translated(end, {random() % 5 == 0 ? 0.0 : -2 - 4 * unit(random), unit(random), 0});
    // The wall's front comes from x = 0 to x = ahead, and its sides go apart.
    const double ahead = random() % 2 ? 0 : unit(random);
    const ControlMesh wall_mesh = testing::box({-1, -6, -6}, {0, 6, 6}, true);
    std::vector<Point3> wall_end = wall_mesh.points;
    for (Point3& p : wall_end) p = {p.x + ahead, 1.5 * p.y, 1.5 * p.z};
    const Surface surface = testing::public_surface(mesh, options), wall(wall_mesh, {.scheme = Scheme::flat});
    std::vector<Point3> first = mesh.points, last = end;
    if (!flat) {
      first = shape.sample(testing::with_points(shape.twin, mesh.points));
      last = shape.sample(testing::with_points(shape.twin, end));
    }
    long double exact = INFINITY;
    for (std::size_t v = 0; v < first.size(); ++v) {
      const long double gap = first[v].x, closing = gap - (static_cast<long double>(last[v].x) - ahead);
      if (closing >= gap) exact = std::min(exact, gap / closing);
    }
    const double tolerance = trial % 2 ? 1e-3 : 1e-5;
    const TimeOfContact found = time_of_contact({wall, wall_end}, {surface, end}, {.tolerance = tolerance});
    const std::string what = "trial " + std::to_string(trial) + (flat ? "" : ": " + shape.name);
    tally.add(found);
    if (!(exact <= 1)) {
      ++misses;
      if (flat) {
        EXPECT_NE(found.verdict, Verdict::intersecting) << what;
      }
      continue;
    }
    const auto met = static_cast<double>(exact);
    ASSERT_NE(found.verdict, Verdict::separated) << what << ", meets at " << met;
    ASSERT_LE(found.time.lower, met * (1 + 1e-15)) << what;
    if (!flat) continue;
    if (found.verdict == Verdict::intersecting) {
      ++proved;
      EXPECT_GE(found.time.upper, met * (1 - 1e-12)) << what;
    }
    // Within the tolerance no later than it meets, and not long before.
    EXPECT_EQ(found.outcome, Outcome::complete) << what;
    EXPECT_LE(found.time.lower, met) << what;
  }
  tally.print();
  std::cout << "  " << proved << " proved, " << misses << " miss\n";
  EXPECT_GT(proved, testing::share(20));
  EXPECT_GT(misses, testing::share(4));
  EXPECT_LE(tally.median(), 20);
}

TEST(deforming_contact, that_is_a_translation_is_that_of_the_translation) {
  std::mt19937_64 random(23);
  for (int trial = 0; trial < 40; ++trial) {
    const ControlMesh mesh_a = testing::l_prism(true), mesh_b = testing::box({0, 0, 0}, {1, 2, 1.5}, true);
    const Surface a(mesh_a, {.scheme = Scheme::flat}), b(mesh_b, {.scheme = Scheme::flat});
    const Vector3 from = random_vector(random, 6), by = -2 * from;
    const Motion pose = random_placement(random, from);
    const TimeOfContact rigid =
        time_of_contact(a, Motion(), b, Trajectory::steady(pose, {by, {0, 0, 1}, 0, {}}));
    std::vector<Point3> end;
    const Motion back = pose.with_offset({}).inverse();
    for (const Point3& p : mesh_b.points) end.push_back(p + back.rotate(by));
    const TimeOfContact found = time_of_contact({a}, {b, end, pose});
    EXPECT_EQ(found.verdict, rigid.verdict);
    EXPECT_LE(found.time.lower, rigid.time.upper + 1e-12);
    // Within the tolerance they may be before they meet: pairs that are followed through time pass by that.
    if (found.verdict == Verdict::intersecting) {
      EXPECT_LE(rigid.time.lower, found.time.upper + 1e-12);
    }
  }
}

// Boxes with these corners at first and at the end.
struct Boxes {
  TimeOfContact ask(const TimeOfContactOptions& options = {}) const {
    const Surface a(first_a, {.scheme = Scheme::flat}), b(first_b, {.scheme = Scheme::flat});
    return time_of_contact({a, last_a.points}, {b, last_b.points}, options);
  }
  ControlMesh first_a, last_a, first_b, last_b;
};
ControlMesh cube(double half, const Vector3& at = {}) {
  return testing::box(Point3{-half, -half, -half} + at, Point3{half, half, half} + at, true);
}

TEST(deforming_contact, of_one_that_grows_inside_the_other_is_known) {
  // Halves from 0.2 to 2 in a cube of halves 1: faces come to lie in faces when 0.2 + 1.8 s = 1.
  const Boxes grows{cube(1), cube(1), cube(0.2), cube(2)};
  const double exact = 0.8 / 1.8;
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const TimeOfContact found = grows.ask({.tolerance = tolerance});
    EXPECT_LE(found.time.lower, exact + 1e-15);
    EXPECT_GE(found.time.upper, exact - tolerance);
    EXPECT_EQ(found.outcome, Outcome::complete);
    EXPECT_LE(found.steps, 40);
  }
  const TimeOfContact solid = grows.ask({.solid = true});
  EXPECT_EQ(solid.verdict, Verdict::intersecting);
  EXPECT_EQ(solid.time.upper, 0);
  EXPECT_EQ(solid.contained, 1u);
  // It may shrink into nothing, or turn inside out, and never meets the wall.
  EXPECT_EQ((Boxes{cube(1), cube(1), cube(0.5), cube(0)}.ask().verdict), Verdict::separated);
  EXPECT_EQ((Boxes{cube(1), cube(1), cube(0.5), cube(-0.5)}.ask().verdict), Verdict::separated);
  // Both grow alike, side by side and one in the other.
  EXPECT_EQ((Boxes{cube(1), cube(2), cube(0.9), cube(1.8)}.ask({.tolerance = 1e-3}).verdict),
            Verdict::separated);
  EXPECT_EQ(
      (Boxes{cube(1), cube(2), cube(1, {2.1, 0, 0}), cube(2, {4.2, 0, 0})}.ask({.tolerance = 1e-3}).verdict),
      Verdict::separated);
}

// Curved faces that come to lie in each other are too near each other for the budget before they are within the tolerance.
TEST(deforming_contact, has_an_upper_end_where_surfaces_come_to_lie_in_each_other) {
  const auto round = [](double half) {
    return testing::box({-half, -half, -half}, {half, half, half}, false);
  };
  const Surface a(round(1), {.scheme = Scheme::catmark}), b(round(0.1), {.scheme = Scheme::catmark});
  const std::vector<Point3> end = round(3).points;
  for (const std::uint64_t budget : {60'000u, 400'000u}) {
    const TimeOfContact found =
        time_of_contact({a}, {.surface = b, .end = end}, {.tolerance = 2e-3}, {.max_splits = budget});
    EXPECT_LE(found.time.lower, 0.9 / 2.9);
    EXPECT_NE(found.verdict, Verdict::undecided);
    EXPECT_GE(found.time.upper, 0.9 / 2.9 - 1e-3);
    EXPECT_LE(found.time.upper, 0.9 / 2.9 + 0.05);
  }
}

TEST(deforming_contact, of_public_surfaces_is_the_same_again_and_again) {
  const Surface a(cube(1), {.scheme = Scheme::flat}), b(cube(0.5, {3, 0.1, 0.2}), {.scheme = Scheme::flat});
  const std::vector<Point3> end = cube(1.5, {3, 0.1, 0.2}).points;
  // The front of B goes from x = 2.5 to 1.5, and by its motion to 0.5.
  const Trajectory motion = Trajectory::steady({}, {{-1, 0, 0}, {0, 0, 1}, 0, {}});
  EXPECT_EQ(time_of_contact({a}, {.surface = b, .end = end}).verdict, Verdict::separated);
  const TimeOfContact found = time_of_contact({a}, {b, end, motion}, {.tolerance = 1e-4});
  EXPECT_EQ(found.verdict, Verdict::intersecting);
  EXPECT_LE(found.time.lower, 0.75);
  EXPECT_GE(found.time.upper, 0.75 - 1e-12);
  EXPECT_LE(found.time.upper, 0.75 + 1e-3);
  const TimeOfContact again = time_of_contact({b, end, motion}, {a}, {.tolerance = 1e-4});
  EXPECT_LE(again.time.lower, 0.75);
  EXPECT_GE(again.time.upper, 0.75 - 1e-12);
  Workspace other;
  const TimeOfContact same =
      time_of_contact({a}, {b, end, motion}, {.tolerance = 1e-4}, {.workspace = &other});
  EXPECT_EQ(same.time, found.time);
  EXPECT_EQ(same.steps, found.steps);
}

TEST(deforming_contact, of_solids_apart_at_first_is_that_of_their_surfaces) {
  // The front of B, at x = 3, comes to x = 0; a corner of A to x = 1.5.
  Boxes boxes{cube(1), cube(1), cube(1, {4, 0.1, 0.2}), cube(1, {1, 0.1, 0.2})};
  for (const bool solid : {false, true}) {
    const TimeOfContact found = boxes.ask({.tolerance = 1e-4, .solid = solid});
    EXPECT_LE(found.time.lower, 2.0 / 3);
    EXPECT_GE(found.time.upper, 2.0 / 3 - 1e-4);
    EXPECT_LE(found.time.upper, 2.0 / 3 + 1e-3);
    EXPECT_EQ(found.outcome, Outcome::complete);
    EXPECT_EQ(found.verdict, Verdict::intersecting);
  }
}

TEST(deforming_contact, that_touches_at_the_end_alone_or_passes_closely_is_told_apart) {
  const auto to = [](double x) {
    return Boxes{cube(1), cube(1), cube(0.5, {3, 0, 0}), cube(0.5, {x, 0, 0})};
  };
  EXPECT_NE(to(1.5).ask({.tolerance = 1e-6}).verdict, Verdict::separated);
  EXPECT_LE(to(1.5).ask({.tolerance = 1e-6}).time.lower, 1);
  EXPECT_EQ(to(1.5 + 1e-9).ask({.tolerance = 1e-10}).verdict, Verdict::separated);
  // Past a face at a small distance.
  const Boxes past{cube(1), cube(1), cube(0.5, {-3, 0, 1.5 + 1e-4}), cube(0.5, {3, 0, 1.5 + 1e-4})};
  const TimeOfContact found = past.ask({.tolerance = 1e-6});
  EXPECT_NE(found.verdict, Verdict::intersecting);
  std::cout << "  past: " << found.steps << " looks, " << static_cast<int>(found.verdict) << '\n';
}

// Down there pieces keep their size beside the origin alone.
TEST(deforming_contact, may_ask_for_crossings_of_pieces_at_the_last_levels) {
  ControlMesh mesh = testing::control_mesh(oracle::meshes::triangulated(oracle::meshes::pyramid(7)));
  BoundingPoints scratch;
  for (int round = 0; round < 3; ++round) {
    // Vertex 0, the apex, is a corner of face 0: its limit point comes to the origin.
    const LimitSurface surface(mesh, {Scheme::loop}, std::make_shared<BoundsCache>());
    Piece piece = make_piece(surface.library(), PatchId(0), surface.patch(PatchId(0)), scratch);
    const std::span<const VertexId> face = mesh.face(FaceId(0));
    const auto apex = static_cast<unsigned>(std::find(face.begin(), face.end(), VertexId(0)) - face.begin());
    ASSERT_LT(apex, 3u);
    const Point3 at = surface.scale().inverse().apply(limit_triangle(piece.patch).corners[apex]);
    for (unsigned level = 0; level < PiecePath::max_level; ++level) {
      piece = child_of(surface.library(), piece, apex, scratch);
      const CrossingTest crossed(piece, heights_of(piece, scratch));
      EXPECT_FALSE(crossed.possible() && crossed.holds(piece.offset.base, piece.offset.radius)) << level;
    }
    for (Point3& p : mesh.points) p = p - (at - Point3{});
  }
}

TEST(deforming_contact, says_what_it_cannot_do) {
  const ControlMesh mesh = cube(1);
  const Surface a(mesh, {.scheme = Scheme::flat});
  const auto refusal = [&](const std::vector<Point3>& end,
                           const Trajectory& motion = Motion()) -> std::string {
    try {
      static_cast<void>(time_of_contact({a}, {a, end, motion}));
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  std::vector<Point3> end = mesh.points;
  EXPECT_EQ(refusal(end), "");
  end.pop_back();
  EXPECT_NE(refusal(end).find("not 7: give a point for each"), std::string::npos) << refusal(end);
  end.push_back({0, std::numeric_limits<double>::quiet_NaN(), 0});
  EXPECT_NE(refusal(end).find("vertex 7 has a coordinate that is not finite"), std::string::npos)
      << refusal(end);
  end.back() = {1e308, 0, 0};
  EXPECT_NE(refusal(end).find("do not fit doubles"), std::string::npos) << refusal(end);
  const Trajectory path = Trajectory::through(
      std::vector<Motion>{Motion(), Motion::translation({1, 0, 0}), Motion::translation({2, 0, 0})});
  EXPECT_NE(refusal(mesh.points, path).find("one unit of time where control points move"), std::string::npos);
}

}  // namespace
}  // namespace snug::deforming_contact_test
