#pragma once

#include <memory>

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

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace snug::bench
