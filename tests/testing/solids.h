#pragma once

#include <oracle/tagged_mesh.h>

#include <cstdint>
#include <random>

namespace snug::testing {

/// A random closed mesh whose faces are counter-clockwise from outside: triangles, quads and polygons side by
/// side, vertices of three faces and more, handles, and sometimes a second shell inside of it or through it,
/// perhaps inside out.
[[nodiscard]] oracle::TaggedMesh random_solid(std::mt19937_64& random);

}  // namespace snug::testing
