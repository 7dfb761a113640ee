#pragma once

#include <oracle/tagged_mesh.h>

#include <cstdint>
#include <vector>

namespace oracle {

/// A point of the limit surface and its parameter in control face `face`, exact:
///
///   triangle, Loop           part 0, barycentric: (1 - u - v) c0 + u c1 + v c2
///   four corners             part 0, c0 = (0,0), c1 = (1,0), c2 = (1,1), c3 = (0,1)
///   others, Catmull-Clark    part k, (0,0) at corner k, (1,0) at the midpoint of edge k -> k+1, (1,1) at the
///                            face point, (0,1) at the midpoint of edge k-1 -> k
struct FaceSample {
  std::uint32_t face, part;
  double u, v;
  Point position;
  double error;  ///< of each coordinate, the rounding to double included
};

/// Limit positions of all vertices after `levels` refinements of the whole mesh.
///
/// Guarantee: each (face, part, u, v) once, faces without surface left out (holes, and with Boundary::none
///            those with a vertex on a boundary edge that is not infinitely sharp). Exact limits where finite
///            sharpness is still alive, too: the vertex is refined on its own until its masks stay the same.
///            Positions are within `error`: in 113-bit arithmetic a step is at most three nested convex
///            combinations of up to N terms, N the largest valence or face, so it adds at most (N + 12)
///            2^-112 M, M the largest coordinate; limits without a closed formula (one infinitely sharp edge;
///            the old vertex rule) lie in the hull of a ring of 2^-80 M. Under chaikin dart edges may be no
///            convex combination: the bound takes the largest coordinate that occurs, times two.
/// Requires:  0 <= levels <= 10.
/// Errors:    std::invalid_argument, see TaggedMesh and Requires, and for faces without three corners and
///            Loop.
/// Cost:      some 10 microseconds a sample; a millisecond to a second for a vertex without a formula.
/// Source:    [Loop87], [CatmullClark78], creases, boundaries and non-manifold places by OpenSubdiv 3.5.
/// differs:   OpenSubdiv's own limit masks are not the limit at vertices with one sharp edge, at interior vertices
///            with two faces (Catmull-Clark), and where finite sharpness is alive.
[[nodiscard]] std::vector<FaceSample> sample_faces(const TaggedMesh& mesh, const Rules& rules, int levels);

/// The control mesh after `levels` steps, rounded to double, in the order of OpenSubdiv's faces and corners.
///
/// Guarantee: creases and corners hold what is left of the sharpness, boundaries and non-manifold places
///            included; holes are the faces without a surface. It need not refine like its origin: where two
///            edges join the same vertices they are one here.
[[nodiscard]] TaggedMesh refine(const TaggedMesh& mesh, const Rules& rules, int levels = 1);

}  // namespace oracle
