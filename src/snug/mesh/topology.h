#pragma once

#include <span>
#include <utility>
#include <vector>

#include <snug/mesh/control_mesh.h>
#include <snug/mesh/half_edges.h>

namespace snug {

/// Neighbour relations of a mesh, closed or with boundary. Knows no positions.
///
/// Half-edges are twins where an edge has two faces that run along it in opposite directions. All other edges
/// end the fans of faces at both of their vertices: those of the boundary, and non-manifold ones, which have
/// three faces or more, or two that run along them in the same direction. Where a face runs along an edge
/// again, and where it names a vertex twice in a row, that is an edge of its own, with one face, and
/// non-manifold; and so is the edge that it runs along again. A vertex has one fan if it is manifold.
///
/// Around vertex v, counter-clockwise:
///
///                b
///               / \        h: v -> a            lies in face (v, a, b)
///      h's     /   \       twin(h): a -> v      lies in the face on the other side
///     face    v --> a      ccw(h): v -> b       the next half-edge that leaves v
///                h
///
/// Requires:  faces of three vertices or more, in range; isolated vertices are legal.
/// Cost:      linear time; 20 bytes a half-edge.
class Topology {
 public:
  Topology() = default;
  explicit Topology(const ControlMesh& mesh)
      : Topology(mesh.face_offsets, mesh.face_vertices, mesh.vertex_count()) {}
  Topology(std::vector<std::uint32_t> face_offsets, std::vector<VertexId> face_vertices,
           std::size_t vertex_count);

  [[nodiscard]] std::size_t vertex_count() const { return leaving_.size(); }
  [[nodiscard]] std::size_t edge_count() const { return edge_half_.size(); }
  [[nodiscard]] std::size_t face_count() const { return face_offsets_.size() - 1; }
  [[nodiscard]] std::size_t half_edge_count() const { return face_vertices_.size(); }

  [[nodiscard]] std::span<const VertexId> face(FaceId f) const {
    return {face_vertices_.data() + face_offsets_[f.index()],
            face_vertices_.data() + face_offsets_[f.index() + 1]};
  }
  /// If all faces have the same number n of corners, n, else 0: face f has the half-edges n f to n f + n - 1.
  [[nodiscard]] HalfEdge uniform_size() const { return uniform_size_; }
  /// First half-edge of a face: from its corner 0 to its corner 1.
  [[nodiscard]] HalfEdge first_of(FaceId f) const { return face_offsets_[f.index()]; }
  [[nodiscard]] FaceId face_of(HalfEdge h) const { return faces_[h]; }
  [[nodiscard]] EdgeId edge_of(HalfEdge h) const { return edges_[h]; }
  [[nodiscard]] VertexId from(HalfEdge h) const { return face_vertices_[h]; }
  [[nodiscard]] VertexId to(HalfEdge h) const { return face_vertices_[next(h)]; }
  [[nodiscard]] HalfEdge next(HalfEdge h) const {
    if (uniform_size_ == 3) return h % 3 == 2 ? h - 2 : h + 1;
    return next_in_face(face_offsets_, faces_[h], h);
  }
  [[nodiscard]] HalfEdge prev(HalfEdge h) const {
    if (uniform_size_ == 3) return h % 3 == 0 ? h + 2 : h - 1;
    const std::size_t f = faces_[h].index();
    return h == face_offsets_[f] ? face_offsets_[f + 1] - 1 : h - 1;
  }
  /// Opposite half-edge, or no_half_edge at the boundary.
  [[nodiscard]] HalfEdge twin(HalfEdge h) const { return twins_[h]; }
  /// Next half-edge that leaves the same vertex, counter-clockwise; no_half_edge past the last face.
  [[nodiscard]] HalfEdge ccw(HalfEdge h) const { return twins_[prev(h)]; }
  /// Clockwise; no_half_edge if h itself lies on the boundary.
  [[nodiscard]] HalfEdge cw(HalfEdge h) const {
    return twins_[h] == no_half_edge ? no_half_edge : next(twins_[h]);
  }

  /// One half-edge of an edge; the lower-numbered one.
  [[nodiscard]] HalfEdge half_of(EdgeId e) const { return edge_half_[e.index()]; }
  /// A half-edge that leaves v: in an open fan the clockwise-most one, so that ccw() walks the whole fan.
  /// no_half_edge for an isolated vertex.
  [[nodiscard]] HalfEdge leaving(VertexId v) const { return leaving_[v.index()]; }
  /// Other half-edges that leave v, one a further fan of a non-manifold vertex, each as leaving() has it.
  [[nodiscard]] std::vector<HalfEdge> more_fans(VertexId v) const;
  /// The half-edges on a non-manifold edge beside half_of(e).
  [[nodiscard]] std::vector<HalfEdge> more_halves(EdgeId e) const;

  /// Has the edge one face?
  [[nodiscard]] bool on_boundary(EdgeId e) const {
    return ends_fans(e) && (is_manifold() || more_halves(e).empty());
  }
  /// Is the edge on the boundary or non-manifold?
  [[nodiscard]] bool ends_fans(EdgeId e) const { return twins_[half_of(e)] == no_half_edge; }
  [[nodiscard]] bool is_manifold(EdgeId e) const;
  [[nodiscard]] bool isolated(VertexId v) const { return leaving(v) == no_half_edge; }
  /// Is one of the vertex's edges on the boundary?
  [[nodiscard]] bool on_boundary(VertexId v) const;
  /// One fan at most, and no non-manifold edge.
  [[nodiscard]] bool is_manifold(VertexId v) const;
  /// All edges and vertices are.
  [[nodiscard]] bool is_manifold() const {
    return more_halves_.empty() && more_fans_.empty() && odd_.empty();
  }
  /// Number of faces around a vertex.
  [[nodiscard]] std::size_t face_valence(VertexId v) const { return face_counts_[v.index()]; }

  /// Calls visit(h) for the half-edges that leave v in the fan of `start`, counter-clockwise from there.
  template <class Visit>
  void walk_fan(HalfEdge start, Visit&& visit) const {
    HalfEdge h = start;
    do {
      visit(h);
      h = ccw(h);
    } while (h != no_half_edge && h != start);
  }
  /// Calls visit(start) for each fan of v.
  template <class Visit>
  void for_each_fan(VertexId v, Visit&& visit) const {
    if (isolated(v)) return;
    visit(leaving(v));
    if (more_fans_.empty()) return;
    for (const HalfEdge h : more_fans(v)) visit(h);
  }

 private:
  void find_fans();
  [[nodiscard]] std::vector<VertexId> vertices_of_more_fans() const;

  std::vector<std::uint32_t> face_offsets_{0};
  HalfEdge uniform_size_ = 0;
  std::vector<VertexId> face_vertices_;
  std::vector<FaceId> faces_;
  std::vector<HalfEdge> twins_;
  std::vector<EdgeId> edges_;
  std::vector<HalfEdge> edge_half_;
  std::vector<HalfEdge> leaving_;
  std::vector<std::uint32_t> face_counts_;  // of vertices
  // All in rising order.
  std::vector<std::pair<EdgeId, HalfEdge>> more_halves_;
  std::vector<std::pair<VertexId, HalfEdge>> more_fans_;
  std::vector<EdgeId> odd_;  // non-manifold for what a face does with them
};

}  // namespace snug
