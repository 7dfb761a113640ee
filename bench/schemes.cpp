// bench_schemes: Catmull-Clark patches at speed, a character mesh with creases, very many sharpnesses.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <sys/resource.h>

#include <snug/surface/batch_bounds.h>

#include "meshes.h"
#include "runner.h"
#include "subject.h"
#ifdef SNUG_BENCH_OPENSUBDIV
#include "peer_opensubdiv.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

double peak_mebibytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

SchemeOptions catmark() { return {Scheme::catmark, BoundaryRule::edge_and_corner}; }

// Rows of all kinds and the bounds of all patches, from a mesh in memory and nothing known.
double cold(const ControlMesh& mesh, std::size_t* kinds = nullptr, std::size_t* bytes = nullptr) {
  const auto library = std::make_shared<BoundsCache>();
  const LimitSurface surface(mesh, catmark(), library, 1);
  BatchBounds bounds(surface, {}, 1);
  std::vector<OffsetTriangle> out(bounds.patches().size());
  if (kinds) *kinds = surface.kind_count();
  const double sum = update(bounds, mesh.points, out);
  if (bytes) *bytes = library->bytes();
  return sum;
}

void bench_cold(const std::string& title, const ControlMesh& mesh, const Options& options) {
  std::size_t kinds = 0, bytes = 0;
  static_cast<void>(cold(mesh, &kinds, &bytes));
  std::printf("%s: %zu faces, %zu creased edges, %zu kinds, %.1f MiB of rows, peak memory %.0f MiB\n",
              title.c_str(), mesh.face_count(), mesh.tags.creases.size(), kinds,
              static_cast<double>(bytes) / 0x1p20, peak_mebibytes());
  Group group(title, "mesh", options);
  group.add("kinds, rows and bounds of all patches, cold", 1, [&] { return cold(mesh); });
  group.run();
}

// Beside Bfr, which approximates what is irregular; its set-up kept, and with it.
void bench_creases(const std::string& title, const ControlMesh& mesh, const Options& options) {
  const auto count = static_cast<double>(mesh.face_count());
  Group group(title + ", " + std::to_string(mesh.face_count()) + " faces", "face", options);
  const LimitSurface surface(mesh, catmark(), std::make_shared<BoundsCache>(), 1);
  BatchBounds bounds(surface, {}, 1);
  std::vector<OffsetTriangle> out;
#ifdef SNUG_BENCH_OPENSUBDIV
  const std::vector<PatchId> faces = all_faces(mesh.face_count());
  const OsdMesh osd(mesh);
  const OsdSurfaces kept(osd, faces, true);
  group.add("Bfr: surfaces and boxes (no proof)", count, [&] {
    const OsdMesh fresh(mesh);
    return OsdSurfaces(fresh, faces, true).box_all();
  });
  group.add("Bfr: boxes alone", count, [&] { return kept.box_all(); });
#endif
  group.add("snug: kinds, rows and bounds, cold", count, [&] { return cold(mesh); });
  group.add("snug: bounds alone", count, [&] { return update(bounds, mesh.points, out); });
  group.run();
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 0, "");
  {
    const ControlMesh mesh = quad_torus(options.size(500'000, 2'000));
    const LimitSurface surface(mesh, catmark(), std::make_shared<BoundsCache>(), 1);
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
