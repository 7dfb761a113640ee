#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include <snug/mesh/topology.h>
#include <snug/scheme/creases.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// How many faces surround a corner of a patch.
///
/// The corner sees the faces around its vertex counter-clockwise from the patch's own face: `after` of them,
/// and `before` clockwise, if the fan is open; else it is closed and all others are counted in `after`. A fan ends at a
/// boundary, at a non-manifold edge, and at an infinitely sharp edge where the vertex is a corner or a crease: what lies
/// beyond does not matter. Dual schemes: the vertices of the face at the corner, beside the patch's own.
struct CornerFan {
  std::uint16_t before = 0, after = 5;
  bool closed = true;
  bool sharp = false;  ///< infinitely sharp corner: stays where it is
  bool odd = false;    ///< a dart, or a crease that runs through other sheets
  friend auto operator<=>(const CornerFan&, const CornerFan&) = default;
  [[nodiscard]] std::size_t faces() const { return std::size_t{1} + before + after; }
  /// Is the surface near the corner as on a regular lattice?
  [[nodiscard]] bool regular(Scheme scheme) const {
    if (odd) return false;
    if (scheme == Scheme::loop) return !sharp && (closed ? after == 5 : faces() == 3);
    return closed ? !sharp && after == 3 : faces() == (sharp ? 1u : 2u);
  }
};

/// Names a kind: equal keys, equal rows, matrices and bounds. All that a limit patch depends on, but for its control
/// points.
///
/// Every patch is a triangle. Loop: the face, its corners turned so that the key is the least of the three it could be;
/// reflections are different kinds. Other schemes: half a quad, from its corner 0 by 1 to 2; `corners` are those of the
/// quad. Dual schemes: the quad that has the faces around a vertex of valence 4 as corners.
///
/// Where fans do not say everything, `details` hold the faces around the patch and what is sharp there, and `corners`
/// what the corners will be when all that decays has decayed. A `polygon` is a whole face of Catmull-Clark that is no
/// quad, or a vertex of a dual scheme of another valence than 4: no patch, but it splits into some.
struct KindKey {
  Scheme scheme = Scheme::loop;
  std::array<CornerFan, 4> corners;  ///< Loop: the last one stays as it is here
  bool polygon = false;
  std::vector<std::uint32_t> details{};
  friend auto operator<=>(const KindKey&, const KindKey&) = default;
  [[nodiscard]] bool plain() const { return details.empty(); }
};

struct KindKeyHash {
  std::size_t operator()(const KindKey& key) const noexcept;
};

/// The kind of a patch, and which corner of its face the kind calls its corner 0.
struct TurnedKey {
  KindKey key;
  std::uint8_t first = 0;
};

/// The kind of a Loop face.
///
/// Requires:  a topology that require_subdividable accepts, or one where at least the fans of the face's
///            corners are whole.
/// Cost:      linear in the valences of the corners.
[[nodiscard]] TurnedKey kind_key(const Topology& topology, FaceId face, const SchemeOptions& options,
                                 const Sharpness& sharpness = {});

/// The kind that begins at a half-edge: of the face that it belongs to, with the corner it leaves as corner 0; for dual
/// schemes of the vertex it leaves, with its face as corner 0.
[[nodiscard]] KindKey kind_key_from(const Topology& topology, HalfEdge start, const SchemeOptions& options,
                                    const Sharpness& sharpness = {});

/// Control vertices of a patch of this kind at the same place, in the order of the kind. Drawn for a regular kind of Loop
/// and of Catmull-Clark:
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
/// Dual schemes: the vertex, the far ends of its edges, then the rest of each face, from `start` on.
///
/// A vertex that stands in two places of the ring by the kind's own structure (valence 3) is listed once; one
/// that does so by accident of a small mesh, twice. With `details`, as the faces there name them, each once.
///
/// Cost:      linear in the valences.
void control_vertices(const Topology& topology, HalfEdge start, const KindKey& key,
                      std::vector<VertexId>& out);
/// The same for a Loop face.
void control_vertices(const Topology& topology, FaceId face, std::uint8_t first, const KindKey& key,
                      std::vector<VertexId>& out);

/// The faces around a patch of this kind as a mesh: face 0 is the patch's own (dual schemes: vertex 0, which the first
/// half-edge of each face leaves), vertex i its control vertex i.
struct Neighbourhood {
  Topology topology;
  Sharpness sharpness;
  SchemeOptions options;  ///< under which it refines as it does inside its mesh
};
[[nodiscard]] Neighbourhood neighbourhood(const KindKey& key);

}  // namespace snug
