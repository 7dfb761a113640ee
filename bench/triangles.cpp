// bench_triangles: how many triangles a proved error takes, adaptive beside uniform refinement with the same proved error, and how
// fast they are made. Files: any models.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/tessellate.h>

#include "placements.h"
#include "runner.h"

namespace {

using namespace snug;
using namespace snug::bench;

// Triangles of limit points after so many steps of subdivision.
std::vector<Triangle> uniform(const Surface& surface, unsigned level) {
  const ControlMesh mesh = subdivided(surface.mesh(), level, true, {.scheme = surface.scheme()});
  std::vector<Triangle> triangles;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::size_t k = 2; k < face.size(); ++k) {
      triangles.push_back(
          {mesh.points[face[0].index()], mesh.points[face[k - 1].index()], mesh.points[face[k].index()]});
    }
  }
  return triangles;
}

// The first level whose triangles are proved to be within the tolerance, and how many these are.
std::size_t uniform_count(const Surface& surface, double tolerance, unsigned& level) {
  for (level = 0; level < 9; ++level) {
    const std::vector<Triangle> triangles = uniform(surface, level);
    if (triangles.size() > 4'000'000) break;
    const Deviation found =
        deviation(surface, triangles, {.absolute = tolerance / 64, .threshold = tolerance});
    if (std::max(found.from_surface.distance.upper, found.from_candidate.distance.upper) <= tolerance) {
      return triangles.size();
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, any_files, " MODEL...");
  const double share = options.size(1e-3, 1e-2);
  std::vector<double> ratios;
  for (const Model& model : read_models(options.files)) {
    std::optional<Surface> made;
    try {
      made.emplace(model.mesh, SurfaceOptions{.scheme = usual_scheme(model.mesh)});
    } catch (const InputError&) {
      continue;  // without a surface by these rules
    }
    const Surface& surface = *made;
    const double tolerance = share * surface.size();
    const Tessellation adaptive = tessellate(surface, {.error = tolerance, .normals = false});
    unsigned level = 0;
    const std::size_t count = uniform_count(surface, tolerance, level);
    std::printf("# %s: %zu triangles within %g of the size, uniform %zu (level %u)", model.name.c_str(),
                adaptive.triangles.size(), share, count, level);
    if (count > 0) {
      ratios.push_back(static_cast<double>(count) / static_cast<double>(adaptive.triangles.size()));
      std::printf(", %.2f times as many", ratios.back());
    }
    std::printf("\n");

    const double fine = share / 10 * surface.size();
    const std::size_t many = tessellate(surface, {.error = fine, .normals = false}).triangles.size();
    Group rates(
        model.name + ", triangles within " + std::to_string(share / 10) + " of the size, proof included",
        "triangle", options);
    rates.limit_rounds(5);
    for (const int threads : {1, 2}) {
      rates.add("tessellate, threads: " + std::to_string(threads), static_cast<double>(many), [&, threads] {
        const Tessellation t = tessellate(surface, {.error = fine, .normals = false}, {.threads = threads});
        return t.error_bound + static_cast<double>(t.triangles.size());
      });
    }
    rates.run();
  }
  if (ratios.empty()) return 0;
  std::sort(ratios.begin(), ratios.end());
  std::printf("# uniform over adaptive: median %.2f, least %.2f, most %.2f of %zu models\n",
              ratios[ratios.size() / 2], ratios.front(), ratios.back(), ratios.size());
  return 0;
}
