// bench_schemes: Catmull-Clark patches at speed, a character mesh with creases, very many sharpnesses.

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <sys/resource.h>

#include <snug/surface/batch_bounds.h>

#include "meshes.h"
#include "patches.h"

namespace {

using namespace snug;
using namespace snug::bench;

double peak_mebibytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void bench_cold(const std::string& title, const ControlMesh& mesh, const Options& options) {
  const ColdBounds found = cold_bounds(mesh);
  std::printf("%s: %zu faces, %zu creased edges, %zu kinds, %.1f MiB of rows, peak memory %.0f MiB\n",
              title.c_str(), mesh.face_count(), mesh.tags.creases.size(), found.kinds,
              static_cast<double>(found.bytes) / 0x1p20, peak_mebibytes());
  Group group(title, "mesh", options);
  group.add("kinds, rows and bounds of all patches, cold", 1, [&] { return cold_bounds(mesh).radii; });
  group.run();
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 0, "");
  {
    const ControlMesh mesh = quad_torus(options.size(500'000, 2'000));
    const LimitSurface surface(mesh, catmark(), std::make_shared<BoundsCache>());
    BatchBounds bounds(surface, {}, 1);
    std::vector<OffsetTriangle> out(bounds.patches().size());
    Group group("regular quads", "quad", options);
    group.add("two offset triangles a quad", static_cast<double>(mesh.face_count()),
              [&] { return update(bounds, mesh.points, out); });
    group.run();
  }
  bench_creases("panels", panelled_mesh(options.size(10'000, 1'000)), options);
  bench_creases("character", character_mesh(options.size(10'000, 1'000), options.size(7'000, 700)), options);
  bench_cold("character", character_mesh(options.size(10'000, 1'000), 7'000), options);
  bench_cold("all sharpnesses different", many_sharpnesses(options.size(10'000, 300)), options);
  return 0;
}
