// Rays against limit surfaces: what ray() promises, on small models.

#include <snug/snug.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/error.h>
#include <support/point.h>
#include <testing/counts.h>
#include <testing/places.h>
#include <testing/ray_bundles.h>

namespace snug::ray_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string model(const char* name) { return testing::models_dir() + "/" + name; }

// The unit cube with sharp edges: its limit surface is itself.
ControlMesh cube() {
  ControlMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.points.push_back(
        {static_cast<double>(i & 1), static_cast<double>(i >> 1 & 1), static_cast<double>(i >> 2)});
  }
  for (const auto& face : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                           {4, 5, 7, 6},
                           {0, 1, 5, 4},
                           {2, 6, 7, 3},
                           {0, 4, 6, 2},
                           {1, 3, 7, 5}}) {
    std::array<VertexId, 4> ids{VertexId(face[0]), VertexId(face[1]), VertexId(face[2]), VertexId(face[3])};
    mesh.add_face(ids);
  }
  return mesh;
}
Surface sharp_cube() {
  ControlMesh mesh = cube();
  static_cast<void>(sharpen(mesh, 30));
  return Surface(std::move(mesh));
}

TEST(trace, finds_both_sides_of_a_cube) {
  const Surface surface = sharp_cube();
  const RayHits all = snug::ray(surface, {{0.3, 0.4, 5}, {0, 0, -2}}, {.query = RayQuery::all});
  ASSERT_EQ(all.hits.size(), 2u);
  EXPECT_EQ(all.outcome, Outcome::complete);
  EXPECT_TRUE(all.hits[0].t.contains(2) && all.hits[1].t.contains(2.5));
  EXPECT_EQ(all.hits[0].side, -1);
  EXPECT_EQ(all.hits[1].side, 1);
  for (const RayHit& hit : all.hits) {
    EXPECT_TRUE(hit.certified);
    EXPECT_LE(hit.t.upper - hit.t.lower, 1e-6);
    const SurfacePoint there = evaluate(surface, *hit.at);
    EXPECT_NEAR(there.point.x, 0.3, 1e-9);
    EXPECT_NEAR(there.point.z, hit.point.z, 1e-9);
  }
  const RayHits nearest = snug::ray(surface, {{0.3, 0.4, 5}, {0, 0, -2}});
  ASSERT_EQ(nearest.hits.size(), 1u);
  EXPECT_TRUE(nearest.hits[0].t.contains(2));
}

TEST(trace, passes_no_edge_and_no_vertex) {
  const Surface surface = sharp_cube();
  const Point3 inside{0.3125, 0.4375, 0.28125};
  for (int i = 0; i < 27; ++i) {
    const Point3 to{0.5 * (i % 3), 0.5 * (i / 3 % 3), 0.5 * (i / 9)};
    if (i == 13) continue;
    const Ray ray{inside, {to.x - inside.x, to.y - inside.y, to.z - inside.z}};
    for (const RayQuery query : {RayQuery::nearest, RayQuery::any, RayQuery::all}) {
      const RayHits found = snug::ray(surface, ray, {.query = query});
      ASSERT_EQ(found.hits.size(), 1u) << i;
      EXPECT_TRUE(found.hits[0].certified && found.hits[0].t.contains(1)) << i;
      EXPECT_EQ(found.hits[0].side, 1) << i;
    }
  }
}

TEST(trace, says_where_it_cannot_tell) {
  const Surface surface = sharp_cube();
  // Along an edge's line, touching it, and in the plane of a face.
  for (const Ray& ray :
       {Ray{{-1, -1, 0}, {1, 1, 0}}, Ray{{-1, 1, 0.5}, {1, -1, 0}}, Ray{{-1, 0.5, 1}, {1, 0, 0}}}) {
    const RayHits found = snug::ray(surface, ray, {.query = RayQuery::all});
    EXPECT_FALSE(found.certain_miss());
  }
  const RayHits touching = snug::ray(surface, {{-0.5, 0.5, 0.5}, {1, -1, 0}});
  ASSERT_FALSE(touching.hits.empty());
  EXPECT_FALSE(touching.certain_hit());
  EXPECT_TRUE(touching.hits[0].t.contains(0.5));
}

