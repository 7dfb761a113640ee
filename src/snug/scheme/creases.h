#pragma once

#include <vector>

#include <snug/mesh/topology.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// Sharpness of edges and vertices beyond what connectivity alone makes infinitely sharp. Empty: 0.
struct Sharpness {
  std::vector<double> edges, vertices;
  /// Do `vertices` say all of their sharpness, and connectivity no more? So after a step from a non-manifold
  /// mesh: what made a vertex sharp may be gone, and the middle of a non-manifold edge is no corner.
  bool vertices_complete = false;
  [[nodiscard]] bool none() const { return edges.empty() && vertices.empty(); }
  friend bool operator==(const Sharpness&, const Sharpness&) = default;
};

/// Sets one of `count` entries, which are kept only where one is not 0.
void set_sharpness(std::vector<double>& entries, std::size_t count, std::size_t i, double sharpness);

[[nodiscard]] constexpr bool is_semi_sharp(double s) { return s > 0 && s < infinite_sharpness; }

/// A mesh as the rules of a scheme see it.
struct RuledMesh {
  const Topology& topology;
  const SchemeOptions& options;
  const Sharpness& sharpness;
};

/// The tags of a mesh. Tags on edges that are no edges of it, and of sharpness 0, are passed over; the last
/// tag of an edge or vertex counts.
/// Requires:  tags without defects (mesh/validate.h).
[[nodiscard]] Sharpness sharpness_of(const ControlMesh& mesh, const Topology& topology);

/// With BoundaryRule::none: does a face lose its surface? So it is at a vertex with a boundary edge, unless
/// that is tagged infinitely sharp.
[[nodiscard]] bool loses_surface(const Topology& topology, const Sharpness& sharpness, FaceId f);

/// Sharpness that the rules go by: infinite on the boundary and on non-manifold edges.
[[nodiscard]] double edge_sharpness(const Topology& topology, const Sharpness& sharpness, EdgeId e);
/// Infinite at corners of the boundary, where its rule makes them, and at non-manifold vertices, but those on
/// a curve: of two non-manifold edges, no boundary edge, and more faces than edges.
/// Source:    OpenSubdiv's Far::TopologyRefinerFactory.
[[nodiscard]] double vertex_sharpness(const Topology& topology, const Sharpness& sharpness, VertexId v,
                                      BoundaryRule boundary);

/// An edge as one of its vertices sees it.
struct Spoke {
  EdgeId edge;
  VertexId end;
  double sharpness;
};

/// Edges around a vertex, as the rules read them. In a fan spokes are counter-clockwise, those of an open one from its
/// first to its last; each edge once.
struct Star {
  std::vector<Spoke> spokes;
  std::vector<HalfEdge> faces;  ///< half-edges that leave the vertex, one a face
  double sharpness = 0;         ///< of the vertex
};

/// Writes the star over `out`, which keeps its memory.
void gather_star(const RuledMesh& mesh, VertexId v, Star& out);

/// Calls visit(h) for the half-edges that leave v, fan after fan.
template <class Visit>
void walk_fans(const Topology& topology, VertexId v, const Visit& visit) {
  topology.for_each_fan(v, [&](HalfEdge start) { topology.walk_fan(start, visit); });
}
/// Calls visit(edge, other end) for the two edges at v of each of its faces.
template <class Visit>
void walk_edges(const Topology& topology, VertexId v, const Visit& visit) {
  walk_fans(topology, v, [&](HalfEdge h) {
    const HalfEdge in = topology.prev(h);
    visit(topology.edge_of(h), topology.to(h));
    visit(topology.edge_of(in), topology.from(in));
  });
}

enum class VertexRule : std::uint8_t { corner, crease, smooth };

/// Corner: own sharpness, or three sharp edges and more; crease: two; smooth: fewer, a dart being smooth.
[[nodiscard]] VertexRule vertex_rule(double own, std::span<const Spoke> spokes);
[[nodiscard]] inline VertexRule vertex_rule(const Star& star) {
  return vertex_rule(star.sharpness, star.spokes);
}

/// Sharpness after one step: less by 1. Infinite ones stay.
[[nodiscard]] double decayed(double sharpness);
/// Of a spoke, on the half of the edge at the star's vertex. Chaikin first mixes in a quarter of the mean of
/// the other semi-sharp spokes. These sums are meant in doubles, from the least sharpness up, as OpenSubdiv means
/// them in floats.
/// Source:    [DeRose98, sec. 3]; OpenSubdiv's Sdc::Crease.
[[nodiscard]] double decayed(const Star& star, const Spoke& spoke, CreaseMethod method);

/// With Chaikin the half of an edge at its far end depends on what is semi-sharp there, and with it the
/// middle of the edge (whether both halves stay sharp) and all that follows at this end. Adds to `out` the
/// ends of semi-sharp spokes of v at which other edges are semi-sharp, too; none with the uniform method.
void add_far_ends(const RuledMesh& mesh, VertexId v, std::vector<VertexId>& out);

/// Is everything here at rest: no sharpness that decays?
[[nodiscard]] bool is_stationary(const Star& star);

}  // namespace snug
