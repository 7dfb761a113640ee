// Parts from CAD: what sharpen() makes of them has the limit surface that it says, and the distances that
// exact ones have.
//
//   SNUG_PARTS=10000 build/release/bin/tests/sharp_parts_test

#include <snug/distance.h>
#include <snug/evaluate.h>

#include <gtest/gtest.h>
#include <snug/mesh/split_polygon.h>
#include <testing/cad_parts.h>
#include <testing/counts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "testing/verdict_only.h"

namespace snug::sharp_parts_test {
namespace {

using Real = long double;
using Place = std::array<Real, 3>;

std::size_t trials(std::size_t usual) { return testing::number_of("SNUG_PARTS", usual); }

Surface surface_of(ControlMesh mesh) {
  const Scheme scheme = natural_scheme(mesh);
  return Surface(std::move(mesh), {.scheme = scheme, .boundary = BoundaryRule::edge_and_corner});
}

Place place(const Point3& p) { return {p.x, p.y, p.z}; }
Place minus(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Real dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Place on_line(const Place& a, const Place& d, Real t) {
  return {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
}
Real length(const Place& a) { return std::sqrt(dot(a, a)); }

Real segment_distance(const Place& p, const Place& a, const Place& b) {
  const Place d = minus(b, a);
  const Real size = dot(d, d), t = size > 0 ? std::clamp(dot(minus(p, a), d) / size, Real{0}, Real{1}) : 0;
  return length(minus(p, on_line(a, d, t)));
}

using Corners = std::array<Place, 3>;

/// Where the line a + t d meets the triangle's inside, or nothing.
std::optional<Real> hit(const Place& a, const Place& d, const Corners& t) {
  const Place u = minus(t[1], t[0]), v = minus(t[2], t[0]), n = cross(u, v);
  const Real slope = dot(d, n);
  if (slope == 0) return {};
  const Real at = dot(minus(t[0], a), n) / slope;
  const Place p = on_line(a, d, at);
  for (std::size_t k = 0; k < 3; ++k) {
    if (dot(cross(minus(t[(k + 1) % 3], t[k]), minus(p, t[k])), n) < 0) return {};
  }
  return at;
}

Real point_distance(const Place& p, const Corners& t) {
  Real least = INFINITY;
  for (std::size_t k = 0; k < 3; ++k) least = std::min(least, segment_distance(p, t[k], t[(k + 1) % 3]));
  const Place n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  const Real size = length(n);
  if (size > 0 && hit(p, n, t)) least = std::min(least, std::fabs(dot(minus(p, t[0]), n)) / size);
  return least;
}

Real edge_distance(const Place& a, const Place& b, const Place& c, const Place& d) {
  Real least = std::min({segment_distance(a, c, d), segment_distance(b, c, d), segment_distance(c, a, b),
                         segment_distance(d, a, b)});
  const Place u = minus(b, a), v = minus(d, c), w = minus(a, c), n = cross(u, v);
  const Real size = dot(n, n);
  if (size > 0) {
    const Real s = dot(cross(v, w), n) / size, t = dot(cross(u, w), n) / size;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, std::fabs(dot(w, n)) / std::sqrt(size));
  }
  return least;
}

Real triangle_distance(const Corners& s, const Corners& t) {
  Real least = INFINITY;
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min({least, point_distance(s[i], t), point_distance(t[i], s)});
    for (std::size_t k = 0; k < 3; ++k) {
      least = std::min(least, edge_distance(s[i], s[(i + 1) % 3], t[k], t[(k + 1) % 3]));
    }
    const auto meets = [](const Place& a, const Place& b, const Corners& triangle) {
      const auto at = hit(a, minus(b, a), triangle);
      return at && *at >= 0 && *at <= 1;
    };
    if (meets(s[i], s[(i + 1) % 3], t) || meets(t[i], t[(i + 1) % 3], s)) return 0;
  }
  return least;
}

/// The faces as triangles of their own: polygons as convex fans.
std::vector<Corners> triangles(const ControlMesh& mesh) {
  std::vector<Corners> list;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
      list.push_back({place(mesh.points[face[0].index()]), place(mesh.points[face[k].index()]),
                      place(mesh.points[face[k + 1].index()])});
    }
  }
  return list;
}

/// The distance of two polyhedra, every pair of triangles.
Real polyhedron_distance(const std::vector<Corners>& a, const std::vector<Corners>& b) {
  Real least = INFINITY;
  for (const Corners& s : a) {
    for (const Corners& t : b) least = std::min(least, triangle_distance(s, t));
  }
  return least;
}

