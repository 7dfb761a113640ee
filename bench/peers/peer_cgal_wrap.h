#pragma once

#include "triangle_mesh.h"

namespace snug::bench {

/// CGAL's alpha_wrap_3 of triangles in any order, on one core.
[[nodiscard]] TriangleMesh cgal_alpha_wrap(const TriangleMesh& mesh, double alpha, double offset);

}  // namespace snug::bench
