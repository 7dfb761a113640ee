#pragma once

#include <string>

#include <snug/mesh.h>
#include <snug/mesh/control_mesh.h>
#include <snug/monitor.h>

namespace snug {

class AtomicFile;

/// write_mesh() into a file that was opened for this name, and that is left to the caller to commit.
void write_mesh(const ControlMesh& mesh, AtomicFile& file, const std::string& path, const Notes& notes,
                const WorkMonitor& monitor);

/// Before work whose result write_mesh will write: throws InputError (unreadable) for names without a writer.
void require_writable_ending(const std::string& path);

/// Does the format that write_mesh takes for this name hold faces other than triangles? Throws likewise.
[[nodiscard]] bool writes_polygons(const std::string& path);

}  // namespace snug
