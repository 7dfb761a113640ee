// Contacts whose regions and curves are known: numbers, shapes, options, and that threads change nothing.

#include <snug/contacts.h>
#include <snug/evaluate.h>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <snug/geometry/point_triangle.h>
#include <support/point.h>
#include <testing/tagged.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace snug::contacts_test {
namespace {

namespace meshes = oracle::meshes;

ControlMesh changed(oracle::TaggedMesh mesh, const Vector3& scale, const Vector3& shift) {
  for (oracle::Point& p : mesh.points) {
    p = {p[0] * scale.x + shift.x, p[1] * scale.y + shift.y, p[2] * scale.z + shift.z};
  }
  return testing::control_mesh(mesh);
}

// About the origin.
Surface ball() { return Surface(changed(meshes::cube(), {2, 2, 2}, {-1, -1, -1})); }
Surface plane(double half, std::uint32_t n = 5) {
  const double step = 2 * half / n;
  return Surface(changed(meshes::quad_grid(n, n), {step, step, 1}, {-half, -half, 0}));
}
Surface box(const Vector3& size) {
  ControlMesh mesh = changed(meshes::cube(), size, {});
  sharpen(mesh);
  return Surface(mesh);
}
// A rod along z.
Surface rod(double radius, double half, std::uint32_t n = 6) {
  oracle::TaggedMesh mesh = meshes::prism(n);
  double x = 0, y = 0, low = INFINITY, high = -INFINITY;
  for (const oracle::Point& p : mesh.points) {
    x += p[0] / static_cast<double>(mesh.points.size());
    y += p[1] / static_cast<double>(mesh.points.size());
    low = std::min(low, p[2]);
    high = std::max(high, p[2]);
  }
  for (oracle::Point& p : mesh.points) {
    const double away = std::hypot(p[0] - x, p[1] - y);
    p = {(p[0] - x) * radius / away, (p[1] - y) * radius / away,
         ((p[2] - low) / (high - low) * 2 - 1) * half};
  }
  return Surface(testing::control_mesh(mesh));
}

double length_of(const IntersectionCurve& curve) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i)
    sum += distance(curve.points[i], curve.points[i + 1]);
  return curve.closed ? sum + distance(curve.points.back(), curve.points.front()) : sum;
}

// Up to what points that were computed are off.
bool holds(const Box3& box, const Point3& p) {
  constexpr double e = 1e-11;
  return p.x >= box.lower.x - e && p.x <= box.upper.x + e && p.y >= box.lower.y - e &&
         p.y <= box.upper.y + e && p.z >= box.lower.z - e && p.z <= box.upper.z + e;
}
// Near a point, a segment, or a convex polygon as a fan?
bool holds(const ContactArea& area, const Point3& p) {
  const std::size_t n = area.points.size();
  for (std::size_t k = 0; k == 0 || k + 2 < n; ++k) {
    const Triangle t{area.points[0], area.points[std::min(k + 1, n - 1)],
                     area.points[std::min(k + 2, n - 1)]};
    if (distance_between(p, t, 1).lower <= 1e-11) return true;
  }
  return false;
}
bool listed(const Contacts& found, const Point3& p) {
  for (const IntersectionCurve& curve : found.curves) {
    if (std::any_of(curve.boxes.begin(), curve.boxes.end(),
                    [&](const CurveBox& b) { return holds(b.box, p); }))
      return true;
  }
  return std::any_of(found.areas.begin(), found.areas.end(),
                     [&](const ContactArea& a) { return holds(a, p); }) ||
         std::any_of(found.open.begin(), found.open.end(), [&](const OpenBox& b) { return holds(b.box, p); });
}

TEST(contacts, of_surfaces_apart_or_inside_each_other_there_are_none) {
  const Surface a = ball(), b = rod(0.1, 0.1);
  for (const Vector3& by : {Vector3{9, 0, 0}, Vector3{0, 0, 0}, Vector3{1.2, 1.2, 1.2}}) {
    const Contacts found = contacts(a, b.at(Motion::translation(by)), {.within = 1e-3});
    EXPECT_TRUE(found.exhaustive && found.outcome == Outcome::complete);
    EXPECT_TRUE(found.regions.empty() && found.curves.empty() && found.open.empty());
  }
}

