#pragma once

#include <oracle/tagged_mesh.h>

#include <filesystem>

namespace oracle {

/// A mesh and the rules that its tags ask for; the boundary rule is left to the caller.
struct TaggedFile {
  TaggedMesh mesh;
  bool chaikin = false, smooth_triangles = false;
};

/// Reads `v`, `f` and the tags crease, corner, hole, creasemethod and smoothtriangles of an OBJ file; every
/// other line is passed over.
///
/// Errors: std::runtime_error if it cannot be read or a number is missing.
[[nodiscard]] TaggedFile read_tagged_obj(const std::filesystem::path& path);

}  // namespace oracle
