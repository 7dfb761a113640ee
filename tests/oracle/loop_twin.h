#pragma once

#include <oracle/twin_mesh.h>

#include <cstdint>
#include <vector>

namespace oracle {

/// A point of the limit surface. (u, v) are barycentric coordinates of control face `face`: (1 - u - v) c0 +
/// u c1 + v c2.
///
/// Guarantee: u and v are exact; no coordinate of `position` is further than `error` from the exact limit
///            point, the rounding to double included.
struct LimitSample {
  std::uint32_t face;
  double u, v;
  Point position;
  double error;
};

/// How the samples are computed.
///
/// quad:     113-bit floating point. After L levels the error before the last rounding is at most
///           (L + 1) (N + 8) 2^-112 M, N the largest valence, M the largest |coordinate|: every mask is a
///           convex combination with weights good to 1.01 roundoffs, so one step adds at most (N + 2.1)
///           2^-113 M to what the points already carry; creases and edge points add less. The factor of two
///           absorbs second-order terms.
/// interval: MPFI with 160 bits, no error analysis needed; some five to ten times slower. The self test
/// checks quad against it.
enum class Arithmetic { quad, interval };

constexpr int kDeepest = 60;  ///< levels that any function here can descend

/// Limit positions of all vertices after `levels` refinements of the whole mesh.
///
/// Guarantee: for each control face with a surface, in order, (2^levels + 1)(2^levels + 2)/2 samples at the
///            parameters (i, j) / 2^levels, j outer, i inner; a vertex that faces share is reported for each
///            of them.
/// Requires:  0 <= levels <= 12.
/// Errors:    std::invalid_argument, see TwinMesh and Requires.
/// Cost:      quad: some 3 microseconds a sample.
/// Source:    [Loop87]; boundaries by the rules of OpenSubdiv, cubic B-spline creases.
[[nodiscard]] std::vector<LimitSample> sample_uniform(const TwinMesh& mesh, int levels,
                                                      Arithmetic arithmetic = Arithmetic::quad);

/// Limit points ever closer to corner `corner` of `face`, by local refinement.
///
/// Guarantee: the three corners of the face; then for each level the three edge points of the child at the
///            corner, which are the remaining vertices of that child's own corner child and its three
///            siblings. Samples whose parameters no double holds (beyond level 53 at corners 1 and 2) are
///            left out. No samples if the face has no surface.
/// Requires:  corner < 3, 0 <= depth <= kDeepest.
/// Errors:    std::invalid_argument, see TwinMesh and Requires.
/// Cost:      one pass over the faces, then some 40 microseconds a level at small valence, linear in the
///            valences.
[[nodiscard]] std::vector<LimitSample> sample_near_corner(const TwinMesh& mesh, std::uint32_t face,
                                                          std::uint32_t corner, int depth,
                                                          Arithmetic arithmetic = Arithmetic::quad);

/// The same towards the parameter (u, v), by way of the children that contain it.
///
/// Guarantee: as sample_near_corner(); the parameter is first rounded down to multiples of 2^-60.
/// Requires:  u >= 0, v >= 0, u + v <= 1, 0 <= depth <= kDeepest.
[[nodiscard]] std::vector<LimitSample> sample_near_point(const TwinMesh& mesh, std::uint32_t face, double u,
                                                         double v, int depth,
                                                         Arithmetic arithmetic = Arithmetic::quad);

/// The limit point at exactly (u, v); at most one sample, none if the face has no surface.
///
/// Requires:  u >= 0, v >= 0, u + v <= 1, both multiples of 2^-60.
/// Errors:    std::invalid_argument, see TwinMesh and Requires.
/// Cost:      as sample_near_corner() with as many levels as the parameter has bits.
[[nodiscard]] std::vector<LimitSample> sample_at(const TwinMesh& mesh, std::uint32_t face, double u, double v,
                                                 Arithmetic arithmetic = Arithmetic::quad);

}  // namespace oracle
