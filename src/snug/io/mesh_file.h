#pragma once

#include <string>

#include <snug/base/progress.h>
#include <snug/io/notes.h>
#include <snug/mesh/control_mesh.h>

namespace snug {

/// The control mesh in a file. The format follows the ending, .obj or .off in any case. Standard input ("-")
/// and files without an ending are OFF if they begin like OFF, else OBJ.
///
/// Errors:    InputError (unreadable) as read_file, parse_obj and parse_off, and for another ending.
///            Interrupted as read_file.
[[nodiscard]] ControlMesh read_mesh(const std::string& path, const Notes& notes = {},
                                    const WorkMonitor& monitor = {});

/// Writes a control mesh, whole or not at all (atomic_file.h). The format follows the ending, .obj or .off in
/// any case; "-" is OBJ on standard output.
///
/// Notes:     one line if the format has no tags but the mesh has.
/// Errors:    InputError (unreadable) for another ending and as AtomicFile. SNUG_EXPECT as format_obj.
void write_mesh(const ControlMesh& mesh, const std::string& path, const Notes& notes = {});

}  // namespace snug
