#pragma once

#include <span>

#include <snug/bounds/hull_points.h>
#include <snug/bounds/offset_triangle.h>
#include <snug/bvh/volume.h>

namespace snug {

/// Pieces of a surface, known by points whose hulls hold them, for fitting volumes around them.
class EnclosedHulls final : public Enclosed {
 public:
  /// `spread`: points like the pieces, for the choice of axes.
  /// Requires:  both outlive this.
  EnclosedHulls(std::span<const HullPoints* const> hulls, std::span<const Point3> spread)
      : hulls_(hulls), spread_(spread) {}

  [[nodiscard]] Extent extent(const Vector3& direction) const override;
  [[nodiscard]] std::span<const Point3> points() const override { return spread_; }

 private:
  std::span<const HullPoints* const> hulls_;
  std::span<const Point3> spread_;
};

/// The same, known by their offset triangles.
class EnclosedTriangles final : public Enclosed {
 public:
  /// Requires:  both outlive this.
  EnclosedTriangles(std::span<const OffsetTriangle> triangles, std::span<const Point3> spread)
      : triangles_(triangles), spread_(spread) {}

  [[nodiscard]] Extent extent(const Vector3& direction) const override;
  [[nodiscard]] std::span<const Point3> points() const override { return spread_; }

 private:
  std::span<const OffsetTriangle> triangles_;
  std::span<const Point3> spread_;
};

}  // namespace snug
