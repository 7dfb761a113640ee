// Unproved rays for pictures, beside ray() and the surface itself.

#include <snug/snug.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <support/error.h>
#include <testing/cad_parts.h>
#include <testing/instruction_sets.h>
#include <testing/places.h>

namespace snug::ray_caster_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string model(const char* name) { return testing::models_dir() + "/" + name; }

// The unit cube with sharp edges: its limit surface is itself.
Surface sharp_cube() {
  ControlMesh mesh = testing::box({0, 0, 0}, {1, 1, 1}, false);
  static_cast<void>(sharpen(mesh, 30));
  return Surface(std::move(mesh));
}

// Rays from all around towards places in and near the model's box.
std::vector<Ray> rays_around(const Surface& surface, std::size_t count) {
  Box3 box;
  for (const Point3& p : surface.mesh().points) box.add(p);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const double a = 2 * std::numbers::pi * share(random), z = 2 * share(random) - 1,
                 r = std::sqrt(1 - z * z);
    const Point3 from{3 * surface.size() * r * std::cos(a), 3 * surface.size() * r * std::sin(a),
                      3 * surface.size() * z};
    Point3 to;
    for (std::size_t k = 0; k < 3; ++k) to[k] = box.lower[k] + share(random) * (box.upper[k] - box.lower[k]);
    // Some alone, some with neighbours.
    const std::size_t together = rays.size() % 3 == 0 ? 1 : 9;
    for (std::size_t i = 0; i < together && rays.size() < count; ++i) {
      const double by = 1e-3 * surface.size() * static_cast<double>(i);
      rays.push_back({from, {to.x + by - from.x, to.y - from.y, to.z - by - from.z}});
    }
  }
  return rays;
}

ControlMesh octahedron() {
  ControlMesh mesh;
  mesh.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    const VertexId x(octant & 1), y(2 + (octant >> 1 & 1)), z(4 + (octant >> 2));
    const bool odd = std::popcount(octant) % 2 != 0;
    mesh.add_face(std::array{x, odd ? z : y, odd ? y : z});
  }
  return mesh;
}

// Two cones base to base: needles around their tips.
Surface cones(std::uint32_t sides) {
  ControlMesh mesh;
  mesh.points = {{0, 0, 1}, {0, 0, -1}};
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double a = 2 * std::numbers::pi * i / sides;
    mesh.points.push_back({std::cos(a), std::sin(a), 0});
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const VertexId at(2 + i), next(2 + (i + 1) % sides);
    mesh.add_face(std::array{at, next, VertexId(0)});
    mesh.add_face(std::array{next, at, VertexId(1)});
  }
  return Surface(std::move(mesh), {.scheme = Scheme::loop});
}

TEST(ray_caster, finds_what_is_proved_to_be_hit) {
  for (const char* name : {"bust.obj", "pawn.obj", "bracket.obj", "ring.obj", "cones"}) {
    const Surface surface = name == std::string("cones") ? cones(150) : load(model(name));
    const double tolerance = 1e-3 * surface.size();
    const RayCaster caster(surface, tolerance);
    const std::vector<Ray> rays = rays_around(surface, 4000);
    std::vector<QuickHit> quick(rays.size());
    caster.cast(rays, quick);
    const std::vector<RayHits> proved =
        snug::ray(surface, rays, {.query = RayQuery::all, .absolute = tolerance / 100});
    std::size_t missed = 0, others = 0, hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const QuickHit alone = caster.cast(rays[i]);
      EXPECT_EQ(std::isfinite(alone.t), std::isfinite(quick[i].t)) << name << " " << i;
      EXPECT_EQ(std::isfinite(alone.t), caster.blocked(rays[i])) << name << " " << i;
      hits += proved[i].certain_hit();
      missed += proved[i].certain_hit() && !std::isfinite(quick[i].t);
      if (!std::isfinite(quick[i].t)) continue;
      // Its place on the surface is near its place on the ray.
      const Ray& ray = rays[i];
      const Point3 p = evaluate(surface, quick[i].at).point;
      const Vector3 off{ray.origin.x + quick[i].t * ray.direction.x - p.x,
                        ray.origin.y + quick[i].t * ray.direction.y - p.y,
                        ray.origin.z + quick[i].t * ray.direction.z - p.z};
      ASSERT_LE(std::hypot(off.x, off.y, off.z), tolerance) << name << " " << i;
      others += !proved[i].certain_hit() || std::fabs(quick[i].t - proved[i].hits.front().t.lower) > 0.01;
    }
    EXPECT_GT(hits, 500u) << name;
    // Where rays graze the surface the tolerance may hide or show it.
    EXPECT_LE(missed, 2 + hits / 500) << name;
    EXPECT_LE(others, 10 + hits / 50) << name;
  }
}