TEST(contacts, of_a_ball_and_a_plane_are_one_closed_curve) {
  const Surface a = ball(), b = plane(2.5);
  for (const double height : {-0.6, -0.17, 0.01, 0.31, 0.7}) {
    const Contacts found = contacts(a, b.at(Motion::translation({0.013, 0.021, height})));
    ASSERT_TRUE(found.exhaustive && found.outcome == Outcome::complete);
    ASSERT_EQ(found.regions.size(), 1u);
    EXPECT_EQ(found.regions[0].verdict, Verdict::intersecting);
    EXPECT_EQ(found.regions[0].distance.upper, 0);
    ASSERT_EQ(found.curves.size(), 1u) << height;
    const IntersectionCurve& curve = found.curves[0];
    EXPECT_TRUE(curve.closed);
    EXPECT_TRUE(curve.proved) << height;
    EXPECT_EQ(curve.boxes.size(), curve.points.size());
    EXPECT_LE(curve.error, 3.1e-3 * 5);  // 0.1 % of the plane's size, three times
    for (const Point3& p : curve.points) {
      EXPECT_NEAR(p.z, height, 1e-9);
      EXPECT_LT(std::hypot(p.x, p.y), 1);
    }
  }
}

// Two cubes on each other: a rectangle, whatever the scheme.
TEST(contacts, of_two_boxes_on_each_other_are_one_polygon) {
  const oracle::TaggedMesh mesh = meshes::cube();
  const Surface bilinear(testing::control_mesh(mesh), {.scheme = Scheme::bilinear}), sharp = box({1, 1, 1});
  for (const Surface& cube : {bilinear, sharp}) {
    for (const std::optional<double> within : {std::optional<double>{}, std::optional(0.0)}) {
      const Contacts found = contacts(cube, cube.at(Motion::translation({0.3, 0.2, 1})), {.within = within});
      EXPECT_TRUE(found.exhaustive && found.outcome == Outcome::complete);
      EXPECT_TRUE(found.curves.empty() && found.open.empty());
      EXPECT_LT(found.stats.splits + found.compared, 1000u);
      ASSERT_EQ(found.regions.size(), 1u);
      EXPECT_EQ(found.regions[0].verdict, Verdict::intersecting);
      ASSERT_EQ(found.areas.size(), 1u);
      EXPECT_EQ(found.areas[0].error, 0);
      ASSERT_EQ(found.areas[0].points.size(), 4u);
      for (const Point3& p : found.areas[0].points)
        EXPECT_TRUE((p.x == 0.3 || p.x == 1) && (p.y == 0.2 || p.y == 1) && p.z == 1);
    }
  }
}

