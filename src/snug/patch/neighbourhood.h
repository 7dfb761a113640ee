#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include <snug/mesh/topology.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// All that the limit patch of a triangle depends on, but for its control points: how many faces surround
/// each corner.
///
/// Corner i sees the faces around vertex v_i counter-clockwise from the patch's own face: `after` of them,
/// and `before` clockwise, if the vertex lies on a boundary; else the fan is closed and all others are
/// counted in `after`.
struct CornerFan {
  std::uint16_t before = 0, after = 5;
  bool closed = true;
  bool sharp = false;  ///< infinitely sharp corner: stays where it is
  friend auto operator<=>(const CornerFan&, const CornerFan&) = default;
  [[nodiscard]] std::size_t faces() const { return std::size_t{1} + before + after; }
  /// Smooth and as on a regular lattice: six faces inside, three at a boundary.
  [[nodiscard]] bool regular() const { return !sharp && (closed ? after == 5 : faces() == 3); }
};

/// Names a kind: equal keys, equal rows, matrices and bounds. Corners are turned so that the key is the least
/// of the three it could be; reflections are different kinds.
struct KindKey {
  Scheme scheme = Scheme::loop;
  std::array<CornerFan, 3> corners;
  friend auto operator<=>(const KindKey&, const KindKey&) = default;
};

struct KindKeyHash {
  std::size_t operator()(const KindKey& key) const noexcept;
};

/// The kind of one face's patch, and which corner of the face the kind calls its corner 0.
struct TurnedKey {
  KindKey key;
  std::uint8_t first = 0;
};

/// Requires:  a topology that require_subdividable accepts, or one where at least the fans of the face's
///            corners are whole.
/// Cost:      linear in the valences of the corners.
[[nodiscard]] TurnedKey kind_key(const Topology& topology, FaceId face, const SchemeOptions& options);

/// Control vertices of a face's patch, in the order of its kind. Drawn for a regular kind:
///
///                11 -- 10             0 1 2   the corners, 0 being corner `first` of the face
///               /  \  /  \            3 4 5   across the edges 01, 12, 20, where these are not boundary
///              5 --- 2 --- 4          6 ...   for each corner in turn what is left of its ring,
///             / \  /  \  /  \                 counter-clockwise (at a boundary: then clockwise from the
///            6 -- 0 --- 1 -- 9                other side)
///             \  / \  /  \  /
///              7 -- 3 --- 8
///
/// A vertex that stands in two places of the ring by the kind's own structure (valence 3) is listed once; one
/// that does so by accident of a small mesh, twice.
///
/// Cost:      linear in the valences.
void control_vertices(const Topology& topology, FaceId face, std::uint8_t first, std::vector<VertexId>& out);

/// The faces around a patch of this kind as a mesh: face 0 is the patch's own, vertex i its control vertex i.
[[nodiscard]] Topology neighbourhood(const KindKey& key);

/// Rules under which the neighbourhood refines as it does inside its mesh.
[[nodiscard]] SchemeOptions neighbourhood_options(const KindKey& key);

}  // namespace snug
