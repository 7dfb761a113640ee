#pragma once

#include <optional>
#include <string>

#include <snug/mesh/control_mesh.h>

#include "common.h"

namespace snug::command {

/// The distance of --weld; empty without it.
/// Errors:    UsageError for what is no length.
[[nodiscard]] std::function<double(double)> weld_distance(const CommonOptions& options);

/// A note about vertices and boundary edges that stand where others do, or nearly so.
void note_coincidences(const ControlMesh& mesh, const std::string& path, const CommonOptions& options);

/// The angle of --sharp in degrees; nothing without it.
/// Errors:    UsageError for what is neither `auto` nor an angle.
[[nodiscard]] std::optional<double> sharp_angle(const CommonOptions& options);

/// Sharpens a mesh as --sharp says, with a note of what was done.
/// Errors:    UsageError for curves.
void sharpen_mesh(ControlMesh& mesh, const std::string& path, double angle, const CommonOptions& options);

/// Without --sharp, a note that the limit surface of an STL file is not its facets; `far` says how far it is.
void note_smooth_facets(const std::string& path, const CommonOptions& options, const std::string& far);
/// For note_smooth_facets() where the distance was not computed.
inline constexpr const char* ask_info = "'snug info' says how far";

/// The same with how far the surface may be from its faces, which is measured unless it is known or the mesh is very large; with
/// --sharp a note of that alone.
void note_distance_to_faces(const LimitSurface& surface, const std::string& path,
                            const CommonOptions& options, std::optional<double> known = {});

/// "0.031 (0.25 %)": at least that length, and in percent of the size.
[[nodiscard]] std::string text_of_length(double length, double size);

}  // namespace snug::command
