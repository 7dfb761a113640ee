#pragma once

#include <memory>

#include "placements.h"

#ifdef SNUG_BENCH_FCL
#include "peer_fcl.h"
#include "peer_opensubdiv.h"
#endif

namespace snug::bench {

/// Two models as snug queries them.
struct SnugPair {
  LimitSurface a, b;
  Queries queries;
  SnugPair(const Model& model_a, const Model& model_b, const std::shared_ptr<BoundsCache>& library,
           const SurfaceBvhOptions& options = {})
      : a(model_a.mesh, loop_rules(), library),
        b(model_b.mesh, loop_rules(), library),
        queries(a, b, options) {}
};

#ifdef SNUG_BENCH_FCL
/// The model as a uniform mesh, refined until the tolerance is met.
[[nodiscard]] inline TriangleMesh uniform_mesh(const Model& model, double tolerance) {
  return osd_uniform(model.mesh, osd_uniform_level(model.mesh, tolerance));
}

/// The same two as uniform meshes in FCL's trees.
struct FclPair {
  FclModel a, b;
  FclPair(const TriangleMesh& mesh_a, const TriangleMesh& mesh_b, FclBoxes boxes,
          FclBuild build = FclBuild::packaged)
      : a(mesh_a, boxes, build), b(mesh_b, boxes, build) {}
  /// Refined until the tolerance is met.
  FclPair(const Model& model_a, const Model& model_b, double tolerance, FclBoxes boxes)
      : FclPair(uniform_mesh(model_a, tolerance), uniform_mesh(model_b, tolerance), boxes) {}

  [[nodiscard]] bool collide(const PosePair& at) const { return fcl_collide(a, at.a, b, at.b); }
  [[nodiscard]] double distance(const PosePair& at) const { return fcl_distance(a, at.a, b, at.b); }
  [[nodiscard]] std::size_t bytes() const { return a.bytes() + b.bytes(); }
};
#endif

}  // namespace snug::bench
