#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <snug/bounds/bounding_points.h>
#include <snug/bounds/enclosure.h>
#include <snug/surface/batch_bounds.h>
#include <snug/surface/limit_surface.h>

namespace snug::bench {

/// snug as the measurements see it: many patches at once, on one thread. Whatever way the library has to do
/// that faster belongs in here, so that every program of bench/ gets it.
class Subject {
 public:
  /// Everything before the first bound, with a library of kinds of its own.
  explicit Subject(ControlMesh mesh, std::shared_ptr<BoundsCache> library = std::make_shared<BoundsCache>())
      : Subject(std::move(mesh), SchemeOptions{}, std::move(library)) {}
  Subject(ControlMesh mesh, const SchemeOptions& options,
          std::shared_ptr<BoundsCache> library = std::make_shared<BoundsCache>());

  [[nodiscard]] const LimitSurface& surface() const { return *surface_; }

  /// Offset triangles of some faces, in scaled units, a patch at a time as queries make them.
  /// Returns:   the sum of the radii.
  double enclose(std::span<const PatchId> faces, std::vector<OffsetTriangle>& out);
  /// Of all faces together.
  [[nodiscard]] std::size_t hull_point_count();
  /// Bounds of some faces at once, their kinds' rows or tables made.
  [[nodiscard]] BatchBounds bounds(std::span<const PatchId> faces,
                                   BoundMethod method = BoundMethod::rows) const;
  /// Offset triangles of all faces, with all that it takes to make them.
  /// Returns:   the sum of the radii.
  double enclose_all(std::vector<OffsetTriangle>& out);
  /// The baseline: least boxes of the control points.
  /// Returns:   the sum of their longest sides.
  double box(std::span<const PatchId> faces, std::vector<Box3>& out);

 private:
  std::shared_ptr<BoundsCache> library_;
  std::unique_ptr<LimitSurface> surface_;
  BoundingPoints scratch_;
};

/// Offset triangles for these control points, in mesh units, on one thread.
/// Returns:   the sum of the radii.
double update(BatchBounds& bounds, std::span<const Point3> points, std::vector<OffsetTriangle>& out);

/// Ids 0 to count - 1.
[[nodiscard]] std::vector<PatchId> all_faces(std::size_t count);

}  // namespace snug::bench
