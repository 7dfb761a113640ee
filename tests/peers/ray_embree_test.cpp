// Nearest hits on limit surfaces against those that Embree finds on dense triangles, away from silhouettes.
//
//   SNUG_PLACEMENTS=1000000 build/release/bin/tests/ray_embree_test

#include <snug/snug.h>

#include <embree3/rtcore.h>
#include <gtest/gtest.h>
#include <support/point.h>
#include <testing/counts.h>
#include <testing/places.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <stdexcept>

namespace snug::ray_embree_test {
namespace {

class EmbreeTriangles {
 public:
  explicit EmbreeTriangles(const Tessellation& t)
      : device_(rtcNewDevice(nullptr), &rtcReleaseDevice),
        scene_(rtcNewScene(device_.get()), &rtcReleaseScene) {
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    RTCGeometry mesh = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), t.positions.size()));
    for (const Point3& p : t.positions)
      for (std::size_t k = 0; k < 3; ++k) *points++ = static_cast<float>(p[k]);
    auto* ids = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), t.triangles.size()));
    for (const auto& triangle : t.triangles) ids = std::copy(triangle.begin(), triangle.end(), ids);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene_.get(), mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene_.get());
  }

  struct Hit {
    double t;       // infinite for none
    double cosine;  // of the ray and the normal
  };
  // Requires:  a direction of length 1.
  [[nodiscard]] Hit nearest(const Point3& origin, const Vector3& direction) const {
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(origin.x);
    ray.ray.org_y = static_cast<float>(origin.y);
    ray.ray.org_z = static_cast<float>(origin.z);
    ray.ray.dir_x = static_cast<float>(direction.x);
    ray.ray.dir_y = static_cast<float>(direction.y);
    ray.ray.dir_z = static_cast<float>(direction.z);
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_.get(), &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {std::numeric_limits<double>::infinity(), 0};
    const Vector3 normal{ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z};
    return {ray.ray.tfar, std::fabs(dot(normal, direction)) / length(normal)};
  }

 private:
  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
};

TEST(rays, first_meet_models_where_embree_does) {
  const std::size_t rays = testing::number_of("SNUG_PLACEMENTS", 27'000) / 9;
  std::size_t compared = 0, missed = 0, near_silhouettes = 0, undecided = 0;
  double largest = 0;
  for (const char* const name :
       {"bracket", "bust", "demon", "figure", "head", "pawn", "pin", "ring", "star"}) {
    const Surface surface = load(testing::models_dir() + "/" + name + ".obj");
    const double size = surface.size();
    const Tessellation t = tessellate(surface, {.error = 2e-4 * size, .normals = false});
    const EmbreeTriangles triangles(t);
    Point3 middle{};
    for (const Point3& p : t.positions)
      middle = middle + (1.0 / static_cast<double>(t.positions.size())) * (p - Point3{});
    const double error = t.error_bound + 2e-6 * size;  // single precision, of coordinates and of lengths
    std::mt19937_64 random(17);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < rays && !HasFailure(); ++i) {
      const auto anywhere = [&] { return Vector3{normal(random), normal(random), normal(random)}; };
      const Vector3 away = anywhere();
      const Point3 from = middle + (1.5 * size / length(away)) * away;
      const Point3 to = middle + 0.2 * size * anywhere();
      const Vector3 direction = (1 / length(to - from)) * (to - from);
      // All rays around it, at distances that triangles and surface may differ by, meet the same sheet or none.
      Vector3 across = cross(direction, {0.3, -0.5, 0.8});
      across = (1 / length(across)) * across;
      const Vector3 other = cross(direction, across);
      const EmbreeTriangles::Hit hit = triangles.nearest(from, direction);
      bool alike = hit.t == std::numeric_limits<double>::infinity() || hit.cosine > 0.2;
      for (int k = 0; k < 24 && alike; ++k) {
        const double angle = std::numbers::pi / 4 * (k % 8), radius = (1 << (k / 8)) * error;
        const Point3 beside = from + (radius * std::cos(angle)) * across + (radius * std::sin(angle)) * other;
        const EmbreeTriangles::Hit near = triangles.nearest(beside, direction);
        alike = hit.t == near.t || (std::fabs(hit.t - near.t) < 30 * error && near.cosine > 0.2);
      }
      if (!alike) {
        ++near_silhouettes;
        continue;
      }
      const RayHits found = snug::ray(surface, {from, direction});
      if (hit.t == std::numeric_limits<double>::infinity()) {
        ++missed;
        EXPECT_TRUE(found.certain_miss()) << name << ", ray " << i;
        continue;
      }
      if (!found.certain_hit()) {
        ++undecided;
        EXPECT_FALSE(found.certain_miss()) << name << ", ray " << i;
        continue;
      }
      ++compared;
      const double off = std::max(found.hits.front().t.lower - hit.t, hit.t - found.hits.back().t.upper);
      largest = std::max(largest, off * hit.cosine / error);
      EXPECT_LE(off, 2 * error / hit.cosine + error) << name << ", ray " << i;
    }
  }
  std::cout << "  " << compared << " hits compared, off by at most " << largest
            << " of the triangles' error over the cosine; " << missed << " misses, " << near_silhouettes
            << " near silhouettes, " << undecided << " not decided\n";
  EXPECT_GT(compared, rays);
  EXPECT_LE(undecided * 1000, compared);
}

}  // namespace
}  // namespace snug::ray_embree_test
