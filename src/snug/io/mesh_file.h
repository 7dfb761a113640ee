#pragma once

#include <functional>
#include <string>

#include <snug/base/progress.h>
#include <snug/io/notes.h>
#include <snug/io/stl.h>
#include <snug/mesh/control_mesh.h>

namespace snug {

class AtomicFile;

/// How near vertices are welded, for a mesh whose longest side is `size`; empty: not at all.
using WeldDistance = std::function<double(double size)>;

/// The control mesh in a file. The format follows the ending, .obj, .off, .ply or .stl in any case. Standard
/// input ("-") and files without an ending are PLY or OFF if they begin like that, else OBJ. With `weld` vertices
/// are joined as weld() does it (mesh/weld.h), for every format; `size` is the longest side of the box of the vertices
/// that faces or polylines use.
///
/// Notes:     those of the parser; one line that says what was welded, or that nothing was.
/// Errors:    InputError as read_file and the parser of the format; (unreadable) for another ending; as weld() and
///            `weld`, with the name. Interrupted as read_file.
[[nodiscard]] ControlMesh read_mesh(const std::string& path, const Notes& notes = {},
                                    const WorkMonitor& monitor = {}, const WeldDistance& weld = {});

/// Writes a control mesh, whole or not at all (atomic_file.h). The format follows the ending in any case:
/// .obj, .off, .ply (binary, little endian), .stl (binary) or .glb; "-" is OBJ on standard output.
///
/// Notes:     one line if the format has no tags but the mesh has, one for polylines; as the writer of the
///            format.
/// Errors:    InputError as the writer of the format and AtomicFile; (unreadable) for another ending.
///            Interrupted.
void write_mesh(const ControlMesh& mesh, const std::string& path, const Notes& notes = {},
                const WorkMonitor& monitor = {});
/// The same into a file that was opened for this name, and that is left to the caller to commit.
void write_mesh(const ControlMesh& mesh, AtomicFile& file, const std::string& path, const Notes& notes = {},
                const WorkMonitor& monitor = {});

/// Before work whose result write_mesh will write: is there a writer for this name?
///
/// Errors:    InputError (unreadable) if not.
void require_writable_ending(const std::string& path);

/// Does the format that write_mesh takes for this name hold faces of more than three corners?
///
/// Errors:    as require_writable_ending.
[[nodiscard]] bool writes_polygons(const std::string& path);

}  // namespace snug
