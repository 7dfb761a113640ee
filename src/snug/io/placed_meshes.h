#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <snug/io/transform.h>
#include <snug/mesh.h>

namespace snug {

/// Meshes of a file in their own coordinates, and where it places them.
struct PlacedMeshes {
  struct Part {
    std::string name;  ///< the file's; may be empty, or that of another part
    std::string what;  ///< in messages, such as "glTF: node 3"
    std::size_t mesh;  ///< in `meshes`
    AffineEnclosure map{};
  };
  std::vector<ControlMesh> meshes;
  std::vector<Part> parts;
  /// Vertices and corners of all parts together, whatever instances promise.
  std::size_t max_elements = 0xFFFFFFFE;
};

/// All parts as one mesh, moved as the file says, in their order; parts that are mirrored are reversed.
///
/// Notes:     one line if points are moved, with the largest rounding.
/// Errors:    InputError (unreadable) naming the part for points that leave the range of doubles, and for more than
///            `max_elements`.
[[nodiscard]] ControlMesh joined(const PlacedMeshes& placed, const std::string& name, const Notes& notes);

/// The parts as they are: a transform that is a motion up to rounding is a pose, others move the points of a mesh of their own.
///
/// Notes, errors: likewise.
[[nodiscard]] MeshAssembly assembled(PlacedMeshes placed, const std::string& name, const Notes& notes);

}  // namespace snug
