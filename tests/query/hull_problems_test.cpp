#include <snug/query/hull_check.h>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <testing/hulls.h>
#include <testing/tagged.h>

#include <functional>
#include <set>

namespace snug::hull_problems_test {
namespace {

namespace meshes = oracle::meshes;
using oracle::TaggedMesh;
using testing::both;
using testing::moved;

std::set<HullFault> faults_of(const Surface& surface, const Hulls& hulls, double tolerance) {
  std::set<HullFault> faults;
  for (const HullProblem& p : problems_of(surface, hulls, {.error = tolerance})) {
    faults.insert(p.fault);
  }
  return faults;
}

// The final check of hull() does not know how its hulls were made: it must find their faults.
TEST(hull_problems, of_spoiled_hulls_are_found) {
  const Surface surface(testing::control_mesh(meshes::cube()));
  const double tolerance = 0.02;
  const Hulls good = hull(surface, {.error = tolerance});
  ASSERT_EQ(good.outcome, Outcome::complete);
  EXPECT_TRUE(faults_of(surface, good, tolerance).empty());
  const Point3 centre{0.5, 0.5, 0.5};
  for (const bool inner : {true, false}) {
    const auto spoiled = [&](const std::function<void(Hull&)>& spoil) {
      Hulls bad = good;
      spoil(inner ? *bad.inner : *bad.outer);
      return faults_of(surface, bad, tolerance);
    };
    const auto move = [&](double factor) {
      return spoiled([&](Hull& h) { h.positions[11] = centre + factor * (h.positions[11] - centre); });
    };
    EXPECT_TRUE(move(inner ? 1.1 : 0.9).contains(HullFault::meets_surface));
    EXPECT_TRUE(move(inner ? 0.9 : 1.1).contains(HullFault::no_position));
    EXPECT_TRUE(spoiled([](Hull& h) {
                  std::swap(h.triangles[5][0], h.triangles[5][1]);
                }).contains(HullFault::meets_itself));
    EXPECT_TRUE(spoiled([](Hull& h) {
                  h.triangles.erase(h.triangles.begin() + 5);
                  h.owners.pop_back();
                }).contains(HullFault::not_around));
    EXPECT_TRUE(spoiled([](Hull& h) {
                  h.triangles.push_back(h.triangles[5]);
                  h.owners.push_back(0);
                }).contains(HullFault::meets_itself));
    // A fold: a vertex moved sideways beyond its neighbours.
    EXPECT_TRUE(spoiled([](Hull& h) {
                  const auto [a, b, c] = h.triangles[5];
                  h.positions[a] = h.positions[a] + 2.5 * ((h.positions[b] - h.positions[a]) +
                                                           (h.positions[c] - h.positions[a]));
                }).contains(HullFault::meets_itself));
    // Two vertices at one place.
    EXPECT_TRUE(spoiled([](Hull& h) {
                  h.positions[h.triangles[5][0]] = h.positions[h.triangles[5][1]];
                }).contains(HullFault::meets_itself));
  }
  Hulls swapped = good;
  std::swap(swapped.inner, swapped.outer);
  EXPECT_EQ(faults_of(surface, swapped, tolerance), std::set{HullFault::not_around});
  Hulls equal = good;
  equal.inner = equal.outer;
  EXPECT_EQ(faults_of(surface, equal, tolerance), std::set{HullFault::not_around});
  EXPECT_TRUE(faults_of(surface, good, good.outer->gap / 20).contains(HullFault::no_position));
}

// Those of an open surface are sheets, which may meet on its border's outer side, where it is not between them.
TEST(hull_problems, of_sheets_that_meet_each_other_are_found) {
  const Surface surface(testing::control_mesh(meshes::quad_grid(3, 3)));
  const double tolerance = 0.05;
  Hulls hulls = hull(surface, {.error = tolerance});
  ASSERT_EQ(hulls.outcome, Outcome::complete);
  EXPECT_TRUE(faults_of(surface, hulls, tolerance).empty());
  hulls.inner = hulls.outer;
  EXPECT_EQ(faults_of(surface, hulls, tolerance), std::set{HullFault::meets_other});
}

// The same where the sides of facets are longer than any double.
TEST(hull_problems, of_sheets_that_meet_each_other_are_found_whatever_their_size) {
  for (const double size : {1.0, 0x1p-900, 0x1.8p1023}) {
    ControlMesh mesh;
    mesh.points = {{-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {-size, size, 0}};
    mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2), VertexId(3)});
    const Surface surface(std::move(mesh), {.scheme = Scheme::bilinear});
    const double tolerance = 0.1 * size;
    Hulls hulls = hull(surface, {.error = tolerance});
    ASSERT_EQ(hulls.outcome, Outcome::complete) << size;
    hulls.inner = hulls.outer;
    EXPECT_EQ(faults_of(surface, hulls, tolerance), std::set{HullFault::meets_other}) << size;
  }
}