// Copies of a curved surface, and sheets of different squares in one plane: each piece is looked at about once.
TEST(contacts, in_curved_areas_end_soon_in_boxes) {
  const Surface a = ball(), wide = plane(1, 5), narrow = plane(0.8, 7);
  const Motion pose = Motion::rotation({1, 2, 3}, 0.5);
  const Contacts balls = contacts(a.at(pose), a.at(pose), {.within = 0.0}), sheets = contacts(wide, narrow);
  for (const Contacts* const found : {&balls, &sheets}) {
    EXPECT_TRUE(found->exhaustive);
    EXPECT_EQ(found->outcome, Outcome::at_rounding);
    EXPECT_LE(found->open.size(), 5000u);
    EXPECT_EQ(found->regions.size(), 1u);
  }
  EXPECT_LT(balls.compared, 100'000u);
  EXPECT_LT(sheets.compared, 20'000u);
  for (std::uint32_t face = 0; face < 6; ++face) {
    for (double u = 0; u <= 1; u += 0.11) {
      for (double v = 0; v <= 1; v += 0.13)
        EXPECT_TRUE(listed(balls, pose.apply(evaluate(a, {face, 0, u, v}).point)));
    }
  }
  for (std::uint32_t face = 0; face < 49; ++face) {
    for (double u = 0; u <= 1; u += 0.25)
      EXPECT_TRUE(listed(sheets, evaluate(narrow, {face, 0, u, 0.7}).point));
  }
}

// Edges of pieces of the ball lie in the plane.
TEST(contacts, along_edges_of_pieces_are_in_open_boxes) {
  const Surface a = ball(), b = plane(2.5);
  const PlacedSurface placed = b.at(Motion::translation({0.013, 0.021, 0}));
  const Contacts found = contacts(a, placed, {.error = 0.05});
  ASSERT_TRUE(found.exhaustive);
  EXPECT_FALSE(found.open.empty());
  const Contacts above = contacts(a, b.at(Motion::translation({0.013, 0.021, 1e-9})), {.error = 0.05});
  ASSERT_EQ(above.curves.size(), 1u);
  for (const Point3& p : above.curves[0].points) EXPECT_TRUE(listed(found, {p.x, p.y, 0}));
}

// An open tube along z. Cubic splines of a ring of 32 corners are a circle but for 1e-5 of its radius.
Surface tube(std::uint32_t n) {
  oracle::TaggedMesh mesh;
  for (std::uint32_t row = 0; row < 5; ++row) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979 * i / n;
      mesh.points.push_back({std::cos(angle), std::sin(angle), row - 2.0});
      if (row == 0) continue;
      const std::uint32_t next = (i + 1) % n, from = n * (row - 1);
      mesh.polygons.push_back({from + i, from + next, from + n + next, from + n + i});
    }
  }
  return Surface(testing::control_mesh(mesh));
}

TEST(contacts, of_a_round_tube_and_a_plane_are_a_circle) {
  const Surface a = tube(32), b = plane(3);
  const Contacts found = contacts(a, b.at(Motion::translation({0.1, 0.2, 0.05})), {.error = 1e-3});
  ASSERT_EQ(found.curves.size(), 1u);
  EXPECT_TRUE(found.curves[0].closed && found.curves[0].proved);
  const Point3& first = found.curves[0].points[0];
  const double radius = std::hypot(first.x, first.y);
  EXPECT_NEAR(radius, 1 - (1 - std::cos(2 * 3.14159265358979 / 32)) / 3, 1e-4);
  for (const Point3& p : found.curves[0].points) {
    EXPECT_NEAR(std::hypot(p.x, p.y), radius, 2e-5);
    EXPECT_NEAR(p.z, 0.05, 1e-9);
  }
  EXPECT_NEAR(length_of(found.curves[0]), 2 * 3.14159265358979 * radius, 1e-2);
}

TEST(contacts, of_a_thin_rod_through_a_thick_one_are_two_closed_curves_in_two_regions) {
  const Surface thick = rod(1, 3, 8), thin = rod(0.2, 3, 7);
  const Motion across = Motion::rotation({1, 0.1, 0.05}, 1.5);
  const Contacts found = contacts(thick, thin.at(across), {.within = 1e-3});
  EXPECT_EQ(found.regions.size(), 2u);
  ASSERT_EQ(found.curves.size(), 2u);
  for (const IntersectionCurve& curve : found.curves) EXPECT_TRUE(curve.closed && curve.proved);
  EXPECT_NE(found.curves[0].region, found.curves[1].region);
}

TEST(contacts, curves_end_at_the_border) {
  const Surface a = plane(1), b = plane(3);
  const Contacts found =
      contacts(a, b.at(Motion::translation({0.03, 0.05, 0.07}) * Motion::rotation({1, 0.2, 0.1}, 1.2)),
               {.error = 1e-3});
  ASSERT_EQ(found.curves.size(), 1u);
  const IntersectionCurve& curve = found.curves[0];
  EXPECT_FALSE(curve.closed);
  EXPECT_TRUE(curve.proved);
  EXPECT_TRUE(curve.at_border[0] && curve.at_border[1]);
  EXPECT_EQ(curve.boxes.size() + 1, curve.points.size());
}

