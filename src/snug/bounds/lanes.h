#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include <snug/geometry.h>
#include <snug/mesh.h>

namespace snug::kernels {

/// Control points [from, to) of the next `lanes` patches, for vectors with a patch a lane: coordinate a of
/// control point i of patch l at out[(3 (i - from) + a) lanes + l]. Lanes beyond the `here` patches that are
/// left repeat the last one.
///
/// Requires:  control: `count` vertices a patch, from the first of these patches on; 0 < here <= lanes.
inline void gather_lanes(std::span<const Point3> points, const VertexId* control, std::size_t count,
                         std::size_t from, std::size_t to, std::size_t here, std::size_t lanes, double* out) {
  for (std::size_t l = 0; l < lanes; ++l) {
    const VertexId* const index = control + count * std::min(l, here - 1);
    double* at = out + l;
    for (std::size_t i = from; i < to; ++i) {
      const Point3& p = points[index[i].index()];
      at[0] = p.x;
      at[lanes] = p.y;
      at[2 * lanes] = p.z;
      at += 3 * lanes;
    }
  }
}

/// Answers from lanes: coordinate a of corner k of patch l at lane[(3 k + a) lanes + l], radii, roundings.
inline void scatter_lanes(const double* lane, std::size_t lanes, std::span<OffsetTriangle> out) {
  for (std::size_t l = 0; l < out.size(); ++l) {
    const double* from = lane + l;
    for (Point3& corner : out[l].base) {
      corner = {from[0], from[lanes], from[2 * lanes]};
      from += 3 * lanes;
    }
    out[l].radius = from[0];
    out[l].rounding = from[lanes];
  }
}

}  // namespace snug::kernels
