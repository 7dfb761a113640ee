#pragma once

#include <cstddef>
#include <memory>

#include <snug/geometry/motion.h>

#include "triangle_mesh.h"

namespace snug::bench {

/// The sort of box in FCL's trees: oriented ones, or these with rectangles swept by balls, which distances
/// need.
enum class FclBoxes { obb, obbrss };

/// A triangle mesh with FCL's tree over it, fcl::BVHModel in double precision with FCL's own settings.
class FclModel {
 public:
  FclModel(const TriangleMesh& mesh, FclBoxes boxes);
  ~FclModel();
  FclModel(FclModel&&) noexcept;
  FclModel& operator=(FclModel&&) noexcept;

  /// Nodes, points and triangles; FCL's memUsage() only prints, and counts boxes without what nodes add to
  /// them.
  [[nodiscard]] std::size_t bytes() const;

  struct Impl;
  [[nodiscard]] const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Do two triangles meet? One contact, without its details.
/// Requires:  both models with the same boxes.
[[nodiscard]] bool fcl_collide(const FclModel& a, const Motion& place_a, const FclModel& b,
                               const Motion& place_b);

/// Distance of two triangle meshes: no error allowed, no nearest points, no signed distance. Negative or 0
/// for meshes that meet.
/// Requires:  FclBoxes::obbrss.
[[nodiscard]] double fcl_distance(const FclModel& a, const Motion& place_a, const FclModel& b,
                                  const Motion& place_b);

}  // namespace snug::bench
