#pragma once

#include <string>

#include <snug/io/stl.h>
#include <snug/mesh.h>
#include <snug/mesh/control_mesh.h>
#include <snug/monitor.h>

namespace snug {

class AtomicFile;

/// write_mesh() into a file that was opened for this name, and that is left to the caller to commit.
void write_mesh(const ControlMesh& mesh, AtomicFile& file, const std::string& path, const Notes& notes,
                const WorkMonitor& monitor);

/// Before work whose result write_mesh will write: is there a writer for this name?
///
/// Errors:    InputError (unreadable) if not.
void require_writable_ending(const std::string& path);

/// Does the format that write_mesh takes for this name hold faces of more than three corners?
///
/// Errors:    as require_writable_ending.
[[nodiscard]] bool writes_polygons(const std::string& path);

}  // namespace snug
