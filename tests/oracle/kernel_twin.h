#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace oracle {

enum class KernelScheme { loop, catmark, doo_sabin, midedge };

/// An oriented manifold mesh, closed or open, and its sharp edges and vertices.
struct KernelMesh {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;  ///< the smaller vertex first
  static constexpr int infinite = 1000;

  std::uint32_t vertices = 0;
  std::vector<std::vector<std::uint32_t>> faces;
  std::map<Edge, int> creases{};           ///< sharpness in quarters
  std::map<std::uint32_t, int> corners{};  ///< likewise
  bool boundary_corners = true;            ///< are boundary vertices of one face sharp?
  bool smooth_triangles = false;
};

/// The control values whose limit is 0 at all vertices (dual schemes: the middles of all faces with a corner inside) of the mesh
/// after `steps` steps, but for darts and what is not at rest: their dimension, in exact arithmetic modulo a prime.
///
/// Guarantee: at least the dimension of the values whose limit is 0 everywhere. The prime is 1 modulo all valences' common
///            multiple: cosines are elements of the field, masks are images of the exact ones, and a rank never grows.
/// Source:    [Loop87], [CatmullClark78], [DooSabin78], [PetersReif97]; limits [HalsteadKassDeRose93], creases [Hoppe94],
///            [DeRose98]. A face's mean is kept by the dual masks.
[[nodiscard]] std::size_t nullity_of_limits(const KernelMesh& mesh, KernelScheme scheme, int steps);

/// Is every vertex of a face with a surface 0 after one step from these values? In the same arithmetic.
[[nodiscard]] bool vanishes(const KernelMesh& mesh, KernelScheme scheme,
                            const std::vector<std::int8_t>& values);

}  // namespace oracle
