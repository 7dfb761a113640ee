#pragma once

#include <snug/base/progress.h>
#include <snug/scheme/creases.h>
#include <snug/scheme/scheme.h>
#include <snug/scheme/stencils.h>

namespace snug {

/// Limit position of every vertex; rows of isolated vertices give the vertex itself. For dual schemes a vertex stands for the middle of its patch; at the boundary, where
/// there is none, for itself.
/// Errors:    Interrupted.
[[nodiscard]] Stencils limit_stencils(const Topology& topology, const SchemeOptions& options,
                                      const Sharpness& sharpness = {}, const WorkMonitor& monitor = {});

/// Adds the limit row of one vertex to `out`, if it can be read off the star of the vertex: where nothing decays any more,
/// and with Catmull-Clark among quads. Returns whether it could.
/// Requires:  a primal scheme and a vertex that is not isolated.
[[nodiscard]] bool add_settled_limit_row(const Topology& topology, VertexId v, const SchemeOptions& options,
                                         const Sharpness& sharpness, Stencils& out);

/// Adds the limit row of one vertex to `out`.
/// Cost:      where sharpness decays, or among polygons that are no quads, the star is refined until that ends.
void add_limit_row(const Topology& topology, VertexId v, const SchemeOptions& options,
                   const Sharpness& sharpness, Stencils& out);

/// Two rows whose images span the tangent plane at the limit of v, wherever there is one: the limits of the
/// directions, of no particular length. Counter-clockwise: their cross product points to the side from which
/// faces look counter-clockwise. At a boundary the first runs along it.
/// Requires:  a primal scheme; at a crease inside a mesh `side`, a half-edge that leaves v, says in which sector.
/// Source:    left eigenvectors of the local subdivision matrix, derivations/loop_limits.md, catmark_limits.md.
struct TangentRows {
  Stencils rows;  ///< two rows; their weights sum to 0, not 1
};
[[nodiscard]] TangentRows tangent_rows(const Topology& topology, VertexId v, const SchemeOptions& options,
                                       const Sharpness& sharpness = {}, HalfEdge side = no_half_edge);

/// The faces around some vertices, as a mesh of their own.
struct PartOfMesh {
  Topology topology;
  Sharpness sharpness;          ///< of the edges and of the `around` vertices
  std::vector<VertexId> names;  ///< of its vertices in the whole mesh
  std::vector<FaceId> faces;    ///< likewise
};
/// Requires:  faces without doubles. Vertices are numbered as the faces name them, face after face from its first.
/// `firsts`: half-edges, one a face, that the part's faces begin with.
[[nodiscard]] PartOfMesh part_of(const Topology& topology, const Sharpness& sharpness, BoundaryRule boundary,
                                 std::span<const HalfEdge> firsts);

/// The vertices of such a part alone, and, if asked for, the corners of its faces by their new numbers.
void vertices_of(const Topology& topology, std::span<const HalfEdge> firsts, std::vector<VertexId>& names,
                 std::vector<VertexId>* corners = nullptr);

}  // namespace snug