// From the lower end of the first hit to the upper one of the last.
Interval part_of(const RayHits& found) {
  Interval part{INFINITY, -INFINITY};
  for (const RayHit& hit : found.hits) {
    part.lower = std::min(part.lower, hit.t.lower);
    part.upper = std::max(part.upper, hit.t.upper);
  }
  return part;
}

// Whole numbers, so that rays lie in the facet's plane exactly: the answer is where they are on the facet, not all of it.
TEST(trace, in_the_plane_of_a_facet_is_the_chord) {
  std::mt19937_64 random(9);
  const auto whole = [&](int most) {
    return static_cast<double>(static_cast<int>(random() % (2 * most + 1)) - most);
  };
  int chords = 0, missed = 0;
  const int trials = testing::long_check() ? 400 : 130;
  for (int trial = 0; trial < trials; ++trial) {
    const Point3 corner{whole(9), whole(9), whole(9)};
    const Vector3 e{whole(9), whole(9), whole(9)}, f{whole(9), whole(9), whole(9)};
    if (length(cross(e, f)) < 20) continue;
    ControlMesh mesh;
    mesh.points = {corner, corner + e, corner + f, corner + e + f};
    const bool quad = trial % 3 == 0;  // else a triangle
    quad ? mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(3), VertexId(2)})
         : mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
    const Surface surface(mesh, {.scheme = quad ? Scheme::bilinear : Scheme::flat});
    const double u = whole(4) / 4, v = whole(4) / 4, du = whole(5), dv = whole(5);
    if (du == 0 && dv == 0) continue;
    // The part of u + t du, v + t dv with 0 <= u, v and u + v <= 1, or both up to 1.
    double first = -50, last = 50, nearly = 0;
    const auto keep = [&](double at, double by) {  // at + t by >= 0
      if (by > 0) first = std::max(first, -at / by);
      if (by < 0) last = std::min(last, -at / by);
      if (by == 0 && at < 0) last = -INFINITY;
      if (by == 0 && at == 0) nearly = 1;
    };
    keep(u, du);
    keep(v, dv);
    if (quad) {
      keep(1 - u, -du);
      keep(1 - v, -dv);
    } else {
      keep(1 - u - v, -du - dv);
    }
    const Ray ray{corner + u * e + v * f, du * e + dv * f, -50, 50};
    const RayHits found = snug::ray(surface, ray, {.query = RayQuery::all});
    if (last < first - 1e-3) {
      ++missed;
      EXPECT_TRUE(found.certain_miss()) << trial;
    } else if (last > first) {
      ++chords;
      ASSERT_FALSE(found.hits.empty()) << trial;
      const auto [lower, upper] = part_of(found);
      EXPECT_LE(lower, first + 1e-12) << trial;
      EXPECT_GE(upper, last - 1e-12) << trial;
      if (nearly == 0) {  // along an edge all depends on the tube's width
        EXPECT_GE(lower, first - 1e-3) << trial;
        EXPECT_LE(upper, last + 1e-3) << trial;
      }
    }
  }
  EXPECT_GT(chords, trials / 4);
  EXPECT_GT(missed, trials / 8);
}

