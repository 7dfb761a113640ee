#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <snug/independence/weight.h>
#include <snug/mesh.h>

namespace snug {

/// A part of an oriented control mesh: its faces, counterclockwise. Points are 0 to points - 1. Edges of one face are where the
/// part ends, or boundary edges of the mesh.
struct NetPart {
  std::uint32_t points = 0;
  std::vector<std::vector<std::uint32_t>> faces;
  std::set<std::pair<std::uint32_t, std::uint32_t>> boundary = {};  ///< edges, the smaller end first
  std::set<std::uint32_t> corners = {};                             ///< sharp boundary vertices: they stay
};

/// Rules of refinement that chapter 3 of the dissertation distinguishes.
struct ExactScheme {
  Scheme scheme = Scheme::loop;
  bool older_vertices = false;  ///< Catmull-Clark with vertex points (Q + R + 2S)/4, R the mean of neighbours

  [[nodiscard]] bool dual() const { return scheme == Scheme::doo_sabin || scheme == Scheme::midedge; }
};

/// A face at a boundary vertex.
struct BoundaryFace {
  std::uint32_t face = 1;  ///< from 1, of the fan of faces from one boundary edge to the other
  bool corner = false;     ///< the vertex is sharp
};

/// The extraordinary corners of a piece (dual schemes: faces at a vertex): one, or two at the ends of an edge or opposite.
struct PieceCorners {
  std::uint32_t valence = 3;  ///< at a boundary vertex: how many faces it has
  std::optional<std::uint32_t> second = {};
  bool opposite = false;                      ///< across the quad, or the vertex; not with Loop
  std::optional<BoundaryFace> boundary = {};  ///< the only corner is a boundary vertex
};

/// A net one step finer: the points whose masks have all their points, and the faces of those.
struct RefinedNet {
  NetPart net;
  std::vector<WeightRow> rows;  ///< a point
  std::vector<std::optional<std::uint32_t>> of_vertex, of_face;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> of_edge;  ///< the smaller end first
  /// Primal schemes: the fine face, dual ones: the fine point, at (face, its corner); with Loop corner 3 is the middle.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> child;
};

/// One step by exact masks.
///
/// Requires:  a scheme of the four; triangles for Loop; manifold edges; the valence of each irrational mask divides `order`; no
///            boundary with dual schemes.
/// Source:    [Wu05, sec. 2.2 to 2.5].
[[nodiscard]] RefinedNet refine(const NetPart& net, const ExactScheme& scheme, std::uint32_t order);

/// Where the points of a net are in another one that contains it, given an edge of a face of each, in the direction of the
/// face.
/// Requires:  that it does.
[[nodiscard]] std::vector<std::uint32_t> embedded(const NetPart& net, std::array<std::uint32_t, 2> edge,
                                                  const NetPart& larger,
                                                  std::array<std::uint32_t, 2> larger_edge);

/// The control points of a piece with one extraordinary corner of valence n >= 3, as docs/independence.md numbers them, less
/// one: n + 6 (Loop), 2 n + 8 (Catmull-Clark), n + 5 (dual schemes).
[[nodiscard]] NetPart piece_net(const ExactScheme& scheme, std::uint32_t n);
/// Those of a face at a boundary vertex with `faces` faces, all else regular: faces + 7 (Loop), 2 faces + 9 (Catmull-Clark), one
/// less for each of its edges at the vertex that is a boundary edge.
///
/// Requires:  a primal scheme; 1 <= at.face <= faces.
[[nodiscard]] NetPart boundary_net(const ExactScheme& scheme, std::uint32_t faces, const BoundaryFace& at);
/// Those of a piece with two extraordinary corners: the piece's own, counterclockwise, then around them; with dual schemes
/// the vertex, its neighbours, then face by face.
[[nodiscard]] NetPart two_corner_net(const ExactScheme& scheme, const PieceCorners& corners);
/// Those of the n pieces around the corner.
[[nodiscard]] NetPart annulus_net(const ExactScheme& scheme, std::uint32_t n);
/// A closed mesh with corners of valence n: the bipyramid (Loop), the trapezohedron (Catmull-Clark; the cube for n = 3), the
/// prism (dual schemes).
[[nodiscard]] NetPart closed_net(const ExactScheme& scheme, std::uint32_t n);

}  // namespace snug