// Two boxes share the box from `from` to (1, 1, 1); the curve has six of its edges.
TEST(contacts, of_two_sharp_boxes_are_the_polygon_that_is_known) {
  const Surface a = box({1, 1, 1}), b = box({1, 1, 1});
  const Vector3 from{0.3, 0.45, 0.6};
  const Contacts found = contacts(a, b.at(Motion::translation(from)), {.within = 1e-3});
  ASSERT_TRUE(found.exhaustive);
  ASSERT_EQ(found.regions.size(), 1u);
  ASSERT_EQ(found.curves.size(), 1u);
  EXPECT_TRUE(found.curves[0].closed);
  EXPECT_NEAR(length_of(found.curves[0]), 2 * (0.7 + 0.55 + 0.4), 1e-6);
  const Point3 f{from.x, from.y, from.z}, t{1, 1, 1};
  const std::array<Point3, 6> corners{Point3{t.x, f.y, f.z}, {t.x, t.y, f.z}, {f.x, t.y, f.z},
                                      {f.x, t.y, t.z},       {f.x, f.y, t.z}, {t.x, f.y, t.z}};
  for (std::size_t k = 0; k < 6; ++k) {
    for (double s = 0; s <= 1; s += 1.0 / 64) {
      EXPECT_TRUE(listed(found, corners[k] + s * (corners[(k + 1) % 6] - corners[k]))) << k << " " << s;
    }
  }
}

TEST(contacts, of_faces_in_each_other_are_listed) {
  const Surface a = box({1, 1, 1}), b = box({1, 1, 1});
  const Contacts found =
      contacts(a, b.at(Motion::translation({0.25, 0.125, 1})), {.within = 0.0, .error = 0.05});
  ASSERT_TRUE(found.exhaustive);
  ASSERT_EQ(found.regions.size(), 1u);
  EXPECT_NE(found.regions[0].verdict, Verdict::separated);
  for (double x = 0.25; x <= 1; x += 1.0 / 64) {
    for (double y = 0.125; y <= 1; y += 1.0 / 64) EXPECT_TRUE(listed(found, {x, y, 1})) << x << " " << y;
  }
}

// Edges of the one meet edges of the other all along the curve.
TEST(contacts, of_mirrored_surfaces_are_one_closed_curve_with_tiny_gaps) {
  const Surface a = ball();
  const Contacts found = contacts(a, a.at(Motion::translation({0.5, 0, 0})));
  ASSERT_TRUE(found.exhaustive && found.outcome == Outcome::complete);
  ASSERT_EQ(found.curves.size(), 1u);
  EXPECT_TRUE(found.curves[0].closed);
  EXPECT_FALSE(found.curves[0].proved);
  for (const CurveBox& b : found.curves[0].boxes) {
    if (!b.one_arc) {
      EXPECT_LT(longest_side(b.box), 1e-6);
    }
  }
  for (const Point3& p : found.curves[0].points) EXPECT_NEAR(p.x, 0.25, 1e-9);
}

// Two sheets of the same squares, upright to each other: edges meet edges in single points of a line.
TEST(contacts, have_end_boxes_as_small_as_derived_where_edges_meet_edges) {
  const Surface a = plane(2.5);
  ControlMesh upright = a.mesh();
  for (Point3& p : upright.points) p = {p.x, 0, p.y};
  const Contacts found = contacts(a, Surface(std::move(upright)), {.error = 1e-3});
  EXPECT_TRUE(found.exhaustive && found.outcome == Outcome::complete);
  EXPECT_GT(found.open.size(), 10u);
  for (const OpenBox& open : found.open) EXPECT_LT(longest_side(open.box), 1e-10);
}

