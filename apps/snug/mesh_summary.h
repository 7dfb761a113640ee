#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <snug/inspect.h>
#include <snug/surface.h>

#include "common.h"

namespace snug::command {

/// A mesh, a broken one too, and its surface, as far as they are known before any question.
struct MeshSummary {
  Scheme scheme;
  MeshCounts counts;
  std::vector<Defect> defects;
  std::optional<Surface> surface;      ///< none if it is refused
  std::string refusal;                 ///< why
  std::optional<double> apart;         ///< limit_to_faces()
  std::optional<std::uint32_t> twice;  ///< overlapping_shell()
};

/// Errors:    UsageError for curves and for options that do not fit.
[[nodiscard]] MeshSummary summary_of(const ControlMesh& mesh, const std::string& path,
                                     const CommonOptions& options);
/// Lines for people: how the mesh is read, its counts, and why it is refused, if it is.
[[nodiscard]] std::vector<std::string> lines_of(const MeshSummary& summary, const ControlMesh& mesh,
                                                const std::string& path, const CommonOptions& options);
/// A sentence about MeshSummary::twice, without a full stop.
[[nodiscard]] std::string overlap_sentence(const MeshSummary& summary);
/// The vertex of the mesh at a place, or very near to it, such as "vertex 7 of 5 faces, 2 creases"; empty elsewhere, and in a
/// dual scheme.
[[nodiscard]] std::string vertex_at(const Surface& surface, const Place& place);

}  // namespace snug::command