Distance distance_of(const Surface& a, const Surface& b, const Vector3& move = {}) {
  return distance(a, b.at(Motion::translation(move)), {.absolute = 1e-10, .relative = 0});
}

Collision collision_of(const Surface& a, const Surface& b, const Vector3& move, double tolerance) {
  CollideOptions options = testing::verdict_only();
  options.tolerance = tolerance;
  options.prove_contact = true;
  return collide(a, b.at(Motion::translation(move)), options);
}

Surface sharp(ControlMesh mesh, double angle = default_sharp_angle) {
  sharpen(mesh, angle);
  return surface_of(std::move(mesh));
}

template <class Random>
ControlMesh random_part(Random& random, bool triangles) {
  const auto length = [&] { return std::uniform_real_distribution<double>(0.5, 4)(random); };
  switch (random() % 4) {
    case 0:
      return testing::box({0, 0, 0}, {length(), length(), length()}, triangles);
    case 1:
      return testing::l_prism(triangles);
    case 2:
      return testing::pin(length(), 0, length(), 6 + random() % 40, triangles);
    default:
      return testing::perforated_plate(1 + random() % 2, 1, 3, 1, length() / 4, 8 + 4 * (random() % 6));
  }
}

/// Calls visit(face, limit point) on a lattice of every triangle or quad.
template <class Visit>
void for_each_sample(const Surface& surface, int steps, Visit&& visit) {
  for (std::uint32_t face = 0; face < surface.owner_count(); ++face) {
    for (std::uint32_t corner = 0; corner < surface.corner_count(face); ++corner) {
      for (int i = 0; i <= steps; ++i) {
        for (int k = 0; k <= (surface.traits().triangular ? steps - i : steps); ++k) {
          const snug::Place at{face, corner, static_cast<double>(i) / steps, static_cast<double>(k) / steps};
          visit(FaceId(face), evaluate(surface, at).point);
        }
      }
    }
  }
}

Real distance_to_face(const ControlMesh& mesh, FaceId f, const Point3& p) {
  const auto face = mesh.face(f);
  Real least = INFINITY;
  for (std::size_t k = 1; k + 1 < face.size(); ++k) {
    least = std::min(least, point_distance(place(p), {place(mesh.points[face[0].index()]),
                                                      place(mesh.points[face[k].index()]),
                                                      place(mesh.points[face[k + 1].index()])}));
  }
  return least;
}

TEST(sharp_parts, every_limit_point_lies_on_its_face_and_every_face_is_covered) {
  std::mt19937_64 random(11);
  for (std::size_t trial = 0; trial < trials(36); ++trial) {
    const bool triangles = trial % 2 == 0, floats = trial % 3 == 0;
    ControlMesh part =
        testing::turned(random_part(random, triangles), random, floats, trial % 5 == 0 ? 50 : 0);
    const Surface surface = sharp(std::move(part));
    EXPECT_EQ(limit_to_faces(surface), 0.0);
    const double slack = floats && !triangles ? 1e-4 : 1e-11;  // polygons with rounded corners are no planes
    for_each_sample(surface, 5, [&](FaceId f, const Point3& p) {
      ASSERT_LE(distance_to_face(surface.mesh(), f, p), slack) << trial << ", face " << f.value();
    });
    if (surface.scheme() != Scheme::loop || trial % 4 != 0) continue;
    // The point at (u, v) of a triangle is that very point: all of it is covered.
    for (std::uint32_t f = 0; f < surface.mesh().face_count(); ++f) {
      const auto face = surface.mesh().face(FaceId(f));
      const Point3 &a = surface.mesh().points[face[0].index()], &b = surface.mesh().points[face[1].index()],
                   &c = surface.mesh().points[face[2].index()];
      for (const auto& [u, v] :
           {std::pair(0.25, 0.25), std::pair(0.7, 0.2), std::pair(0.1, 0.05), std::pair(0.0, 0.4)}) {
        const Point3 flat = a + (u * (b - a) + v * (c - a));
        ASSERT_LE(distance(evaluate(surface, {f, 0, u, v}).point, flat), 1e-12) << trial;
      }
    }
  }
}

