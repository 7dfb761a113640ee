#pragma once

#include <snug/geometry/point.h>
#include <snug/mesh.h>

namespace snug {

/// Box of the vertices that faces use; the longest side of it is what percent lengths refer to.
[[nodiscard]] Box3 used_box(const ControlMesh& mesh);

}  // namespace snug
