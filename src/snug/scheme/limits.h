#pragma once

#include <snug/monitor.h>
#include <snug/scheme/creases.h>
#include <snug/scheme/scheme.h>
#include <snug/scheme/stencils.h>

namespace snug {

/// Limit position of every vertex; rows of isolated vertices give the vertex itself. For dual schemes a vertex stands for the middle of its patch; at the boundary, where
/// there is none, for itself.
/// Errors:    Interrupted.
[[nodiscard]] Stencils limit_stencils(const Topology& topology, const SchemeOptions& options,
                                      const Sharpness& sharpness = {}, const WorkMonitor& monitor = {});

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
