#pragma once

#include <cstddef>
#include <cstdint>

#include <snug/mesh.h>

/// Extents of a control net along three axes at once, on the widest vectors that the processor has; others
/// use surface/control_nets.h. The same bits on every instruction set.
namespace snug::kernels {

/// A net of ControlHull: points by number, corners of faces first.
struct ControlNet {
  const VertexId* vertices;
  std::size_t vertex_count;
  const std::uint32_t *rings, *ring_ends;  ///< of each corner
  std::size_t corner_count;
  const std::uint32_t *patch, *patch_ends;  ///< corners of each patch
  const double* weights;
  std::size_t patch_count;
};

/// A number for each axis, the last one unused.
using PerAxis = double[4];

struct NetExtents {
  PerAxis lower, upper;
  PerAxis largest;  ///< largest |height| of a point
  PerAxis squares;  ///< sum over the patches of the squared extent of their corners
};

/// `axes`: the x coordinates of the three axes and 0, then y, then z. `memory`: 4 vertex_count + 8 corner_count
/// numbers. Bounds are those of ControlHull::extent() before its rounding is added.
void net_extents(const ControlNet& net, const Point3* points, const PerAxis axes[3], double* memory,
                 NetExtents& out);

}  // namespace snug::kernels
