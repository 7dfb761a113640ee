#include "peer_embree.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include <embree3/rtcore.h>

namespace snug::bench {
namespace {

struct Vec {
  float x, y, z;
};
Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(float s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
float dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// [Ericson, Real-Time Collision Detection, 5.1.5]
Vec closest_on_triangle(const Vec& p, const Vec& a, const Vec& b, const Vec& c) {
  const Vec ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const float scale = 1 / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

struct Buffers {
  const Vec* points;
  const unsigned (*triangles)[3];
};

bool compare(RTCPointQueryFunctionArguments* arguments) {
  const auto& mesh = *static_cast<const Buffers*>(arguments->userPtr);
  const unsigned* corners = mesh.triangles[arguments->primID];
  RTCPointQuery& query = *arguments->query;
  const Vec to{query.x, query.y, query.z};
  const Vec off =
      to - closest_on_triangle(to, mesh.points[corners[0]], mesh.points[corners[1]], mesh.points[corners[2]]);
  const float distance = std::sqrt(dot(off, off));
  if (distance >= query.radius) return false;
  query.radius = distance;
  return true;
}

}  // namespace

struct EmbreeMesh::Impl {
  std::atomic<std::ptrdiff_t> bytes{0};
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = watched_scene();
  Buffers buffers{};

  RTCScene watched_scene() {
    const auto watch = [](void* impl, ssize_t change, bool) {
      static_cast<Impl*>(impl)->bytes += change;
      return true;
    };
    rtcSetDeviceMemoryMonitorFunction(device, watch, this);
    return rtcNewScene(device);
  }
  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

EmbreeMesh::EmbreeMesh(const TriangleMesh& mesh) : impl_(new Impl) {
  RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<Vec*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec), mesh.points.size()));
  auto* triangles = static_cast<unsigned(*)[3]>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(unsigned[3]), mesh.triangles.size()));
  if (!points || !triangles) throw std::runtime_error("Embree makes no buffers");
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Point3& p = mesh.points[i];
    points[i] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) triangles[i][k] = mesh.triangles[i][k];
  }
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(impl_->scene);
  impl_->buffers = {points, triangles};
}
EmbreeMesh::~EmbreeMesh() = default;
EmbreeMesh::EmbreeMesh(EmbreeMesh&&) noexcept = default;
EmbreeMesh& EmbreeMesh::operator=(EmbreeMesh&&) noexcept = default;

double EmbreeMesh::distance(const Point3& to) const {
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{static_cast<float>(to.x), static_cast<float>(to.y), static_cast<float>(to.z), 0,
                      std::numeric_limits<float>::infinity()};
  rtcPointQuery(impl_->scene, &query, &context, compare, &impl_->buffers);
  return static_cast<double>(query.radius);
}

namespace {

RTCIntersectContext coherent() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

}  // namespace

void EmbreeMesh::first_hits(const Point3& eye, std::span<const Vector3> directions,
                            std::span<float> out) const {
  RTCIntersectContext context = coherent();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(eye.x);
    ray.ray.org_y = static_cast<float>(eye.y);
    ray.ray.org_z = static_cast<float>(eye.z);
    ray.ray.dir_x = static_cast<float>(directions[i].x);
    ray.ray.dir_y = static_cast<float>(directions[i].y);
    ray.ray.dir_z = static_cast<float>(directions[i].z);
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0u;
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->scene, &context, &ray);
    out[i] = ray.ray.tfar;
  }
}

void EmbreeMesh::blocked(std::span<const Ray> rays, std::span<std::uint8_t> out) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& [origin, direction, from, to] = rays[i];
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x);
    ray.org_y = static_cast<float>(origin.y);
    ray.org_z = static_cast<float>(origin.z);
    ray.dir_x = static_cast<float>(direction.x);
    ray.dir_y = static_cast<float>(direction.y);
    ray.dir_z = static_cast<float>(direction.z);
    ray.tnear = static_cast<float>(from);
    ray.tfar = static_cast<float>(to);
    ray.mask = ~0u;
    rtcOccluded1(impl_->scene, &context, &ray);
    out[i] = ray.tfar < 0;
  }
}

void EmbreeMesh::first_hits_by_eights(const Point3& eye, std::span<const Vector3> directions,
                                      std::span<float> out) const {
  RTCIntersectContext context = coherent();
  for (std::size_t first = 0; first < directions.size(); first += 8) {
    RTCRayHit8 rays{};
    alignas(32) int valid[8];
    for (std::size_t l = 0; l < 8; ++l) {
      valid[l] = first + l < directions.size() ? -1 : 0;
      const Vector3& direction = directions[std::min(first + l, directions.size() - 1)];
      rays.ray.org_x[l] = static_cast<float>(eye.x);
      rays.ray.org_y[l] = static_cast<float>(eye.y);
      rays.ray.org_z[l] = static_cast<float>(eye.z);
      rays.ray.dir_x[l] = static_cast<float>(direction.x);
      rays.ray.dir_y[l] = static_cast<float>(direction.y);
      rays.ray.dir_z[l] = static_cast<float>(direction.z);
      rays.ray.tfar[l] = std::numeric_limits<float>::infinity();
      rays.ray.mask[l] = ~0u;
      rays.hit.geomID[l] = rays.hit.instID[0][l] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, impl_->scene, &context, &rays);
    for (std::size_t l = 0; l < 8 && first + l < directions.size(); ++l) out[first + l] = rays.ray.tfar[l];
  }
}

std::size_t EmbreeMesh::bytes() const { return static_cast<std::size_t>(impl_->bytes.load()); }

}  // namespace snug::bench
