#pragma once

#include "triangle_mesh.h"

namespace snug::bench {

/// The mesh after meshoptimizer's meshopt_simplify: as few triangles as it finds with an error of at most
/// `error`, relative to the mesh's size as meshoptimizer measures it. Points that no triangle uses are gone.
/// meshoptimizer sees positions in single precision; it picks vertices and moves none.
[[nodiscard]] TriangleMesh meshopt_simplified(const TriangleMesh& mesh, double error);

}  // namespace snug::bench