// From places on the surface to all sides, beginning a little away from it: as for shadows.
TEST(ray_caster, tells_what_is_blocked_beside_the_surface) {
  const Surface surface = load(model("bust.obj"));
  const double tolerance = 1e-3 * surface.size();
  const RayCaster caster(surface, tolerance);
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> share(-1, 1);
  std::size_t blocked = 0, free = 0, differ = 0;
  for (const Ray& ray : rays_around(surface, 4000)) {
    const QuickHit hit = caster.cast(ray);
    if (!std::isfinite(hit.t)) continue;
    Ray on{{ray.origin.x + hit.t * ray.direction.x, ray.origin.y + hit.t * ray.direction.y,
            ray.origin.z + hit.t * ray.direction.z},
           {share(random), share(random), share(random)}};
    on.from = 4 * tolerance;
    on.to = 4 * surface.size();
    const bool found = caster.blocked(on);
    EXPECT_EQ(found, std::isfinite(caster.cast(on).t));
    const RayHits proved = snug::ray(surface, on, {.query = RayQuery::any});
    blocked += found;
    free += !found;
    differ += proved.certain_hit() ? !found : proved.certain_miss() && found;
  }
  EXPECT_GT(blocked, 200u);
  EXPECT_GT(free, 200u);
  EXPECT_LE(differ, 1 + (blocked + free) / 100);
}

// Many patches and small pieces, whose names take more bits.
TEST(ray_caster, knows_where_small_pieces_lie) {
  const Surface surface = load(model("bust.obj"));
  const double tolerance = 1e-6 * surface.size();
  const RayCaster caster(surface, tolerance);
  std::size_t hits = 0;
  for (const Ray& ray : rays_around(surface, 20000)) {
    const QuickHit hit = caster.cast(ray);
    if (!std::isfinite(hit.t)) continue;
    const Point3 p = evaluate(surface, hit.at).point;
    ASSERT_LE(
        std::hypot(ray.origin.x + hit.t * ray.direction.x - p.x, ray.origin.y + hit.t * ray.direction.y - p.y,
                   ray.origin.z + hit.t * ray.direction.z - p.z),
        std::max(tolerance, 0x1p-14 * surface.size()));
    ++hits;
  }
  EXPECT_GT(hits, 5000u);
}

// Few, large pieces: 16 bits a coordinate are all that is off.
TEST(ray_caster, is_as_near_as_it_says_where_the_tolerance_is_small) {
  const Surface surface = sharp_cube();
  const RayCaster caster(surface, 1e-9);
  double worst = 0;
  for (const Ray& ray : rays_around(surface, 3000)) {
    const QuickHit hit = caster.cast(ray);
    if (!std::isfinite(hit.t)) continue;
    // Outside of the cube or in it, from its nearest face.
    double outside = 0, inside = infinity;
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = ray.origin[k] + hit.t * ray.direction[k];
      outside = std::max({outside, -x, x - 1});
      inside = std::min({inside, x, 1 - x});
    }
    worst = std::max(worst, inside > 0 ? inside : 1.8 * outside);
  }
  EXPECT_LE(worst, 0x1p-14);
  EXPECT_GT(worst, 0);
}

