#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common.h"

namespace snug::command {

/// The distance of --weld; empty without it.
/// Errors:    UsageError for what is no length.
[[nodiscard]] std::function<double(double)> weld_distance(const CommonOptions& options);

/// Multiplies coordinates by --scale, and notes the units of --units; a file's own are those before --scale.
/// Errors:    InputError (refused) if a coordinate leaves the range of doubles.
void set_units(ControlMesh& mesh, const std::string& path, const CommonOptions& options);

/// A trait of a mesh or its surface that may not be meant.
struct Finding {
  std::string kind;   ///< such as "needles"
  std::string text;   ///< a line without a full stop
  std::string mends;  ///< an option or a command that helps; empty if there is none
};

/// Of vertices and boundary edges that stand where others do, or nearly so.
[[nodiscard]] std::vector<Finding> coincidences_found(const ControlMesh& mesh);
/// Notes of these.
void note_coincidences(const ControlMesh& mesh, const std::string& path, const CommonOptions& options);

/// The angle of --sharp in degrees; nothing without it.
/// Errors:    UsageError for what is neither `auto` nor an angle.
[[nodiscard]] std::optional<double> sharp_angle(const CommonOptions& options);

/// Sharpens a mesh as --sharp says, with a note of what was done.
/// Errors:    UsageError for curves.
void sharpen_mesh(ControlMesh& mesh, const std::string& path, double angle, const CommonOptions& options);

/// Without --sharp, a note where `scheme`, what --scheme names for this surface, is auto and smooths triangles that no tag
/// says are a control mesh; with it, a note how far curved regions are from their faces. `apart` is limit_to_faces() if it
/// is known.
void note_smoothing(const Surface& surface, const std::string& path, const CommonOptions& options,
                    const std::string& scheme, std::optional<double> apart = {});

}  // namespace snug::command
