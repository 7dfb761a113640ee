// Encloses the limit surface of a control mesh and prints the number and size of the enclosures.
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
    const auto ignore = [](const snug::PatchEnclosure&) {};
    const snug::BoundSummary summary = snug::bound(surface, {.error = 0.01 * surface.size()}, ignore);
    std::printf("%zu faces: %llu offset triangles contain the surface, largest radius %g\n",
                surface.mesh().face_count(), static_cast<unsigned long long>(summary.count),
                summary.max_radius);
    return summary.outcome == snug::Outcome::complete ? 0 : 5;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