// Boundary points of a face, walked around once by the limit of its edges: with all points inside, it is
// covered.
TEST(sharp_parts, polygons_of_catmull_clark_end_at_their_edges) {
  const Surface surface = sharp(testing::pin(3, 0, 1, 11, false));
  const ControlMesh& mesh = surface.mesh();
  for (std::uint32_t f = 0; f < 2; ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::uint32_t k = 0; k < face.size(); ++k) {
      const Point3 a = mesh.points[face[k].index()], b = mesh.points[face[(k + 1) % face.size()].index()];
      for (const double u : {0.0, 0.3, 1.0}) {
        EXPECT_LE(distance(evaluate(surface, {f, k, u, 0}).point, a + (u / 2) * (b - a)), 1e-13);
      }
    }
  }
}

// Without the edges inside: the limit surface leaves the face through its notch.
TEST(sharp_parts, an_outline_alone_does_not_hold_a_flat_face) {
  ControlMesh outline =  // fans around (0, 0)
      testing::prism({{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}, 0, 1, true, 0);
  ControlMesh all = outline;
  sharpen(all);
  for (const CreaseTag& tag : all.tags.creases) {  // vertices 0 to 5 go around below, 6 to 11 above
    const std::uint32_t a = tag.a.value() % 6, b = tag.b.value() % 6;
    if (a == b || (a + 1) % 6 == b || (b + 1) % 6 == a) outline.tags.creases.push_back(tag);
  }
  for (std::size_t v = 0; v < outline.vertex_count(); ++v) outline.tags.corners.push_back({VertexId(v), 10});
  const auto into_notch = [](const Surface& surface) {
    double most = -INFINITY;
    for_each_sample(surface, 24, [&](FaceId, const Point3& p) {
      if (p.z > 1 - 1e-9) most = std::max(most, std::min(p.x, p.y) - 2);
    });
    return most;
  };
  EXPECT_LE(into_notch(surface_of(all)), 1e-15);
  EXPECT_GE(into_notch(surface_of(outline)), 0.05);
}

TEST(sharp_parts, distances_are_those_of_the_polyhedra) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> anywhere(-9, 9);
  std::size_t apart = 0, short_of_it = 0;
  for (std::size_t trial = 0; trial < trials(40); ++trial) {
    const bool floats = trial % 4 < 2;
    ControlMesh part[2];
    for (ControlMesh& p : part) {
      p = testing::turned(random_part(random, trial % 2 == 0 || floats), random, floats);
      sharpen(p);
    }
    const Vector3 move{anywhere(random), anywhere(random), anywhere(random)};
    for (Point3& p : part[1].points) p = p + move;
    const Real truth = polyhedron_distance(triangles(part[0]), triangles(part[1]));
    const Distance found = distance_of(surface_of(part[0]), surface_of(part[1]));
    EXPECT_LE(found.distance.lower, truth + 1e-15) << trial;
    EXPECT_GE(found.distance.upper, truth - 1e-15) << trial;
    EXPECT_NEAR(static_cast<double>(found.distance.lower - truth), 0, 1e-9) << trial;
    EXPECT_TRUE(found.outcome != Outcome::complete || found.distance.upper - found.distance.lower <= 1e-9)
        << trial;
    short_of_it += found.outcome != Outcome::complete;
    apart += truth > 0;
  }
  EXPECT_GT(apart, trials(40) / 4);
  EXPECT_LE(short_of_it, trials(40) / 50);
}

TEST(sharp_parts, boxes_a_unit_in_the_last_place_apart_have_their_exact_distance) {
  std::mt19937_64 random(13);
  for (std::size_t trial = 0; trial < trials(60); ++trial) {
    // Gaps along one, two or three axes: exact in long double, so close are the doubles that they come from.
    const std::size_t axes = 1 + trial % 3;
    Point3 low_a, high_a, low_b, high_b;
    Real sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low_a[axis] = 0;
      high_a[axis] = std::uniform_real_distribution<double>(1, 40)(random);
      low_b[axis] = axis < axes ? high_a[axis] + (trial % 2 == 0 ? 1.0 : 0x1p-20) : high_a[axis] / 2;
      if (axis < axes && trial % 4 > 1)
        low_b[axis] = std::nextafter(low_b[axis], random() % 2 ? INFINITY : 0);
      high_b[axis] = low_b[axis] + 5;
      const Real gap = axis < axes ? Real{low_b[axis]} - Real{high_a[axis]} : 0;
      sum += gap * gap;
    }
    for (const bool triangles : {true, false}) {
      const Distance found = distance_of(sharp(testing::box(low_a, high_a, triangles)),
                                         sharp(testing::box(low_b, high_b, triangles)));
      const Real truth = std::sqrt(sum);
      EXPECT_LE(found.distance.lower, truth) << trial;
      EXPECT_GE(found.distance.upper, truth) << trial;
      // Beside a gap of a millionth the rounding of its direction shows over the width of the boxes.
      EXPECT_LE(found.distance.upper - found.distance.lower, trial % 2 == 0 ? 1e-9 : 5e-7) << trial;
    }
  }
}

