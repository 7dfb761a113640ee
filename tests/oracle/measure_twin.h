#pragma once

#include <oracle/polygon_twin.h>
#include <oracle/tagged_mesh.h>
#include <oracle/winding_twin.h>

#include <gmpxx.h>

#include <array>
#include <cstdint>
#include <vector>

namespace oracle {

/// Area, volume, centroid and, about it, the inertia tensor xx, yy, zz, xy, yz, zx; density 1.
constexpr std::size_t kMeasures = 11;
using MeasureValues = std::array<long double, kMeasures>;

/// Of a closed polyhedron; polygons with more than three corners are triangles around the mean of their
/// corners.
[[nodiscard]] MeasureValues polyhedron_measures(const TaggedMesh& mesh);

/// Of the limit surface of a closed, oriented mesh: refined meshes, extrapolated as if errors fell by four a
/// level.
struct MeasureEstimate {
  MeasureValues value, error;  ///< error: several times what the last step changed; no proof
};
/// Requires:  levels >= 2.
[[nodiscard]] MeasureEstimate limit_measures(const TaggedMesh& mesh, const WindingScheme& scheme, int levels);

/// The same of the area alone, of any mesh with a primal scheme: faces without a surface are left out.
struct AreaEstimate {
  long double value, error;
};
[[nodiscard]] AreaEstimate limit_area(const TaggedMesh& mesh, const Rules& rules, int levels);

/// Surfaces that are polynomial everywhere: on tori of m times n control points, point (i, j) at i n + j.
enum class PeriodicBasis {
  bilinear,     ///< quads (i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)
  biquadratic,  ///< likewise; the limit of Doo-Sabin
  bicubic,      ///< likewise; the limit of Catmull-Clark
  box_spline,   ///< these quads split from (i, j) to (i + 1, j + 1); the limit of Loop
};
/// The measures but the area, exact.
/// Source: [Stam98] for the basis functions of the box spline, uniform B-splines by de Boor.
[[nodiscard]] std::array<mpq_class, kMeasures - 1> exact_measures(PeriodicBasis basis, std::uint32_t m,
                                                                  std::uint32_t n,
                                                                  const std::vector<Point>& points);

}  // namespace oracle
