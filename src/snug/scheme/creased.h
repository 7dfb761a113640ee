#pragma once

#include <snug/scheme/creases.h>
#include <snug/scheme/rules.h>

namespace snug {

/// Rules common to Loop and Catmull-Clark: smooth inside, with cubic B-spline curves along creases and
/// boundaries, and corners. [DeRose98]; OpenSubdiv.
class CreasedRules : public SchemeRules {
 public:
  [[nodiscard]] RefinedTopology refine(const RuledMesh& mesh, const WorkMonitor& monitor) const override;
  void add_limit_row(const RuledMesh& mesh, VertexId v, Stencils& out) const override;
  [[nodiscard]] Topology ring(std::span<const CornerFan> fans) const override;
  [[nodiscard]] bool add_corner_limit(const RuledMesh& mesh, HalfEdge corner, Stencils& out) const override;
  void add_corner_tangents(const RuledMesh& mesh, HalfEdge corner, Stencils& out) const override;

  /// The new position of a smooth vertex, times `share`.
  virtual void add_smooth_vertex(const Topology& topology, VertexId v, const Star& star,
                                 const Interval& share, RowBuilder& row) const = 0;
  /// The new point of a smooth edge, times `share`; h has a twin.
  virtual void add_smooth_edge(const Topology& topology, SmoothTriangles triangles, HalfEdge h,
                               const Interval& share, RowBuilder& row) const = 0;

  /// Does a smooth vertex at rest, or a dart, have its limit in its star?
  [[nodiscard]] virtual bool has_limit_in_star(const Topology& topology, const Star& star,
                                               bool dart) const = 0;
  /// The limit of such a vertex.
  virtual void add_smooth_limit(const Topology& topology, VertexId v, const Star& star,
                                Stencils& out) const = 0;
  /// Left eigenvectors of the subdominant eigenvalue: first Fourier modes.
  virtual void add_smooth_tangents(const Topology& topology, const Star& star, Stencils& out) const = 0;

  /// Left eigenvector across a crease with two faces or more in a sector.
  struct AcrossCrease {
    std::vector<double> inner;      ///< weights of the spokes inside
    std::vector<double> diagonals;  ///< of the vertices diagonally across the faces; may be empty
    double end;                     ///< of both spokes at the ends
  };
  [[nodiscard]] virtual AcrossCrease across_crease(std::size_t faces) const = 0;

 protected:
  using SchemeRules::SchemeRules;
};

}  // namespace snug
