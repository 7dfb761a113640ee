#pragma once

#include <vector>

#include <snug/mesh/topology.h>
#include <snug/scheme/scheme.h>
#include <snug/scheme/stencils.h>

namespace snug {

/// One step of subdivision of a whole mesh: connectivity, and how new points come from old ones.
///
/// Loop: vertex v keeps its number, the point of edge e is vertex_count + e; face f = (c0, c1, c2) becomes
///
///            c2             4f + k  keeps corner k of f in its own corner k,
///           /  \            4f + 3  is the middle one, its corner k facing corner k of f:
///          / 2  \                   (m12, m20, m01), so it is turned by half a turn.
///       m20 --- m12
///       / \  3  / \         Isolated vertices stay, and keep their place.
///      / 0 \   / 1 \        .
///    c0 --- m01 --- c1
struct RefinedTopology {
  Topology topology;
  Stencils stencils;  ///< row r makes new vertex r
};

/// Requires:  a topology that require_subdividable accepts, or a part of one: rules at its rim are those of a
///            boundary.
/// Cost:      linear.
[[nodiscard]] RefinedTopology refine(const Topology& topology, const SchemeOptions& options);

/// Limit position of every vertex; rows of isolated vertices and, with BoundaryRule::none, of boundary
/// vertices give the vertex itself.
[[nodiscard]] Stencils limit_stencils(const Topology& topology, const SchemeOptions& options);

/// Adds the limit row of one vertex to `out`.
void add_limit_row(const Topology& topology, VertexId v, const SchemeOptions& options, Stencils& out);

/// Two rows whose images span the tangent plane at the limit of v, wherever there is one: the limits of the
/// directions, of no particular length. Counter-clockwise: their cross product points to the side from which
/// faces look counter-clockwise. At a boundary the first runs along it.
/// Source:    left eigenvectors of the local subdivision matrix, derivations/loop_limits.md.
struct TangentRows {
  Stencils rows;  ///< two rows; their weights sum to 0, not 1
};
[[nodiscard]] TangentRows tangent_rows(const Topology& topology, VertexId v, const SchemeOptions& options);

/// Does the rule make this vertex an infinitely sharp corner?
[[nodiscard]] bool is_sharp_corner(const Topology& topology, VertexId v, const SchemeOptions& options);

/// A refined control mesh. Tags that do not change the surface are left out of it, but for the boundary rule.
[[nodiscard]] ControlMesh refine(const ControlMesh& mesh, const SchemeOptions& options);

}  // namespace snug
