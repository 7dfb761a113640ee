#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <snug/mesh/control_mesh.h>

namespace snug {

/// A half-edge is a corner of a face: number h runs from face_vertices[h] to the next vertex of its face.
using HalfEdge = std::uint32_t;
inline constexpr HalfEdge no_half_edge = UINT32_MAX;

/// The half-edges of any mesh, grouped by the undirected edge they lie on; non-manifold edges have more.
///
/// Requires:  vertex ids below vertex_count.
class HalfEdgeGroups {
 public:
  HalfEdgeGroups(std::span<const std::uint32_t> face_offsets, std::span<const VertexId> face_vertices,
                 std::size_t vertex_count);

  [[nodiscard]] std::size_t edge_count() const { return offsets_.size() - 1; }
  [[nodiscard]] std::span<const HalfEdge> of_edge(EdgeId e) const {
    return {members_.data() + offsets_[e.index()], members_.data() + offsets_[e.index() + 1]};
  }
  /// Face that a half-edge belongs to.
  [[nodiscard]] FaceId face(HalfEdge h) const { return faces_[h]; }
  /// Takes the array of faces, one a half-edge, out of the object.
  [[nodiscard]] std::vector<FaceId> take_faces() { return std::move(faces_); }

 private:
  std::vector<std::uint32_t> offsets_;
  std::vector<HalfEdge> members_;  // in rising order within an edge
  std::vector<FaceId> faces_;
};

/// Half-edge after h in its face, a face being the half-edges [offsets[f], offsets[f + 1]).
[[nodiscard]] inline HalfEdge next_in_face(std::span<const std::uint32_t> offsets, FaceId f, HalfEdge h) {
  return h + 1 == offsets[f.index() + 1] ? offsets[f.index()] : h + 1;
}

}  // namespace snug
