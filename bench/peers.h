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
      : a(model_a.mesh, loop_rules(), library, 1),
        b(model_b.mesh, loop_rules(), library, 1),
        queries(a, b, options) {}
};

#ifdef SNUG_BENCH_FCL
/// The same two as uniform meshes in FCL's trees.
struct FclPair {
  FclModel a, b;
  FclPair(const TriangleMesh& mesh_a, const TriangleMesh& mesh_b, FclBoxes boxes)
      : a(mesh_a, boxes), b(mesh_b, boxes) {}
  /// Refined until the tolerance is met.
  FclPair(const Model& model_a, const Model& model_b, double tolerance, FclBoxes boxes)
      : FclPair(osd_uniform(model_a.mesh, osd_uniform_level(model_a.mesh, tolerance)),
                osd_uniform(model_b.mesh, osd_uniform_level(model_b.mesh, tolerance)), boxes) {}

  [[nodiscard]] bool collide(const PosePair& at) const { return fcl_collide(a, at.a, b, at.b); }
  [[nodiscard]] double distance(const PosePair& at) const { return fcl_distance(a, at.a, b, at.b); }
  [[nodiscard]] std::size_t bytes() const { return a.bytes() + b.bytes(); }
};
#endif

}  // namespace snug::bench
