// Encloses the limit surface of a control mesh and says how tightly.
//
//   01_bound_a_mesh MESH

#include <cstdio>
#include <exception>

#include <snug/bound.h>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: 01_bound_a_mesh MESH\n");
    return 2;
  }
  try {
    const snug::Surface surface = snug::load(argv[1]);
    snug::BoundOptions options;
    options.tolerance = 0.01 * surface.size();
    const snug::BoundSummary summary = snug::bound(surface, options, [](const snug::PatchEnclosure&) {});
    std::printf("%zu faces: %llu offset triangles contain the surface, largest radius %g\n",
                surface.mesh().face_count(), static_cast<unsigned long long>(summary.count),
                summary.max_radius);
    return summary.reached ? 0 : 5;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
