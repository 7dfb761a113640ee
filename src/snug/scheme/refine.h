#pragma once

#include <array>

#include <snug/mesh/topology.h>
#include <snug/run.h>
#include <snug/scheme/creases.h>
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
///
/// Catmull-Clark: further the centre of face f is vertex_count + edge_count + f; the corner that half-edge h
/// leaves becomes face h: of a quad with all corners in their places, so that it is a quarter of the square;
/// of other faces from that corner on.
///
///    c3 -- m -- c2
///    |  3  | 2  |
///    m --- f -- m
///    |  0  | 1  |
///    c0 -- m -- c1
///
/// Dual schemes: half-edge h makes the new vertex h, in its face near the vertex it leaves. Faces are first
/// those of the faces, then quads for the edges between two faces, then those of the vertices inside. Rows of
/// points that lie in a face only depend on that face.
struct RefinedTopology {
  Topology topology;
  Sharpness sharpness;
  Stencils stencils;  ///< row r makes new vertex r
};

/// The faces of a primal step alone: of triangles with `corners` 3, else of quads.
[[nodiscard]] Topology split_faces(const Topology& topology, std::size_t corners);
/// Half-edges of it on the halves of h: from h's first vertex to the middle, from there to the second.
[[nodiscard]] std::array<HalfEdge, 2> halves_of(const Topology& topology, std::size_t corners, HalfEdge h);

/// Requires:  a topology that require_subdividable accepts, or a part of one: rules at its rim are those of a
///            boundary.
/// Errors:    Interrupted; InputError (refused) where the step takes more than 2^32 weights.
[[nodiscard]] RefinedTopology refine(const Topology& topology, const SchemeOptions& options,
                                     const Sharpness& sharpness = {}, const WorkMonitor& monitor = {});

/// A refined control mesh, its tags decayed; tags that do not change the surface are left out of it.
/// Requires:  options as with_tags() makes them.
[[nodiscard]] ControlMesh refine(const ControlMesh& mesh, const SchemeOptions& options);
/// The same, of a step that refine() has made. Several steps of a non-manifold mesh need this one:
/// connectivity and sharpness of the step know what the mesh cannot say (Sharpness::vertices_complete).
[[nodiscard]] ControlMesh refined_mesh(const ControlMesh& mesh, const SchemeOptions& options,
                                       const Topology& topology, const RefinedTopology& refined,
                                       const WorkMonitor& monitor = {});

/// Limit position of every vertex; isolated ones give themselves. For dual schemes a vertex stands for the
/// middle of its patch; at the boundary, where there is none, for itself.
/// Errors:    Interrupted.
[[nodiscard]] Stencils limit_stencils(const Topology& topology, const SchemeOptions& options,
                                      const Sharpness& sharpness = {}, const WorkMonitor& monitor = {});

/// Some faces as a mesh of their own.
struct PartOfMesh {
  Topology topology;
  Sharpness sharpness;
  std::vector<VertexId> names;  ///< of its vertices in the whole mesh
  std::vector<FaceId> faces;    ///< likewise
};
/// The faces of these half-edges, one a face, which they begin with. Vertices are numbered as the faces name
/// them.
[[nodiscard]] PartOfMesh part_of(const Topology& topology, const Sharpness& sharpness, BoundaryRule boundary,
                                 std::span<const HalfEdge> firsts);

/// The vertices of such a part alone, and, if asked for, the corners of its faces by their new numbers.
void vertices_of(const Topology& topology, std::span<const HalfEdge> firsts, std::vector<VertexId>& names,
                 std::vector<VertexId>* corners = nullptr);

}  // namespace snug
