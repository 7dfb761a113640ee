#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <snug/mesh/control_mesh.h>
#include <snug/scheme/scheme.h>

/// Control nets around one extraordinary vertex: the input of the experiments
/// (convergence.h, tightness.h).
namespace snug {

/// A vertex of valence n in the middle of `rings` rings of a flat lattice: the vertex is at the origin,
/// spokes have length 1. Faces 0 to n - 1 touch it, with their corner 0. Regular but for the middle and the
/// border.
///
/// Requires:  2 rings if the faces in the middle are to have no boundary.
/// Errors:    InputError (value) unless n >= 3 and rings >= 1.
[[nodiscard]] ControlMesh fan_mesh(std::size_t n, std::size_t rings);

/// The same of quads: `rings` rings around a vertex of valence n. Faces touch it with their corner 0; face 0
/// is one of them.
///
/// Errors:    InputError (value) unless n >= 3 and rings >= 1.
[[nodiscard]] ControlMesh quad_fan_mesh(std::size_t n, std::size_t rings);

/// The same with a boundary through the vertex: n faces touch it, from the first spoke to the last one, which
/// are the boundary. Together they make half a turn, one face a quarter.
///
/// Errors:    InputError (value) unless n >= 1 and rings >= 1.
[[nodiscard]] ControlMesh open_fan_mesh(std::size_t n, std::size_t rings);
[[nodiscard]] ControlMesh open_quad_fan_mesh(std::size_t n, std::size_t rings);

/// A face of n vertices, which is face 0, in the middle of a ring of quads; its vertices are 0 to n - 1, of
/// valence 4.
///
/// Errors:    InputError (value) unless n >= 3.
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
/// Errors:    InputError (value) unless n >= 3.
[[nodiscard]] ControlMesh corner_net(NetShape shape, std::size_t n, std::uint64_t seed);

/// The middle of a net. All but the first are for Loop and Catmull-Clark.
enum class NetCentre : std::uint8_t {
  interior,    ///< an extraordinary vertex, for a dual scheme face
  boundary,    ///< a vertex on a smooth boundary
  corner,      ///< a boundary vertex that stays where it is
  crease,      ///< an infinitely sharp crease along two spokes: the first and the one n / 2 later
  dart,        ///< the end of an infinitely sharp crease along the first spoke
  semi_sharp,  ///< a crease as above of a sharpness that decays
};
inline constexpr std::array all_net_centres{NetCentre::interior, NetCentre::boundary, NetCentre::corner,
                                            NetCentre::crease,   NetCentre::dart,     NetCentre::semi_sharp};
[[nodiscard]] const char* name_of(NetCentre centre);

/// The middle of a net, with n faces, and for semi_sharp its sharpness.
struct NetPlace {
  NetCentre centre = NetCentre::interior;
  std::size_t faces = 6;
  double sharpness = 0;
  friend bool operator==(const NetPlace&, const NetPlace&) = default;
};

/// The bent net for a scheme. The first patch of owner 0 has its corner 0 in the middle; with creases it lies
/// beside one.
///
/// Errors:    InputError (value) unless n >= 3, on a boundary n >= 1; a primal scheme for all but the
///            interior.
[[nodiscard]] ControlMesh bent_net(Scheme scheme, const NetPlace& place, std::uint64_t seed);

/// The valences of the experiments.
inline constexpr std::array<std::size_t, 12> experiment_valences{3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 20, 50};

}  // namespace snug
