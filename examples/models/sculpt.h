#pragma once
// From a solid given by a function to a light control mesh whose limit surface follows it.

#include <functional>

#include "implicit.h"
#include "triangle_mesh.h"

namespace models {

struct SculptOptions {
  Vec3 low, high;                                 ///< box around the half x >= 0; low.x must be 0
  double cell = 0.05;                             ///< side of a sampling cube
  bool open_floor = false;                        ///< leave the surface open where it meets y == low.y
  std::size_t faces = 600;                        ///< faces wanted, both halves together
  std::size_t max_valence = 9;                    ///< no collapse may make a larger one
  std::function<double(const Vec3&)> importance;  ///< cost factor at a place; larger keeps more vertices
};

/// Control mesh, mirror symmetric in x = 0, whose Loop limit surface follows the zero set of `solid`.
///
/// Guarantee: an oriented manifold, closed unless open_floor; valence at least 4; the same bytes on every machine.
/// Requires:  `solid` symmetric in x, and positive on the faces of the box other than x = 0 and an open floor.
/// Cost:      one evaluation of `solid` a grid point, then a few hundred a vertex.
/// Source:    marching tetrahedra on Kuhn's cube subdivision; collapses by [Garland and Heckbert 97];
///            differs: the vertex goes to an end or to the middle, and long edges cost extra.
TriangleMesh sculpt(const Solid& solid, const SculptOptions& options);

/// Moves control points until the Loop limit point of each lies near the zero set of `solid`. `floor_y` is the height of
/// an open rim, whose points stay at it; pass something below the model where there is none.
void fit_limit(TriangleMesh& mesh, const Solid& solid, double floor_y, int rounds);

}  // namespace models
