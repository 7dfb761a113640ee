#pragma once

#include <string>

#include <snug/mesh/control_mesh.h>

#include "common.h"

namespace snug::command {

/// The distance of --weld; empty without it.
/// Errors:    UsageError for what is no length.
[[nodiscard]] WeldDistance weld_distance(const CommonOptions& options);

/// A note about vertices and boundary edges that stand where others do, or nearly so.
void note_coincidences(const ControlMesh& mesh, const std::string& path, const CommonOptions& options);

}  // namespace snug::command
