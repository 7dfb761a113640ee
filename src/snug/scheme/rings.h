#pragma once

#include <compare>
#include <cstdint>
#include <span>

#include <snug/mesh/topology.h>

/// The faces around a patch as a mesh of their own, by what its corners see. Drawn for a regular triangle and
/// quad:
///
///                11 -- 10             0 1 2   the corners, 0 being corner `first` of the face
///               /  \  /  \            3 4 5   across the edges 01, 12, 20, where these are not boundary
///              5 --- 2 --- 4          6 ...   for each corner in turn what is left of its ring,
///             / \  /  \  /  \                 counter-clockwise (at a boundary: then clockwise from the
///            6 -- 0 --- 1 -- 9                other side)
///             \  / \  /  \  /
///              7 -- 3 --- 8
///
///          15 -- 9 -- 8 -- 14         0 1 2 3   the corners
///           |    |    |    |          4 ...     across the edges 01, 12, 23, 30 two each
///          10 -- 3 -- 2 -- 7          12 ...    the rest as above
///           |    |    |    |
///          11 -- 0 -- 1 -- 6
///           |    |    |    |
///          12 -- 4 -- 5 -- 13
///
/// A vertex that stands in two places of the ring by the kind's own structure (valence 3) is one.
namespace snug {

/// How many faces surround a corner of a patch.
///
/// The corner sees the faces around its vertex counter-clockwise from the patch's own face: `after` of them,
/// and `before` clockwise, if the fan is open; else it is closed and all others are counted in `after`. A fan
/// ends at a boundary, at a non-manifold edge, and at an infinitely sharp edge where the vertex is a corner
/// or a crease: what lies beyond does not matter. Dual schemes: the vertices of the face at the corner,
/// beside the patch's own.
struct CornerFan {
  std::uint16_t before = 0, after = 5;
  bool closed = true;
  bool sharp = false;  ///< infinitely sharp corner: stays where it is
  bool odd = false;    ///< a dart, or a crease that runs through other sheets
  friend auto operator<=>(const CornerFan&, const CornerFan&) = default;
  [[nodiscard]] std::size_t faces() const { return std::size_t{1} + before + after; }
};

/// Of a face of fans.size() corners, 3 or 4, among faces of as many.
[[nodiscard]] Topology ring_of_face(std::span<const CornerFan> fans);

/// Of a vertex, in the order of its faces: the vertex, the far ends of its edges, then the rest of each face.
[[nodiscard]] Topology ring_of_vertex(std::span<const CornerFan> fans);

}  // namespace snug
