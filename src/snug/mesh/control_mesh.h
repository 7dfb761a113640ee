#pragma once

#include <snug/mesh.h>
#include <support/point.h>

namespace snug {

/// Box of the vertices that faces use; the longest side of it is what percent lengths refer to.
[[nodiscard]] Box3 used_box(const ControlMesh& mesh);

}  // namespace snug