// Flat patches side by side, whose boxes are as flat, from above, from below and aslant: rays at corners, sides and between.
TEST(ray_caster, leaves_no_gap_between_flat_patches) {
  constexpr std::uint32_t faces = 20;
  ControlMesh mesh;
  for (std::uint32_t i = 0; i < (faces + 1) * (faces + 1); ++i) {
    mesh.points.push_back({static_cast<double>(i % (faces + 1)), static_cast<double>(i / (faces + 1)), 0});
  }
  for (std::uint32_t i = 0; i < faces * faces; ++i) {
    const std::uint32_t at = i / faces * (faces + 1) + i % faces;
    mesh.add_face(
        std::array{VertexId(at), VertexId(at + 1), VertexId(at + faces + 2), VertexId(at + faces + 1)});
  }
  const Surface surface(std::move(mesh));
  const RayCaster caster(surface, 1e-6);
  for (const Vector3& d : {Vector3{0, 0, -1}, Vector3{0.6, 0.3, 2}, Vector3{-3, 1, -0.1}, Vector3{0, 1, 1}}) {
    for (int i = 8; i <= 72; ++i) {
      for (int j = 8; j <= 72; ++j) {
        const Point3 at{0.25 * i, 0.25 * j, 0};
        const Ray ray{{at.x - 40 * d.x, at.y - 40 * d.y, -40 * d.z}, d};
        ASSERT_NEAR(caster.cast(ray).t, 40, 1e-2) << i << ' ' << j << ' ' << d.x;
        ASSERT_TRUE(caster.blocked(ray)) << i << ' ' << j << ' ' << d.x;
        ASSERT_FALSE(caster.blocked({ray.origin, d, 40.1, 80})) << i << ' ' << j << ' ' << d.x;
      }
    }
  }
}

// Pieces are off by their errors, each its own way: no ray from inside gets out between them or their boxes.
TEST(ray_caster, leaves_no_gap_between_pieces) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> share(-1, 1);
  for (const Scheme scheme : {Scheme::catmark, Scheme::loop, Scheme::doo_sabin}) {
    const Surface surface(
        scheme == Scheme::loop ? octahedron() : testing::box({-1, -1, -1}, {1, 1, 1}, false),
        {.scheme = scheme});
    for (const double tolerance : {0.1, 0.03, 0.01, 0.001}) {
      const RayCaster caster(surface, tolerance * surface.size());
      for (int i = 0; i < 20'000; ++i) {
        const Ray ray{{0.1 * share(random), 0.1 * share(random), 0.1 * share(random)},
                      {share(random), share(random), share(random)}};
        ASSERT_TRUE(std::isfinite(caster.cast(ray).t)) << name_of(scheme) << ' ' << tolerance << ' ' << i;
        ASSERT_TRUE(caster.blocked(ray)) << name_of(scheme) << ' ' << tolerance << ' ' << i;
      }
    }
  }
}

TEST(ray_caster, hits_are_the_same_on_every_instruction_set) {
  const testing::EachInstructionSet sets;
  for (const char* name : {"bust.obj", "bracket.obj"}) {
    const Surface surface = load(model(name));
    const RayCaster caster(surface, 1e-3 * surface.size());
    const std::vector<Ray> rays = rays_around(surface, 20'000);
    std::vector<QuickHit> first, found(rays.size());
    sets.run([&](const char* set) {
      caster.cast(rays, found, {.threads = 1});
      if (first.empty()) first = found;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(found[i].t, first[i].t) << set << ", " << name << ' ' << i;
        ASSERT_EQ(found[i].normal, first[i].normal) << set << ", " << name << ' ' << i;
        ASSERT_EQ(std::isfinite(caster.cast(rays[i]).t), std::isfinite(found[i].t))
            << set << ", " << name << ' ' << i;
      }
    });
  }
}

// The same line, seen from before the surface and from far behind it.
TEST(ray_caster, goes_back_to_a_surface_behind_the_origin) {
  const Surface surface = load(model("bust.obj"));
  const RayCaster caster(surface, 1e-3 * surface.size());
  std::size_t hits = 0;
  for (const Ray& ray : rays_around(surface, 1000)) {
    const QuickHit ahead = caster.cast(ray);
    for (const double far : {10.0, 1e4}) {
      const Vector3& d = ray.direction;
      Ray behind{{ray.origin.x + far * d.x, ray.origin.y + far * d.y, ray.origin.z + far * d.z}, d};
      behind.from = -2 * far;
      const QuickHit found = caster.cast(behind);
      EXPECT_EQ(caster.blocked(behind), std::isfinite(found.t));
      if (!std::isfinite(ahead.t) || !std::isfinite(found.t)) continue;
      ++hits;
      const Point3 p = evaluate(surface, found.at).point;
      ASSERT_LE(std::hypot(behind.origin.x + found.t * d.x - p.x, behind.origin.y + found.t * d.y - p.y,
                           behind.origin.z + found.t * d.z - p.z),
                1.001e-3 * surface.size());
    }
  }
  EXPECT_GT(hits, 300u);
}

