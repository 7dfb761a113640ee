#pragma once

#include <oracle/loop_net.h>
#include <oracle/tagged_mesh.h>

#include <array>
#include <cstdint>
#include <vector>

/// Catmull-Clark and Loop refinement of polygon nets with sharpness, in 113-bit floating point. Internal to
/// polygon_twin.
namespace oracle::detail {

using QuadPoint = std::array<Quad, 3>;

/// A net with edges of their own, since two edges may join the same vertices: the children of an edge from a
/// vertex to itself do, and so do inner edges of two Loop triangles with two common edges.
struct PolygonNet {
  struct Edge {
    std::uint32_t a, b;
    Quad sharpness;
  };
  /// Edge k runs from vertex k to vertex k + 1.
  struct Face {
    std::vector<std::uint32_t> vertices, edges;
  };
  std::vector<QuadPoint> points;
  std::vector<Quad> sharpness;  // of the vertices themselves
  std::vector<Edge> edges;
  std::vector<Face> faces;
};

/// Who touches whom. A face is listed once for each of its corners, an edge once for each of its ends.
struct Neighbours {
  std::vector<std::vector<std::uint32_t>> vertex_edges, vertex_faces, edge_faces;
  explicit Neighbours(const PolygonNet& net);
};

/// The control net, with boundaries and non-manifold places made sharp, and the faces that have a surface.
///
/// Source: OpenSubdiv 3.5, Far::TopologyRefinerFactoryBase and Vtr::Level: a second edge between two vertices
///         arises where one face would run along it twice; an edge is non-manifold if it is one of those, joins
///         a vertex to itself, has more than two faces or two that run along it the same way; a vertex is if
///         one of its edges is or its corners are not one fan.
struct ControlNet {
  PolygonNet net;
  std::vector<char> has_surface;
};
[[nodiscard]] ControlNet control_net(const TaggedMesh& mesh, const Rules& rules);

/// Which mask moves a vertex. `ends` are its two sharp edges if it is a crease.
enum class Rule : std::uint8_t { smooth, dart, crease, corner };

/// One step. The child faces of a face follow each other.
///
/// Catmull-Clark: child k holds corner k; it is (corner, edge point, face point, edge point before), turned for
///                a parent with four corners so that the corner is number k again.
/// Loop:          corner children 0, 1, 2 as child_corners() says, then the centre.
/// Child vertices: those of faces (Catmull-Clark), of edges, of vertices, in this order.
[[nodiscard]] PolygonNet refine(const PolygonNet& net, const Rules& rules);

/// Limit positions of the `wanted` vertices; `error` is how far they are off beyond rounding.
struct Limits {
  std::vector<QuadPoint> points;
  std::vector<Quad> error;
};
[[nodiscard]] Limits limit_points(const PolygonNet& net, const Rules& rules, const std::vector<char>& wanted);

/// Rule of a vertex from its own sharpness and that of its edges.
[[nodiscard]] Rule vertex_rule(const Quad& own, const std::vector<Quad>& edges);

}  // namespace oracle::detail
