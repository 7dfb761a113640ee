// Encloses the limit surface of a control mesh and says how tightly.
//
//   01_bound_a_mesh MESH

#include <cstdio>
#include <exception>
#include <memory>

#include <snug/io/mesh_file.h>
#include <snug/query/bound.h>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: 01_bound_a_mesh MESH\n");
    return 2;
  }
  try {
    // The library keeps what patches with equal connectivity share; surfaces may share it too.
    const auto library = std::make_shared<snug::BoundsCache>();
    const snug::LimitSurface surface(snug::read_mesh(argv[1]), snug::SchemeOptions{}, library);

    snug::BoundOptions options;
    options.tolerance = 0.01 * surface.size();
    const snug::BoundSummary summary = snug::bound(surface, options, [](const snug::PieceEnclosure&) {});
    std::printf("%zu faces of %zu kinds: %llu offset triangles contain the surface, largest radius %g\n",
                surface.face_count(), surface.kind_count(), static_cast<unsigned long long>(summary.count),
                summary.max_radius);
    return summary.reached ? 0 : 5;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
