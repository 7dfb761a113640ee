#pragma once

#include <optional>
#include <string>

#include <snug/hull.h>

#include "common.h"

/// Code shared by `hull` and `envelope`.
namespace snug::command {

/// A hull as a mesh to write or to ask.
[[nodiscard]] ControlMesh mesh_of(const Hull& hull);

/// A length for --error.
/// Errors:    UsageError if it is missing or no length, naming the command.
void require_error(const std::string& command, const std::string& tolerance);

/// {vertices, triangles, gap}, or null.
void write_hull(JsonWriter& json, const std::optional<Hull>& hull);

/// Where a hull failed, why, and what helps. `owner`: what the surface's patches belong to, in a word.
[[nodiscard]] std::string sentence(const HullProblem& problem, const char* owner);

/// Whether all is proved, and where not, in words and as "outcome", "problems". `owner` as above.
void write_verdict(Report& report, const Hulls& hulls, const char* owner);

}  // namespace snug::command
