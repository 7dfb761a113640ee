// Shoots rays along z at a limit surface: how thick the part is along each, by hits that are proved.
//
//   06_cast_rays MESH

#include <cstdio>
#include <exception>
#include <vector>

#include <snug/snug.h>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: 06_cast_rays MESH\n");
    return 2;
  }
  try {
    const snug::Surface surface = snug::load(argv[1]);
    snug::Box3 box;
    for (const snug::Point3& p : surface.mesh().points) box.add(p);
    constexpr int steps = 12;
    std::vector<snug::Ray> rays;
    for (int k = 0; k < steps * steps; ++k) {
      const double x = box.lower.x + (k % steps + 0.5) / steps * (box.upper.x - box.lower.x),
                   y = box.lower.y + (k / steps + 0.5) / steps * (box.upper.y - box.lower.y);
      rays.push_back({{x, y, box.lower.z - 1}, {0, 0, 1}});
    }
    int column = 0;
    for (const snug::RayHits& found : snug::ray(surface, rays, {.query = snug::RayQuery::all})) {
      double thickness = 0;  // from ways in to ways out
      for (const snug::RayHit& hit : found.hits) thickness += hit.side * hit.t.lower;
      found.certain_miss() ? std::printf("     -") : std::printf(" %5.2f", thickness);
      if (++column % steps == 0) std::printf("\n");
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