// Quads that are no parallelograms, and polygons that are split into such: few splits, and the chord.
TEST(trace, in_the_plane_of_a_polygon_is_the_chord) {
  const std::vector<std::vector<std::array<double, 2>>> polygons{
      {{0, 0}, {8, 0}, {6, 4}, {1, 3}},         {{0, 0}, {5, -2}, {7, 1}, {1, 6}},
      {{0, 0}, {9, 0}, {9, 1}, {0, 7}},         {{0, 0}, {4, -1}, {7, 2}, {5, 6}, {0, 5}},
      {{0, 0}, {16, -1}, {16, 1}, {0, 0.0625}}, {{0, 0}, {3, -2}, {6, 0}, {6, 4}, {3, 6}, {0, 4}}};
  std::mt19937_64 random(4);
  const auto whole = [&](int most) {
    return static_cast<double>(static_cast<int>(random() % (2 * most + 1)) - most);
  };
  int chords = 0, missed = 0;
  for (int trial = 0; trial < 180; ++trial) {
    const auto& polygon = polygons[random() % polygons.size()];
    const Point3 corner{whole(9), whole(9), whole(9)};
    const Vector3 e{whole(9), whole(9), whole(9)}, f{whole(9), whole(9), whole(9)};
    if (length(cross(e, f)) < 20) continue;
    const auto at = [&](double u, double v) { return corner + u * e + v * f; };
    ControlMesh mesh;
    std::vector<VertexId> face;
    for (const auto& [u, v] : polygon) {
      face.emplace_back(static_cast<std::uint32_t>(mesh.points.size()));
      mesh.points.push_back(at(u, v));
    }
    mesh.add_face(face);
    const Surface surface(mesh, {.scheme = Scheme::bilinear});
    const double u = 0.5 * whole(12), v = 0.5 * whole(12), du = whole(5), dv = whole(5);
    if (du == 0 && dv == 0) continue;
    double first = -50, last = 50, nearest_edge = INFINITY;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const auto &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      const double x = q[0] - p[0], y = q[1] - p[1];
      const double height = x * (v - p[1]) - y * (u - p[0]), rate = x * dv - y * du;
      if (rate > 0) first = std::max(first, -height / rate);
      if (rate < 0) last = std::min(last, -height / rate);
      if (rate == 0) nearest_edge = std::min(nearest_edge, std::fabs(height));
      if (rate == 0 && height < 0) last = -INFINITY;
    }
    const RayHits found = snug::ray(surface, {at(u, v), du * e + dv * f, -50, 50}, {.query = RayQuery::all},
                                    {.max_splits = 3000});
    EXPECT_NE(found.outcome, Outcome::budget_spent) << trial;
    if (last < first - 1e-3) {
      ++missed;
      EXPECT_TRUE(found.certain_miss()) << trial;
    } else if (last > first) {
      ++chords;
      ASSERT_FALSE(found.hits.empty()) << trial;
      EXPECT_LE(part_of(found).lower, first + 1e-12) << trial;
      EXPECT_GE(part_of(found).upper, last - 1e-12) << trial;
      if (nearest_edge == 0) continue;  // along an edge all depends on the tube's width
      EXPECT_GE(part_of(found).lower, first - 1e-3) << trial;
      EXPECT_LE(part_of(found).upper, last + 1e-3) << trial;
    }
  }
  EXPECT_GT(chords, 45);
  EXPECT_GT(missed, 20);
}

// A bent quad is two families of straight lines.
TEST(trace, along_a_line_in_a_bent_quad_ends_soon) {
  std::mt19937_64 random(8);
  const auto whole = [&](int most) {
    return static_cast<double>(static_cast<int>(random() % (2 * most + 1)) - most);
  };
  for (int trial = 0; trial < 40; ++trial) {
    const std::array<Point3, 4> c{Point3{0, 0, whole(3)},
                                  {8 + whole(2), whole(2), whole(3)},
                                  {8 + whole(2), 8 + whole(2), whole(3)},
                                  {whole(2), 8 + whole(2), whole(3)}};
    ControlMesh mesh;
    mesh.points.assign(c.begin(), c.end());
    mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2), VertexId(3)});
    const Surface surface(mesh, {.scheme = Scheme::bilinear});
    const double share = static_cast<double>(1 + random() % 15) / 16;
    const bool turned = trial % 2 == 0;
    const Point3 from = turned ? c[0] + share * (c[3] - c[0]) : c[0] + share * (c[1] - c[0]),
                 to = turned ? c[1] + share * (c[2] - c[1]) : c[3] + share * (c[2] - c[3]);
    const Vector3 along = to - from;
    const RayHits found =
        snug::ray(surface, {from - along, along}, {.query = RayQuery::all}, {.max_splits = 3000});
    EXPECT_NE(found.outcome, Outcome::budget_spent) << trial;
    ASSERT_FALSE(found.hits.empty()) << trial;
    EXPECT_LE(part_of(found).lower, 1 + 1e-12) << trial;
    EXPECT_GE(part_of(found).upper, 2 - 1e-12) << trial;
    EXPECT_GE(part_of(found).lower, 1 - 1e-2) << trial;
    EXPECT_LE(part_of(found).upper, 2 + 1e-2) << trial;
  }
}

