#pragma once

#include <string>

#include <snug/mesh.h>
#include <snug/mesh/control_mesh.h>

namespace snug {

/// The mesh as a binary glTF 2.0 file, for viewers: one node, one mesh, one list of triangles; positions as
/// floats, indices of 32 bits, no normals, no materials. Its tags are left out. `name` is what messages call the
/// file.
///
/// Guarantee: a face of n corners becomes the n - 2 triangles of the fan at its first corner; vertices keep
///            their numbers. Coordinates are the nearest floats, and `min` and `max` of the positions are exact.
/// Notes:     one line if coordinates were rounded; one if faces were split into triangles.
/// Errors:    InputError (refused) naming a face of one or two corners, or a vertex that does not fit floats;
///            for files beyond 4 GiB, which the format cannot hold, and meshes without triangles. InputError (value) on
///            coordinates that are not finite.
/// Source:    glTF 2.0 specification, sections 3.6, 3.7 and 4.4.
[[nodiscard]] std::string format_glb(const ControlMesh& mesh, const std::string& name,
                                     const Notes& notes = {});

}  // namespace snug
