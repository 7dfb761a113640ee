#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <snug/bvh/obb.h>
#include <snug/surface/limit_surface.h>
#include <support/compact_numbering.h>

namespace snug {

/// Some patches, known by their control points alone: a set that contains them and costs no rows. For each
/// patch it is (1 - w) times the hull of its face's corners plus w times the hull of all control points, w
/// being outer_weight() of its kind.
///
/// Guarantee: contains the patches, rounding included.
/// Source:    derivations/boxes.md.
class ControlHull {
 public:
  /// Keeps its memory from one set to the next.
  void assign(const LimitSurface& surface, std::span<const PatchId> patches);

  [[nodiscard]] Extent extent(const Vector3& direction) const;
  /// A box around them, along the principal axes of the corners of their faces.
  [[nodiscard]] Obb box() const;

 private:
  friend class ControlNets;  // keeps these lists

  CompactNumbering numbers_;
  std::vector<VertexId> corners_, vertices_;  // those of faces, and all, corners first
  std::vector<Point3> points_;                // of vertices_
  std::size_t inner_count_ = 0;
  // Indices into points_ and where each list ends: of faces a corner, of corners a patch.
  std::vector<std::uint32_t> ring_, ring_ends_, patch_, patch_ends_;
  std::vector<double> weights_;  // of each patch
  double largest_ = 0;
  mutable std::vector<double> heights_;
  mutable std::vector<Extent> rings_;
};

/// A ball around each patch, from its control points too: looser, and much cheaper.
[[nodiscard]] std::vector<Ball> control_balls(const LimitSurface& surface, std::span<const PatchId> patches);

}  // namespace snug