TEST(trace, knows_the_ends_of_segments) {
  const Surface surface = sharp_cube();
  const auto hits = [&](double from, double to) {
    return snug::ray(surface, {{0.3, 0.4, 5}, {0, 0, -1}, from, to}, {.query = RayQuery::all});
  };
  EXPECT_TRUE(hits(0, 3.9).certain_miss());
  EXPECT_EQ(hits(0, 4.1).hits.size(), 1u);
  EXPECT_EQ(hits(4.1, 4.9).hits.size(), 0u);
  EXPECT_EQ(hits(4.1, infinity).hits.size(), 1u);
  EXPECT_EQ(hits(-10, 10).hits.size(), 2u);
  const RayHits at_the_end = hits(0, 4);
  ASSERT_EQ(at_the_end.hits.size(), 1u);
  EXPECT_FALSE(at_the_end.hits[0].certified);
}

TEST(trace, refuses_what_is_no_ray) {
  const Surface surface = sharp_cube();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Ray& ray :
       {Ray{{nan, 0, 0}, {1, 0, 0}}, Ray{{0, 0, 0}, {0, 0, 0}}, Ray{{0, 0, 0}, {infinity, 0, 0}},
        Ray{{0, 0, 0}, {1, 0, 0}, 2, 1}, Ray{{0, 0, 0}, {1, 0, 0}, nan, 1},
        Ray{{0, 0, 0}, {1, 0, 0}, -infinity, 1}, Ray{{1e30, 0, 0}, {1, 0, 0}}}) {
    EXPECT_THROW(static_cast<void>(snug::ray(surface, ray)), InputError);
  }
  EXPECT_THROW(static_cast<void>(snug::ray(surface, Ray{{0, 0, 5}, {0, 0, -1}}, {.absolute = -1})),
               InputError);
}

TEST(trace, answers_the_same_for_any_threads_and_order) {
  const Surface surface = load(model("bust.obj"));
  std::vector<Ray> rays;
  for (int i = 0; i < 400; ++i) {
    const double a = 0.37 * i, b = 0.11 * i;
    const Point3 from{5 * std::cos(a), 5 * std::sin(a), std::sin(b)};
    rays.push_back({from, {0.3 * std::sin(b) - from.x, 0.2 * std::cos(b) - from.y, -from.z}});
  }
  const std::vector<RayHits> one = snug::ray(surface, rays, {}, {.threads = 1}),
                             two = snug::ray(surface, rays, {}, {.threads = 2});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayHits alone = snug::ray(surface, rays[rays.size() - 1 - i]);
    const RayHits& same = one[rays.size() - 1 - i];
    ASSERT_EQ(one[i].hits.size(), two[i].hits.size());
    ASSERT_EQ(alone.hits.size(), same.hits.size());
    for (std::size_t k = 0; k < one[i].hits.size(); ++k) EXPECT_EQ(one[i].hits[k].t, two[i].hits[k].t);
    for (std::size_t k = 0; k < alone.hits.size(); ++k) EXPECT_EQ(alone.hits[k].t, same.hits[k].t);
  }
}

// On models with many faces; sound/ray_test.cpp has every scheme, tag and boundary.
TEST(trace, answers_together_are_those_alone) {
  std::mt19937_64 random(12345);
  testing::BundleCounts counts;
  for (const char* name : {"bust.obj", "figure.obj", "bracket.obj", "ring.obj", "star.obj"}) {
    testing::expect_together_as_alone(load(model(name)), name, 60, random, counts);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(counts.hits, 1000u);
  EXPECT_GT(counts.misses, 1000u);
}

}  // namespace
}  // namespace snug::ray_test
