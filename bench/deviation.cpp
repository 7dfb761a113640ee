// bench_deviation: how far a limit surface and a triangle mesh are from each other, beside CGAL's
// bounded_error_Hausdorff_distance between a uniform refinement and that mesh. Files: any closed models.

#include <cstdio>
#include <string>
#include <vector>

#include <snug/distance.h>
#include <snug/evaluate.h>

#include "placements.h"
#include "runner.h"

#ifdef SNUG_BENCH_CGAL
#include "peer_cgal.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

std::vector<Triangle> triangles_of(const ControlMesh& mesh, const Vector3& moved) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.face_count());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    triangles.push_back({mesh.points[face[0].index()] + moved, mesh.points[face[1].index()] + moved,
                         mesh.points[face[2].index()] + moved});
  }
  return triangles;
}

#ifdef SNUG_BENCH_CGAL
CgalMesh peer_mesh(const ControlMesh& mesh, const Vector3& moved) {
  TriangleMesh result;
  for (const Point3& p : mesh.points) result.points.push_back(p + moved);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    result.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return CgalMesh(result);
}
#endif

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, any_files, " MODEL...");
  for (const Model& model : read_models(options.files)) {
    const Surface surface(model.mesh, {.scheme = Scheme::loop});
    const double size = surface.size();
    // About 100,000 limit points' triangles, as they are and moved by half a percent.
    unsigned level = 0;
    while (model.mesh.face_count() << 2 * (level + 1) <= 100'000u >> (options.quick ? 4 : 0)) ++level;
    const ControlMesh mesh = subdivided(model.mesh, level, true);
    // CGAL's mesh for the surface is one level finer, and still farther off than the precision.
    const ControlMesh finer = subdivided(model.mesh, level + 1, true);
    for (const double moved : {0.0, 0.005}) {
      const Vector3 by{moved * size, 0, 0};
      const std::vector<Triangle> candidate = triangles_of(mesh, by);
      for (const double precision : {1e-3, 1e-4}) {
        char title[160];
        std::snprintf(title, sizeof title,
                      "%s against %zu triangles of its own limit points%s, to %g of the size",
                      model.name.c_str(), candidate.size(), moved > 0 ? ", moved by 0.5 %" : "", precision);
        Group group(title, "triangle", options);
        group.limit_rounds(5);
        const auto ask = [&](int threads) {
          const Deviation d =
              deviation(surface, candidate, {.absolute = precision * size}, {.threads = threads});
          return d.from_surface.distance.upper + d.from_candidate.distance.upper;
        };
        const double items = static_cast<double>(candidate.size());
        group.add("snug", items, [&] { return ask(1); });
        group.add("snug, two threads", items, [&] { return ask(2); });
#ifdef SNUG_BENCH_CGAL
        const CgalMesh peer_surface = peer_mesh(finer, {}), peer_candidate = peer_mesh(mesh, by);
        group.add("CGAL", items, [&] {
          return cgal_hausdorff(peer_surface, peer_candidate, precision * size) +
                 cgal_hausdorff(peer_candidate, peer_surface, precision * size);
        });
#endif
        const std::vector<Times> times = group.run();
        if (times.size() > 2) std::printf("# CGAL over snug: %.2f\n", ratio(times[2], times[0]));
        std::printf("# two threads: %.2f of the time on the clock of one\n", times[1].wall / times[0].wall);
      }
    }
  }
  return 0;
}
