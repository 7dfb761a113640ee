#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <snug/basis/layout.h>
#include <snug/mesh/control_mesh.h>
#include <snug/scheme/scheme.h>

/// Control nets around one extraordinary vertex, and what bounds them: the input of the experiments
/// (convergence.h, tightness.h).
namespace snug {

/// A vertex of valence n in the middle of `rings` rings of a flat lattice: the vertex is at the origin,
/// spokes have length 1. Faces 0 to n - 1 touch it, with their corner 0. Regular but for the middle and the
/// border.
///
/// Requires:  n >= 3; rings >= 1, and 2 if the faces in the middle are to have no boundary.
[[nodiscard]] ControlMesh fan_mesh(std::size_t n, std::size_t rings);

/// The same of quads: `rings` rings around a vertex of valence n. Faces touch it with their corner 0; face 0
/// is one of them.
///
/// Requires:  n >= 3; rings >= 1.
[[nodiscard]] ControlMesh quad_fan_mesh(std::size_t n, std::size_t rings);

/// A face of n vertices, which is face 0, in the middle of a ring of quads; its vertices are 0 to n - 1, of
/// valence 4.
///
/// Requires:  n >= 3.
[[nodiscard]] ControlMesh polygon_mesh(std::size_t n);

/// Moves every vertex by at most `along` in x and y, and by at most `across` in z, evenly distributed.
void disturb(ControlMesh& mesh, double along, double across, std::uint64_t seed);

/// Shapes of nets with one extraordinary vertex and two rings around it.
enum class NetShape : std::uint8_t {
  bent,   ///< on a smooth surface: the lattice under a random cubic map, bent by about half its size, turned
  bumpy,  ///< noise: up to 0.5 across the lattice and 0.25 along it (less where spokes are near one another)
  flat,   ///< noise of up to 0.01 across the lattice
};
inline constexpr std::array all_net_shapes{NetShape::bent, NetShape::bumpy, NetShape::flat};
[[nodiscard]] const char* name_of(NetShape shape);

/// The net of this shape and valence.
///
/// Guarantee: the same for the same arguments, up to the last digits of the standard library's cosine.
/// Requires:  n >= 3.
[[nodiscard]] ControlMesh corner_net(NetShape shape, std::size_t n, std::uint64_t seed);

/// The bent net for a scheme: with an extraordinary vertex, or for a dual scheme face, of valence n. The
/// first patch of owner 0 has its corner 0 there.
[[nodiscard]] ControlMesh bent_net(Scheme scheme, std::size_t n, std::uint64_t seed);

/// What bounds a patch: hull rows (no layout), or tables of a layout.
using BoundSource = std::optional<TableLayout>;
inline constexpr std::array<BoundSource, 3> all_bound_sources{std::nullopt, TableLayout::ngon,
                                                              TableLayout::characteristic};

/// The valences of the experiments.
inline constexpr std::array<std::size_t, 12> experiment_valences{3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 20, 50};

}  // namespace snug