// A flat sheet whose lower border, between corners of patches at (1, 0.25) and (2, 0.25), lies above the line between
// them: a plane through both meets the patch there at these corners alone.
TEST(contacts, do_not_run_where_a_border_is_hollow) {
  oracle::TaggedMesh mesh = meshes::quad_grid(3, 2);
  for (oracle::Point& p : mesh.points) {
    if (p[1] == 0 && (p[0] == 1 || p[0] == 2)) p[1] = 0.3;
  }
  const Surface a(testing::control_mesh(mesh)), b = plane(5, 3);
  const Motion upright = Motion::translation({0.02, 0.25, 0.01}) * Motion::rotation_degrees({1, 0, 0}, 90);
  // Whole patches are compared.
  const Contacts found = contacts(a, b.at(upright), {.within = 4, .error = 2});
  EXPECT_TRUE(found.exhaustive);
  EXPECT_FALSE(found.curves.empty());
  for (const IntersectionCurve& curve : found.curves) {
    for (std::size_t i = 0; i < curve.boxes.size(); ++i) {
      if (!curve.boxes[i].one_arc) continue;
      const Point3 &p = curve.points[i], &q = curve.points[(i + 1) % curve.points.size()];
      const double x = (p.x + q.x) / 2;
      EXPECT_TRUE(x < 1 || x > 2) << x;
    }
  }
}

TEST(contacts, do_not_depend_on_threads_or_earlier_queries) {
  const Surface a = ball(), b = rod(0.4, 2);
  const PlacedSurface placed = b.at(Motion::rotation({1, 2, 3}, 0.8));
  std::optional<Contacts> first;
  for (const int threads : {1, 2, 5, 1}) {
    const Contacts found = contacts(a, placed, {.error = 1e-3}, {.threads = threads});
    if (!first) first = found;
    ASSERT_EQ(found.curves.size(), first->curves.size());
    for (std::size_t i = 0; i < found.curves.size(); ++i) {
      EXPECT_EQ(found.curves[i].points, first->curves[i].points);
      EXPECT_EQ(found.curves[i].error, first->curves[i].error);
    }
    ASSERT_EQ(found.regions.size(), first->regions.size());
    for (std::size_t i = 0; i < found.regions.size(); ++i) {
      EXPECT_EQ(found.regions[i].box, first->regions[i].box);
      EXPECT_EQ(found.regions[i].witness, first->regions[i].witness);
      EXPECT_EQ(found.regions[i].owners, first->regions[i].owners);
    }
    EXPECT_EQ(found.open.size(), first->open.size());
    EXPECT_EQ(found.compared, first->compared);
  }
}

TEST(contacts, hold_where_the_budget_ends) {
  const Surface a = ball(), b = plane(2.5);
  const PlacedSurface placed = b.at(Motion::translation({0.013, 0.021, 0.3}));
  const Contacts whole = contacts(a, placed);
  for (const std::uint64_t budget : {1u, 10u, 100u, 1000u, 1000000u}) {
    const Contacts found = contacts(a, placed, {}, {.max_splits = budget});
    if (!found.exhaustive) {
      EXPECT_EQ(found.outcome, Outcome::budget_spent);
      continue;
    }
    EXPECT_EQ(found.outcome, budget == 1000000u ? Outcome::complete : Outcome::budget_spent);
    for (const Point3& p : whole.curves[0].points) EXPECT_TRUE(listed(found, p)) << budget;
  }
}

TEST(contacts, have_one_region_for_each_place) {
  const Surface a = ball();
  // Twice inside of the tolerance: a plane beside the ball touches it at one place.
  const Surface b = plane(2.5);
  const Contacts all = contacts(a, b.at(Motion::translation({0.01, 0.02, 0.9})), {.within = 0.2});
  ASSERT_EQ(all.regions.size(), 1u);
  EXPECT_EQ(all.regions[0].verdict, Verdict::within);
  EXPECT_TRUE(all.curves.empty());
  const ContactRegion& region = all.regions[0];
  EXPECT_LE(distance(region.witness[0].point, region.witness[1].point), 0.2);
  EXPECT_LE(region.distance.lower, distance(region.witness[0].point, region.witness[1].point));
  EXPECT_TRUE(region.witness[0].at && region.witness[1].at);
}

