// bench_wraps: envelopes within 1 % of the size beside CGAL's alpha_wrap_3 (alpha 1 %, offset 0.5 % of the size) of a tessellation
// within 0.05 %: triangles, seconds, and whether the wrap keeps off the limit surface. Files: any models. With SNUG_WRAPS in the
// environment, wraps are written to that folder: NAME_envelope.obj, NAME_alpha.obj, and what they are around: NAME.obj.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <snug/collide.h>
#include <snug/hull.h>
#include <snug/mesh.h>
#include <snug/tessellate.h>

#include "placements.h"
#include "runner.h"

#ifdef SNUG_BENCH_CGAL_WRAP
#include "peer_cgal_wrap.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

template <class Points, class Triangles>
Surface facets(const Points& points, const Triangles& triangles, const std::string& name) {
  ControlMesh mesh;
  mesh.points.assign(points.begin(), points.end());
  for (const auto& [a, b, c] : triangles) mesh.add_face(std::array{VertexId(a), VertexId(b), VertexId(c)});
  if (const char* folder = std::getenv("SNUG_WRAPS"))
    write_mesh(mesh, std::string(folder) + '/' + name + ".obj");
  return Surface(std::move(mesh), {.scheme = Scheme::flat});
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? NAN : values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, any_files, " MODEL...");
  const double share = options.size(1e-2, 5e-2);
  // As small as doubles tell apart.
  const CollideOptions exactly{.tolerance = 0.0};
  std::vector<double> fewer, faster;
  for (const Model& model : read_models(options.files)) {
    const Surface surface(model.mesh);
    surface.prepare();
    const double size = surface.size();
    Envelope ours;
    Group group(model.name + ", wraps", "wrap", options);
    group.limit_rounds(3);
    group.set_cold();
    group.add("envelope, two threads", 1, [&] {
      ours = envelope(surface, {.error = share * size}, {.threads = 2});
      return static_cast<double>(ours.triangles.size());
    });
#ifdef SNUG_BENCH_CGAL_WRAP
    const Tessellation fine = tessellate(surface, {.error = share * size / 20, .normals = false});
    const TriangleMesh soup{fine.positions, {fine.triangles.begin(), fine.triangles.end()}};
    TriangleMesh theirs;
    group.add("CGAL's alpha_wrap_3", 1, [&] {
      theirs = cgal_alpha_wrap(soup, share * size, share * size / 2);
      return static_cast<double>(theirs.triangles.size());
    });
#endif
    const std::vector<Times> times = group.run();
    std::printf("  %s: envelope %s, %zu triangles", model.name.c_str(), name_of(ours.outcome),
                ours.triangles.size());
    if (ours.outcome == Outcome::complete) {
      std::printf(
          ", collide: %s",
          name_of(collide(facets(ours.positions, ours.triangles, model.name + "_envelope"), surface, exactly)
                      .verdict));
    }
#ifdef SNUG_BENCH_CGAL_WRAP
    const Collision met =
        collide(facets(theirs.points, theirs.triangles, model.name + "_alpha"), surface, exactly);
    if (const char* folder = std::getenv("SNUG_WRAPS"))
      write_mesh(model.mesh, std::string(folder) + '/' + model.name + ".obj");
    const double less =
        static_cast<double>(ours.triangles.size()) / static_cast<double>(theirs.triangles.size());
    const double time = times[0].wall / times[1].wall;
    std::printf("; alpha_wrap_3 %zu triangles, collide: %s; triangles x %.3f, seconds x %.3f",
                theirs.triangles.size(), name_of(met.verdict), less, time);
    if (ours.outcome == Outcome::complete) {
      fewer.push_back(less);
      faster.push_back(time);
    }
#endif
    std::printf("\n");
    std::fflush(stdout);
  }
  if (!fewer.empty()) {
    std::printf(
        "envelope over alpha_wrap_3, of %zu models: triangles x %.3f in the median, %.3f at most; seconds x "
        "%.3f and %.3f\n",
        fewer.size(), median(fewer), *std::max_element(fewer.begin(), fewer.end()), median(faster),
        *std::max_element(faster.begin(), faster.end()));
  }
  return 0;
}
