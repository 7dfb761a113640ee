#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/mesh/control_mesh.h>
#include <snug/run.h>

/// The columns of uniform Loop meshes in the dissertation's tables: OpenSubdiv refines to the first level
/// whose vertices are all within half the tolerance of their limit, FCL builds trees and answers. In the
/// order of the tables' rows; nothing where either of them was not there to build with.
namespace snug {

/// Triangles, of table 5.1.
[[nodiscard]] std::optional<std::vector<std::size_t>> uniform_triangles(
    const std::vector<ControlMesh>& models, const WorkMonitor& monitor);

/// With trees of oriented boxes, and of these with rectangles swept by balls.
struct UniformTimes {
  double obb = 0, obbrss = 0;
  std::size_t hits = 0;  ///< of table 5.3
};
/// Milliseconds, of table 5.2.
[[nodiscard]] std::optional<std::vector<UniformTimes>> uniform_creation(
    const std::vector<ControlMesh>& models, const WorkMonitor& monitor);
/// Microseconds a query, of table 5.3. Models meet two by two.
[[nodiscard]] std::optional<std::vector<UniformTimes>> uniform_rooms(const std::vector<ControlMesh>& models,
                                                                     std::size_t placements,
                                                                     std::uint64_t seed,
                                                                     const WorkMonitor& monitor);

}  // namespace snug
