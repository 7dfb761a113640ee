#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <snug/mesh/control_mesh.h>
#include <snug/run.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// Control values, one a vertex, that leave the limit surface as it is: `signs` at `vertices`, 0 elsewhere.
struct KernelVector {
  std::vector<VertexId> vertices;  ///< in rising order
  std::vector<std::int8_t> signs;  ///< 1 or -1 for each; 1 at the first
};

/// The kernel of a mesh: all control values whose limit function is 0 everywhere. The vectors are a basis; no
/// vertex is in two of them. Without any, limit points determine control points.
struct MeshKernel {
  std::vector<KernelVector> vectors;  ///< in the order of their first vertices
  [[nodiscard]] std::size_t dimension() const { return vectors.size(); }
};

/// A case that mesh_kernel() does not decide; mesh_rank() may.
class NotDecided : public InputError {
  using InputError::InputError;
};

/// The kernel of a mesh.
///
/// Each vertex that supports no surface is a vector of its own: isolated ones; with a dual scheme those whose
/// faces have no vertex inside; with Bilinear and flat those whose faces have no surface. Besides, Loop and
/// Doo-Sabin have none. Midedge has one for each component whose edges join vertices of two colours: 1 at the
/// one colour, -1 at the other. Catmull-Clark has the same where moreover all vertices of the component are
/// smooth, inside, and of valence 3, such as a cube's.
///
/// Guarantee: exact, from connectivity and tags alone; positions do not matter.
/// Decided:   manifold meshes, closed or open, with any tags, all faces with a surface; but for Catmull-Clark
///            components where all hangs on vertices of valence 2 at semi-sharp edges, and for Doo-Sabin with
///            faces of seven corners or more at a boundary.
/// Errors:    InputError (refused): those of require_surface(). NotDecided (refused): the others, naming an element
///            and the next step. Interrupted.
/// Cost:      linear; 0.3 seconds for a million quads.
/// Source:    derivations/independence_of_meshes.md.
[[nodiscard]] MeshKernel mesh_kernel(const ControlMesh& mesh, const SchemeOptions& options,
                                     const WorkMonitor& monitor = {});

}  // namespace snug
