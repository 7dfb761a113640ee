#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gmpxx.h>

#include <snug/mesh/control_mesh.h>
#include <snug/run.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// Most control points of a mesh whose rank is computed.
inline constexpr std::size_t max_ranked_vertices = 20000;

/// Control values that leave the limit surface as it is.
struct ExactKernelVector {
  /// Those that are not 0, by vertex: polynomials in 2 cos(2 pi/order), by coefficients.
  using Entries = std::vector<std::pair<VertexId, std::vector<mpq_class>>>;
  std::uint32_t order = 1;  ///< 1: all are numbers
  Entries entries;
};

/// The rank of the map from control values to limit functions: at least `least`, at most `most`.
struct MeshRank {
  std::size_t dimension = 0;  ///< control points
  std::size_t least = 0, most = 0;
  /// dimension - most independent elements of the kernel; if the rank is decided a basis, in reduced echelon form: each
  /// has the entry 1 at a vertex of its own.
  std::vector<ExactKernelVector> vectors;
  /// The rank modulo this prime is `least`, if 2 cos(2 pi i/root_order) is root^i + root^-i.
  std::uint32_t prime = 0, root = 0, root_order = 1;
  [[nodiscard]] bool decided() const { return least == most; }
};

/// The rank and the kernel of a mesh with any tags, by elimination.
///
/// Guarantee: exact. No less: rank, modulo a prime, of some exact functionals of the surface. No more: each vector is shown to
///            make the function 0 on all patches, by exact arithmetic. Positions do not matter. Not decided are some
///            meshes whose kernel needs cosines of degree above 64, or entries too long for 48 primes.
/// Errors:    InputError (refused): those of require_surface(); more than max_ranked_vertices control points, or
///            max_exact_kinds different surroundings of patches, as many different sharpnesses make; with Loop
///            and Doo-Sabin valences whose least common multiple exceeds a million. Interrupted.
/// Requires:  Loop, Catmull-Clark, Doo-Sabin or Midedge.
/// Cost:      a millisecond for each patch topology, and elimination of a sparse matrix: a second for 10,000 control
///            points; a block of the kernel in cosines of degree 64 takes several.
/// Source:    derivations/independence_of_meshes.md, "By elimination".
[[nodiscard]] MeshRank mesh_rank(const ControlMesh& mesh, const SchemeOptions& options,
                                 const WorkMonitor& monitor = {});

}  // namespace snug
