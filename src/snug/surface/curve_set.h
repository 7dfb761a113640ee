#pragma once

#include <vector>

#include <snug/curves.h>
#include <snug/patch/curve_piece.h>
#include <support/scaling.h>

namespace snug {

/// The contents of a CurveSet. Inside, coordinates are scaled as those of a LimitSurface.
class CurveSet::Edges {
 public:
  Edges(ControlMesh mesh, CurveDegree degree);

  [[nodiscard]] const ControlMesh& mesh() const { return mesh_; }
  [[nodiscard]] CurveDegree degree() const { return degree_; }
  /// From mesh units to scaled ones.
  [[nodiscard]] PowerOfTwo scale() const { return scale_; }
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] std::size_t count() const { return edges_.size(); }
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
