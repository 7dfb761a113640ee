#pragma once

#include <string>

#include <snug/curves.h>

#include "common.h"

/// Commands on limit curves, those of a mesh's polylines.
namespace snug::command {

/// --degree, where it is given.
using Degree = std::optional<std::uint64_t>;

/// Is the mesh answered as curves? With --scheme curve; with auto if it has polylines and no faces.
[[nodiscard]] bool is_curve(const ControlMesh& mesh, const std::string& scheme);
/// The same for commands that answer curves.
/// Errors:    UsageError for --boundary with curves and --degree with surfaces, which would change nothing.
[[nodiscard]] bool asks_for_curves(const std::string& command, const ControlMesh& mesh,
                                   const std::string& path, const CommonOptions& options, Degree degree);
/// For questions that curves have no answer to.
/// Errors:    InputError (refused) if the mesh is one of curves, whatever scheme is named.
void refuse_curves(const ControlMesh& mesh, const std::string& scheme, const std::string& path);

/// Adds --degree.
void add_degree_option(OptionList& list, Degree& degree);
/// 3 unless another one is given.
[[nodiscard]] CurveDegree curve_degree(Degree degree);
/// The curves of a mesh that has been read from `path`. Refusals name the file.
[[nodiscard]] CurveSet make_curves(ControlMesh mesh, const std::string& path, CurveDegree degree);
/// The head of the document, the degree included.
void curve_heads(Report& report, const std::string& path, CurveDegree degree);

}  // namespace snug::command
