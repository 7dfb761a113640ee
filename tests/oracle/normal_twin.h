#pragma once

#include <oracle/dual_twin.h>
#include <oracle/tagged_mesh.h>

#include <cstdint>
#include <vector>

namespace oracle {

/// A unit normal of the limit surface at a place as FaceSample names it, on the side from which the face looks
/// counter-clockwise, and about how far it is off.
struct NormalSample {
  std::uint32_t face, part;
  double u, v;
  Point normal;
  double error;
};

/// Normals at vertices of refined meshes that are smooth: of the two first modes of what surrounds them, which
/// steps of subdivision multiply by one number.
///
/// Returns:   those of `levels` steps of the whole mesh.
/// Requires:  an oriented manifold; with Loop triangles. No face is a neighbour of another one twice.
/// Source:    [Loop87]; [HalsteadKassDeRose93] for Catmull-Clark.
[[nodiscard]] std::vector<NormalSample> sample_normals(const TaggedMesh& mesh, const Rules& rules,
                                                       int levels);

/// The same in `rings` rings around a vertex: at each step what is farther away is left out, and the vertex
/// moved to the origin, so that rounding shrinks with the rings.
[[nodiscard]] std::vector<NormalSample> sample_normals_near(const TaggedMesh& mesh, const Rules& rules,
                                                            std::uint32_t vertex, int rings);

/// A normal at the centroid of a face after some steps of a dual scheme, of either sign, on the patches of these
/// control vertices.
struct DualNormal {
  std::vector<std::uint32_t> owners;
  Point normal;
  double error;
};
[[nodiscard]] std::vector<DualNormal> sample_dual_normals(const TaggedMesh& mesh, DualScheme scheme,
                                                          int levels);

}  // namespace oracle
