#pragma once

#include <cstddef>
#include <vector>

#include <snug/mesh/control_mesh.h>

namespace snug {

/// The crease tags that name no edge of a face, by their places in the list: they sharpen nothing.
///
/// Cost:      nothing without creases, else that of sorting all edges.
[[nodiscard]] std::vector<std::size_t> loose_creases(const ControlMesh& mesh);

}  // namespace snug
