#pragma once

#include <vector>

#include <snug/mesh/control_mesh.h>
#include <snug/patch/curve_piece.h>
#include <support/scaling.h>

namespace snug {

/// The limit curves of a mesh's polylines. Immutable; may be read by many threads. Edges are counted along
/// the polylines, one polyline after the other; the closing edge of a closed one is its last.
///
/// Inside, coordinates are scaled as those of a LimitSurface.
///
/// Errors:    InputError (refused) from require_curves.
/// Cost:      linear; 16 bytes an edge beside the mesh.
class CurveSet {
 public:
  CurveSet(ControlMesh mesh, CurveDegree degree);

  [[nodiscard]] const ControlMesh& mesh() const { return mesh_; }
  [[nodiscard]] CurveDegree degree() const { return degree_; }
  /// From mesh units to scaled ones.
  [[nodiscard]] PowerOfTwo scale() const { return scale_; }
  /// Longest side of the box of the vertices that polylines use, in mesh units; may overflow to infinity.
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] std::size_t edge_count() const { return edges_.size(); }
  /// The whole piece of an edge, in scaled units.
  [[nodiscard]] CurvePiece piece(EdgeId edge) const;

 private:
  struct Window {
    VertexId before, from, to, after;  // not valid() at open ends
  };
  ControlMesh mesh_;
  CurveDegree degree_;
  PowerOfTwo scale_;
  double size_ = 0;
  std::vector<Window> edges_;
};

}  // namespace snug
