#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <snug/ray.h>

#include "triangle_mesh.h"

namespace snug::bench {

/// A triangle mesh in Embree's tree, in single precision: RTC_BUILD_QUALITY_HIGH, one thread.
class EmbreeMesh {
 public:
  explicit EmbreeMesh(const TriangleMesh& mesh);
  ~EmbreeMesh();
  EmbreeMesh(EmbreeMesh&&) noexcept;
  EmbreeMesh& operator=(EmbreeMesh&&) noexcept;

  /// Distance of the closest point of the mesh: rtcPointQuery with a callback that compares a triangle, as in
  /// Embree's tutorial closest_point.
  [[nodiscard]] double distance(const Point3& to) const;

  /// Where each ray of an eye first meets the mesh, in lengths of its direction; infinite: nowhere. One call of
  /// rtcIntersect1 a ray, or of rtcIntersect8 for eight, with the flag for coherent rays.
  void first_hits(const Point3& eye, std::span<const Vector3> directions, std::span<float> out) const;
  void first_hits_by_eights(const Point3& eye, std::span<const Vector3> directions,
                            std::span<float> out) const;
  /// Which rays meet the mesh between `from` and infinity, in lengths of their directions: one call of rtcOccluded1 a ray.
  void blocked(std::span<const Ray> rays, std::span<std::uint8_t> out) const;
  /// Memory of Embree, the mesh's buffers included.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace snug::bench