// A part of a hull that lies on the other side of the surface is found out although the surface is around and inside.
TEST(hull_problems, of_a_component_on_the_wrong_side_are_found) {
  const TaggedMesh mesh = both(meshes::cube(), moved(meshes::cube(), 1, {3, 0, 0}));
  const Surface surface(testing::control_mesh(mesh));
  const double tolerance = 0.05;
  Hulls hulls = hull(surface, {.error = tolerance});
  ASSERT_EQ(hulls.outcome, Outcome::complete);
  for (const bool inner : {true, false}) {
    Hulls bad = hulls;
    Hull& hull = inner ? *bad.inner : *bad.outer;
    // A small closed piece, beside the surface or in it.
    const auto first = static_cast<std::uint32_t>(hull.positions.size());
    const Point3 at = inner ? Point3{-0.01, 0.5, 0.5} : Point3{0.2, 0.5, 0.5};
    for (const Vector3& d : {Vector3{0, 0, 0}, {-1e-3, 0, 0}, {0, 1e-3, 0}, {0, 0, 1e-3}}) {
      hull.positions.push_back(at + d);
    }
    for (const auto& [a, b, c] : {std::array{0u, 1u, 2u}, {0u, 3u, 1u}, {1u, 3u, 2u}, {0u, 2u, 3u}}) {
      hull.triangles.push_back({first + a, first + b, first + c});
      hull.owners.push_back(0);
    }
    EXPECT_TRUE(faults_of(surface, bad, 0.5).contains(HullFault::not_around)) << inner;
  }
}

// Where a surface goes through itself a hull fails, and that is said at once; one that only touches itself may have an inner hull.
TEST(hull_problems, of_a_surface_through_itself_are_where_it_goes_through) {
  const auto two = [](const std::array<double, 3>& apart, Scheme scheme) {
    const TaggedMesh mesh = both(meshes::cube(), moved(meshes::cube(), 1, apart));
    return Surface(testing::control_mesh(mesh), {.scheme = scheme});
  };
  for (const Scheme scheme : {Scheme::catmark, Scheme::bilinear}) {
    const Hulls none = hull(two({0.3, 0.2, 0.1}, scheme), {.error = 0.02});
    EXPECT_EQ(none.outcome, Outcome::at_rounding);
    ASSERT_FALSE(none.problems.empty());
    for (const HullProblem& problem : none.problems) {
      EXPECT_EQ(problem.fault, HullFault::through_itself);
      EXPECT_TRUE(problem.owner.has_value());
    }
  }
  // The cubes are through each other by less than their inner hull is off them; a plate beside them takes a second round.
  TaggedMesh plate = moved(meshes::cube(), 1, {0, 3, 0});
  for (auto& p : plate.points) p[2] *= 0.01;
  const TaggedMesh cubes = both(meshes::cube(), moved(meshes::cube(), 1, {0.995, 0.1, 0.15}));
  const Surface solids(testing::control_mesh(both(cubes, plate)), {.scheme = Scheme::bilinear});
  EXPECT_EQ(hull(solids, {.error = 0.2, .outer = false}).outcome, Outcome::complete);
  EXPECT_EQ(hull(solids, {.error = 0.2}).problems.at(0).fault, HullFault::through_itself);
  const Surface touching = two({1, 0, 0}, Scheme::bilinear);
  EXPECT_EQ(hull(touching, {.error = 0.02, .outer = false}).outcome, Outcome::complete);
  for (const HullProblem& problem : hull(touching, {.error = 0.02, .inner = false}).problems) {
    EXPECT_NE(problem.fault, HullFault::through_itself);
  }
}

}  // namespace
}  // namespace snug::hull_problems_test