TEST(sharp_parts, boxes_five_into_each_other_meet_and_one_apart_do_not) {
  const Surface box = sharp(testing::box({0, 0, 0}, {40, 20, 10}, true));
  EXPECT_EQ(collision_of(box, box, {35, 3, 2}, 0.01).verdict, Verdict::intersecting);
  EXPECT_NE(collision_of(box, box, {35, 0, 0}, 0.01).verdict, Verdict::separated);
  const Distance apart = distance_of(box, box, {41, 0, 0});
  EXPECT_NEAR(apart.distance.lower, 1, 1e-9);
  EXPECT_NEAR(apart.distance.upper, 1, 1e-9);
  // The facets without it: two blobs, far apart.
  const Surface blob = surface_of(testing::box({0, 0, 0}, {40, 20, 10}, true));
  EXPECT_EQ(collision_of(blob, blob, {35, 3, 2}, 0.01).verdict, Verdict::separated);
}

TEST(sharp_parts, a_pin_in_a_hole_has_the_clearance_of_the_polygons) {
  const Surface plate = sharp(testing::perforated_plate(2, 2, 30, 5.2, 8, 96));
  const Surface pin = sharp(testing::pin(5, 0, 60, 96, true));
  const double clearance = 0.2 * std::cos(std::numbers::pi / 96);
  constexpr std::array heights{-20.0, 0.0, -60.0};
  for (const double z : std::span(heights).first(testing::fewer(heights.size()))) {
    const Distance found = distance_of(plate, pin, {15, 15, z});
    EXPECT_LE(found.distance.lower, clearance + 1e-9);
    EXPECT_GE(found.distance.upper, clearance - 1e-9);
    EXPECT_LE(found.distance.upper - found.distance.lower, 1e-5);
  }
  EXPECT_EQ(collision_of(plate, pin, {15.3, 15, -20}, 1e-6).verdict, Verdict::intersecting);
}

TEST(limit_to_faces, is_an_upper_bound_and_not_far_above) {
  std::mt19937_64 random(14);
  for (std::size_t trial = 0; trial < trials(24); ++trial) {
    ControlMesh mesh = testing::turned(random_part(random, trial % 2 == 0), random, trial % 3 == 0);
    if (trial % 4 == 3) sharpen(mesh, 60);
    const Surface surface = surface_of(std::move(mesh));
    const double bound = limit_to_faces(surface).value();
    Real seen = 0;
    for_each_sample(surface, 8, [&](FaceId f, const Point3& p) {
      seen = std::max(seen, distance_to_face(surface.mesh(), f, p));
    });
    // The bound is about hulls; the corners of polygons that were rounded span more than these triangles.
    EXPECT_LE(seen, bound + (trial % 6 == 3 ? 1e-6 : 1e-12)) << trial;
    EXPECT_GE(2 * seen + 1e-9, bound) << trial;
  }
}

TEST(limit_to_faces, of_a_smooth_box_is_near_the_truth) {
  for (const bool triangles : {true, false}) {
    const Surface surface = surface_of(testing::box({0, 0, 0}, {40, 20, 10}, triangles));
    Real seen = 0;
    for_each_sample(surface, 40, [&](FaceId f, const Point3& p) {
      seen = std::max(seen, distance_to_face(surface.mesh(), f, p));
    });
    const double bound = limit_to_faces(surface).value();
    EXPECT_LE(seen, bound);
    EXPECT_LE(bound, 1.5 * static_cast<double>(seen));
  }
}

TEST(limit_to_faces, does_not_depend_on_the_size_of_coordinates_and_knows_no_dual_faces) {
  ControlMesh mesh = testing::l_prism(true);
  const double bound = limit_to_faces(surface_of(mesh)).value();
  for (const int exponent : {-900, 900}) {
    ControlMesh scaled = mesh;
    for (Point3& p : scaled.points) {
      p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
    }
    const double there = std::ldexp(limit_to_faces(surface_of(std::move(scaled))).value(), -exponent);
    EXPECT_NEAR(there, bound, 1e-12);
  }
  mesh = testing::box({0, 0, 0}, {1, 1, 1}, false);
  const Surface dual(mesh, {.scheme = Scheme::doo_sabin});
  EXPECT_FALSE(limit_to_faces(dual));
}

}  // namespace
}  // namespace snug::sharp_parts_test
