#pragma once

#include <span>
#include <string>
#include <string_view>

#include <snug/mesh.h>
#include <snug/mesh/control_mesh.h>
#include <snug/monitor.h>

namespace snug {

class AtomicFile;

/// read_mesh() of the bytes that a file of this name holds, without welding.
[[nodiscard]] ControlMesh parse_mesh(std::string_view bytes, const std::string& name,
                                     const Notes& notes = {});

/// read_mesh() of the bytes that the file `path` holds.
[[nodiscard]] ControlMesh read_mesh(std::string_view bytes, const std::string& path,
                                    const ReadOptions& options);

/// write_mesh() into a file that was opened for this name, and that is left to the caller to commit; with
/// normals of the vertices if there are any and writes_normals(path).
void write_mesh(const ControlMesh& mesh, AtomicFile& file, const std::string& path, const Notes& notes,
                const WorkMonitor& monitor, std::span<const Vector3> normals = {});

/// Before work whose result write_mesh will write: throws InputError (unreadable) for names without a writer.
void require_writable_ending(const std::string& path);

/// Does the format that write_mesh takes for this name hold faces other than triangles? Throws likewise.
[[nodiscard]] bool writes_polygons(const std::string& path);
/// Does it hold coordinates in single precision only?
[[nodiscard]] bool writes_floats(const std::string& path);
/// Does write_mesh write normals of vertices into it?
[[nodiscard]] bool writes_normals(const std::string& path);
/// Does every such file name a scheme? Without a tag, that of the faces.
[[nodiscard]] bool names_scheme(const std::string& path);
/// A mesh whose faces are meant as they are, to write into such a file: tagged so if names_scheme(path).
[[nodiscard]] ControlMesh as_facets(ControlMesh mesh, const std::string& path);

}  // namespace snug
