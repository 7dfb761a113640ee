#pragma once

#include <optional>
#include <string>

#include <snug/mesh/control_mesh.h>
#include <snug/query/bound.h>
#include <snug/scheme/curve_masks.h>

#include "common.h"

/// What commands do with limit curves: those of a mesh's polylines.
namespace snug::command {

/// Is the mesh answered as curves? With --scheme curve; with auto if it has polylines and no faces.
[[nodiscard]] bool is_curve(const ControlMesh& mesh, const std::string& scheme);
/// For questions that curves have no answer to.
/// Errors:    InputError (refused) if the mesh is one of curves, whatever scheme is named.
void refuse_curves(const ControlMesh& mesh, const std::string& scheme, const std::string& path);

/// Adds --degree.
void add_degree_option(OptionList& list, unsigned& degree);
[[nodiscard]] CurveDegree curve_degree(unsigned degree);
/// The head of the document, the degree included.
void curve_heads(Report& report, const std::string& path, unsigned degree);

/// bound, for curves.
/// Errors:    UsageError for --bounds table.
ExitStatus bound_curve(ControlMesh mesh, const std::string& path, const CommonOptions& options,
                       unsigned degree, BoundOptions how, const std::optional<Length>& tolerance);

struct CurveSamples {
  unsigned degree;
  unsigned samples;
  std::string at;
};
/// eval, for curves.
ExitStatus eval_curve(ControlMesh mesh, const std::string& path, const CommonOptions& options,
                      const CurveSamples& which);

struct CurveLevel {
  unsigned degree;
  unsigned level;
  bool limit;
};
/// subdivide, for curves.
/// Errors:    UsageError for an output that is no OBJ.
ExitStatus subdivide_curve(const ControlMesh& mesh, const std::string& path, const CommonOptions& options,
                           const CurveLevel& which);

}  // namespace snug::command