TEST(contacts, of_a_flat_sheet_and_itself_are_complete) {
  const Surface a = plane(1);
  const Contacts found = contacts(a, a, {.within = 0.0, .error = 0.02}, {.max_splits = 5000});
  EXPECT_TRUE(found.exhaustive);
  EXPECT_NE(found.outcome, Outcome::complete);
  EXPECT_TRUE(found.curves.empty());
  for (double x = -0.9; x < 0.9; x += 0.07) EXPECT_TRUE(listed(found, {x, x / 2, 0}));
}

TEST(contacts, refuse_bad_lengths) {
  const Surface a = ball();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1.0, nan, double{INFINITY}}) {
    EXPECT_THROW(static_cast<void>(contacts(a, a, {.within = bad})), InputError);
    EXPECT_THROW(static_cast<void>(contacts(a, a, {.error = bad})), InputError);
  }
  EXPECT_THROW(static_cast<void>(contacts(a, a, {.error = 0.0})), InputError);
}

TEST(contacts, can_do_without_curves) {
  const Surface a = ball(), b = rod(0.4, 2);
  const Contacts found = contacts(a, b.at(Motion::rotation({1, 2, 3}, 0.8)), {.curves = false});
  EXPECT_TRUE(found.exhaustive);
  EXPECT_TRUE(found.curves.empty() && found.open.empty());
  EXPECT_EQ(found.compared, 0u);
  for (const ContactRegion& region : found.regions) EXPECT_EQ(region.verdict, Verdict::intersecting);
}

// Where edges cross at round places, boxes stay open, and a curve may go through one that is coarser than asked.
TEST(contacts, are_complete_only_if_curves_are_as_fine_as_asked) {
  // A plane face and a bent one; two plane ones have exact curves.
  const Surface box(testing::control_mesh(meshes::cube()), {.scheme = Scheme::bilinear});
  const Surface ball(testing::control_mesh(meshes::cube()), {.scheme = Scheme::catmark});
  int coarse = 0;
  for (const double x : {0.5, 0.3, 0.75}) {
    for (const double error : {0.01, 0.03}) {
      const Contacts found =
          contacts(box, {ball, Motion::translation({x, 0.5, 0.7})}, {.within = error, .error = error});
      double largest = 0;
      for (const IntersectionCurve& curve : found.curves) {
        for (const CurveBox& part : curve.boxes) {
          for (std::size_t k = 0; k < 3 && !part.one_arc; ++k)
            largest = std::max(largest, part.box.upper[k] - part.box.lower[k]);
        }
      }
      if (largest <= 1.001 * error || found.outcome == Outcome::budget_spent) continue;
      ++coarse;
      EXPECT_EQ(found.outcome, Outcome::at_rounding) << x << " within " << error;
    }
  }
  EXPECT_GT(coarse, 0);
}

// Halves of faces that touch, of which no pieces have overlapping boxes.
TEST(contacts, of_narrow_faces_that_touch_at_a_corner_fit_doubles) {
  const auto triangle = [](std::array<Point3, 3> points) {
    ControlMesh mesh;
    mesh.points.assign(points.begin(), points.end());
    mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
    return Surface(mesh, {.scheme = Scheme::bilinear});
  };
  const Surface a = triangle({Point3{0, -1, 0}, {0, 0, 0}, {-1, 1, 0}}),
                b = triangle({Point3{0, 0, 0}, {-1, 1, 0}, {0, -1e-6, -1e-6}});
  for (const bool curves : {true, false}) {
    const Contacts found = contacts(a, b, {.within = 0, .curves = curves});
    ASSERT_EQ(found.areas.size(), 1u);
    EXPECT_EQ(found.areas[0].points.size(), 2u) << "the edge from 0 0 0 to -1 1 0";
    for (const ContactRegion& region : found.regions) EXPECT_TRUE(std::isfinite(region.distance.upper));
  }
}

}  // namespace
}  // namespace snug::contacts_test
