// Encloses the limit surface of a mesh whose control points move, frame by frame: 03_follow_a_moving_mesh MESH

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

#include <snug/bound.h>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: 03_follow_a_moving_mesh MESH\n");
    return 2;
  }
  try {
    const snug::Surface surface = snug::load(argv[1]);
    // Everything that depends on connectivity alone is done here, once.
    snug::PatchBounds bounds(surface);
    std::vector<snug::OffsetTriangle> triangles(bounds.patches().size());

    std::vector<snug::Point3> points = surface.mesh().points;
    for (int frame = 0; frame < 4; ++frame) {
      // A wave runs along x.
      for (std::size_t v = 0; v < points.size(); ++v) {
        const snug::Point3& rest = surface.mesh().points[v];
        points[v].z = rest.z + 0.05 * surface.size() * std::sin(3 * rest.x / surface.size() + frame);
      }
      bounds.update(points, triangles);
      double largest = 0;
      for (const snug::OffsetTriangle& triangle : triangles) largest = std::max(largest, triangle.radius);
      std::printf("frame %d: %zu offset triangles contain the surface, largest radius %g\n", frame,
                  triangles.size(), largest);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
