#pragma once

#include <optional>
#include <string>

#include <snug/hull.h>
#include <snug/surface/limit_surface.h>

#include "common.h"

/// What `hull` and `envelope` have in common.
namespace snug::command {

/// A hull as a mesh to write or to ask.
[[nodiscard]] ControlMesh mesh_of(const Hull& hull);

/// "tolerance" of --tolerance.
/// Errors:    UsageError if it is missing or no length, naming the command.
void require_tolerance(const std::string& command, const std::string& tolerance);

/// {vertices, triangles, gap, verified}, or null.
void write_hull(JsonWriter& json, const std::optional<Hull>& hull, bool verified);

/// Whether all is proved, and where not, in words and as "verified", "problems". The surface's patches belong to
/// faces if it is `primal`, else to vertices.
void write_verdict(Report& report, const Hulls& hulls, bool primal);

}  // namespace snug::command