TEST(ray_caster, hits_do_not_depend_on_threads) {
  const Surface surface = load(model("bust.obj"));
  const RayCaster caster(surface, 1e-3 * surface.size());
  const std::vector<Ray> rays = rays_around(surface, 20'000);
  std::vector<QuickHit> expected(rays.size()), found(rays.size());
  caster.cast(rays, expected, {.threads = 1});
  for (const int threads : {2, 3, 7}) {
    caster.cast(rays, found, {.threads = threads});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(found[i].t, expected[i].t) << "ray " << i << ", " << threads << " threads";
      ASSERT_EQ(found[i].normal, expected[i].normal) << "ray " << i << ", " << threads << " threads";
    }
  }
}

TEST(ray_caster, keeps_to_segments_and_refuses_what_is_none) {
  const Surface surface = sharp_cube();
  const RayCaster caster(surface, 1e-4);
  EXPECT_NEAR(caster.cast({{0.3, 0.4, 5}, {0, 0, -2}}).t, 2, 1e-4);
  EXPECT_NEAR(caster.cast({{0.3, 0.4, 5}, {0, 0, -2}, 2.1, 3}).t, 2.5, 1e-4);
  EXPECT_EQ(caster.cast({{0.3, 0.4, 5}, {0, 0, -2}, 0, 1.9}).t, infinity);
  EXPECT_EQ(caster.cast({{0.3, 0.4, 5}, {0, 0, 2}}).t, infinity);
  EXPECT_TRUE(caster.blocked({{0.3, 0.4, 5}, {0, 0, -2}, 2.1, 3}));
  EXPECT_FALSE(caster.blocked({{0.3, 0.4, 5}, {0, 0, -2}, 0, 1.9}));
  EXPECT_FALSE(caster.blocked({{0.3, 0.4, 5}, {0, 0, -2}, 2.1, 2.4}));
  EXPECT_THROW(static_cast<void>(caster.blocked({{0, 0, 0}, {0, 0, 0}})), InputError);
  EXPECT_NEAR(caster.cast({{0.3, 0.4, 5}, {0, 0, -2}}).normal.z, 1, 1e-6);
  EXPECT_THROW(static_cast<void>(caster.cast({{0, 0, 0}, {0, 0, 0}})), InputError);
  for (const double bad : {0.0, -1.0, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(RayCaster(surface, bad), InputError);
  }
}

TEST(ray_caster, hits_from_afar_and_with_short_directions) {
  const Surface surface = sharp_cube();
  const RayCaster caster(surface, 1e-3);
  for (const double afar : {1e2, 1e8, 1e12}) {
    for (const double speed : {1e-161, 1e-150, 1.0, 1e150}) {
      const Ray ray{{0.5, 0.5, afar}, {0, 0, -speed}};
      EXPECT_NEAR(caster.cast(ray).t * speed / (afar - 1), 1, 1e-4) << afar << " " << speed;
      EXPECT_TRUE(caster.blocked(ray)) << afar << " " << speed;
      EXPECT_EQ(caster.cast({{7, 0.5, afar}, {0, 0, -speed}}).t, infinity) << afar << " " << speed;
    }
  }
  // Where boxes of no child are.
  for (const double at : {1e29, 1e30, 1e31}) {
    for (const Vector3& direction : {Vector3{1, -1, 0}, Vector3{1, 1, 1}, Vector3{0, 0, 1}}) {
      const Ray ray{{at, at, at}, direction, -10, 1e40};
      EXPECT_FALSE(caster.blocked(ray));
      EXPECT_EQ(caster.cast(ray).t, infinity);
    }
  }
}

TEST(ray_caster, withstands_every_size) {
  for (const double size : {1e-200, 1e-3, 1e9, 1e200}) {
    ControlMesh mesh = testing::box({0, 0, 0}, {size, size, size}, false);
    static_cast<void>(sharpen(mesh, 30));
    const Surface surface(std::move(mesh));
    const RayCaster caster(surface, 1e-3 * size);
    for (const double speed : {1e-90, 1.0, 1e90}) {
      const Ray ray{{0.3 * size, 0.4 * size, 5 * size}, {0, 0, -speed}};
      EXPECT_NEAR(caster.cast(ray).t * speed / size, 4, 1e-3) << size << " " << speed;
      const RayHits found = snug::ray(surface, ray);
      ASSERT_TRUE(found.certain_hit()) << size << " " << speed;
      EXPECT_NEAR(found.hits[0].t.lower * speed / size, 4, 1e-5);
    }
  }
}

}  // namespace
}  // namespace snug::ray_caster_test
