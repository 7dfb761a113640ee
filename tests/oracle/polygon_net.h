#pragma once

#include <oracle/loop_net.h>
#include <oracle/tagged_mesh.h>

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

/// Catmull-Clark and Loop refinement of polygon nets with sharpness, in 113-bit floating point. Internal to
/// polygon_twin.
namespace oracle::detail {

using QuadPoint = std::array<Quad, 3>;

/// A sum of weighted points of another net, which need not be in order nor each once; weights are off by some
/// units of roundoff of a double.
struct SparseRow {
  std::vector<std::pair<std::uint32_t, double>> terms;
};

struct NetEdge {
  std::uint32_t a, b;
  Quad sharpness;
};
/// Edge k runs from vertex k to vertex k + 1.
struct NetFace {
  std::vector<std::uint32_t> vertices, edges;
};
/// A net with edges of their own, since two edges may join the same vertices: the children of an edge from a
/// vertex to itself do, and so do inner edges of two Loop triangles with two common edges.
/// P: QuadPoint, or SparseRow for what refinement does whatever the points are.
template <class P>
struct NetOf {
  using Edge = NetEdge;
  using Face = NetFace;
  std::vector<P> points;
  std::vector<Quad> sharpness;  // of the vertices themselves
  std::vector<Edge> edges;
  std::vector<Face> faces;
};
using PolygonNet = NetOf<QuadPoint>;

/// Who touches whom. A face is listed once for each of its corners, an edge once for each of its ends.
struct Neighbours {
  std::vector<std::vector<std::uint32_t>> vertex_edges, vertex_faces, edge_faces;
  template <class P>
  explicit Neighbours(const NetOf<P>& net) : Neighbours(net.points.size(), net.edges, net.faces) {}
  Neighbours(std::size_t vertex_count, const std::vector<NetEdge>& edges, const std::vector<NetFace>& faces);
};

/// The control net, with boundaries and non-manifold places made sharp, and the faces that have a surface.
///
/// Source: OpenSubdiv 3.5, Far::TopologyRefinerFactoryBase and Vtr::Level: a second edge between two vertices
///         arises where one face would run along it twice; an edge is non-manifold if it is one of those,
///         joins a vertex to itself, has more than two faces or two that run along it the same way; a vertex
///         is if one of its edges is or its corners are not one fan.
struct ControlNet {
  PolygonNet net;
  std::vector<char> has_surface;
};
[[nodiscard]] ControlNet control_net(const TaggedMesh& mesh, const Rules& rules);

/// Which mask moves a vertex. `ends` are its two sharp edges if it is a crease.
enum class Rule : std::uint8_t { smooth, dart, crease, corner };

/// One step. The child faces of a face follow each other.
///
/// Catmull-Clark: child k holds corner k; it is (corner, edge point, face point, edge point before), turned
///                for a parent with four corners so that the corner is number k again.
/// Loop:          corner children 0, 1, 2 as child_corners() says, then the centre.
/// Child vertices: those of faces (Catmull-Clark), of edges, of vertices, in this order.
template <class P>
[[nodiscard]] NetOf<P> refine(const NetOf<P>& net, const Rules& rules);
extern template PolygonNet refine(const PolygonNet&, const Rules&);
extern template NetOf<SparseRow> refine(const NetOf<SparseRow>&, const Rules&);

/// Limit positions of the `wanted` vertices; `error` is how far they are off beyond rounding.
struct Limits {
  std::vector<QuadPoint> points;
  std::vector<Quad> error;
};
[[nodiscard]] Limits limit_points(const PolygonNet& net, const Rules& rules, const std::vector<char>& wanted);

/// The limit of a vertex where a closed formula is known and its masks stay the same from here on.
template <class P>
[[nodiscard]] std::optional<P> limit_in_star(const NetOf<P>& net, const Neighbours& near, std::uint32_t v,
                                             const Rules& rules);
extern template std::optional<QuadPoint> limit_in_star(const PolygonNet&, const Neighbours&, std::uint32_t,
                                                       const Rules&);
extern template std::optional<SparseRow> limit_in_star(const NetOf<SparseRow>&, const Neighbours&,
                                                       std::uint32_t, const Rules&);

/// sum += weight * p
inline void add(QuadPoint& sum, const Quad& weight, const QuadPoint& p) {
  for (std::size_t x = 0; x < 3; ++x) sum[x] += weight * p[x];
}
inline void add(SparseRow& sum, const Quad& weight, const SparseRow& p) {
  const double factor = static_cast<double>(weight);
  for (const auto& [i, w] : p.terms) sum.terms.emplace_back(i, factor * w);
}
inline void divide(QuadPoint& p, const Quad& by) {
  for (Quad& x : p) x /= by;
}
inline void divide(SparseRow& p, const Quad& by) {
  const double divisor = static_cast<double>(by);
  for (auto& [i, w] : p.terms) w /= divisor;
}

/// Rule of a vertex from its own sharpness and that of its edges.
[[nodiscard]] Rule vertex_rule(const Quad& own, const std::vector<Quad>& edges);

}  // namespace oracle::detail
