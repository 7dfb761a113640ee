// bench_models: whole models cold and near the limit, beside what else does it. Files: any models of Loop or Catmull-Clark.
//
// Set-up and bounds of every face beside Bfr's surfaces and boxes; triangles within 0.1 % beside uniform refinement to the first
// level that deviation() finds that near; a ray caster's build and bytes beside Embree's of the triangles; memory of both hulls.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/hull.h>
#include <snug/ray.h>
#include <snug/tessellate.h>

#include "placements.h"
#include "runner.h"
#include "subject.h"
#ifdef SNUG_BENCH_OPENSUBDIV
#include "peer_opensubdiv.h"
#endif
#ifdef SNUG_BENCH_EMBREE
#include "peer_embree.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

constexpr double share = 1e-3;

double time_of_one(const Times& times) { return times.median / times.items; }

void measure_cold(const Model& model, Scheme scheme, const Options& options) {
  const auto faces = static_cast<double>(model.mesh.face_count());
  Group group(model.name + ", set-up and bounds", "face", options);
  group.limit_rounds(7);
  group.add("snug: offset triangles of all faces", faces, [&] {
    std::vector<OffsetTriangle> out;
    return Subject(model.mesh, {scheme}).enclose_all(out);
  });
#ifdef SNUG_BENCH_OPENSUBDIV
  group.add("Bfr: surfaces and boxes (no proof)", faces, [&] {
    const OsdMesh osd(model.mesh);
    return OsdSurfaces(osd, all_faces(model.mesh.face_count()), true).box_all();
  });
  const std::vector<Times> times = group.run();
  std::printf("# %s: %.0f faces, cold, snug over Bfr and boxes: %.2f\n", model.name.c_str(), faces,
              ratio(times[0], times[1]));
#else
  group.run();
#endif
}

TriangleMesh triangles_of(const Tessellation& found) {
  TriangleMesh mesh;
  mesh.points = found.positions;
  for (const auto& t : found.triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
  return mesh;
}

#ifdef SNUG_BENCH_OPENSUBDIV
// The first level whose triangles are proved to be within the tolerance; nothing above four million.
std::optional<int> near_level(const ControlMesh& mesh, Scheme scheme, double tolerance, bool limit_points) {
  const Surface surface(mesh, {.scheme = scheme});
  for (int level = 0;; ++level) {
    const TriangleMesh uniform = osd_uniform(mesh, level, limit_points);
    if (uniform.triangles.size() > 4'000'000) return {};
    std::vector<Triangle> triangles;
    triangles.reserve(uniform.triangles.size());
    for (const auto& t : uniform.triangles) {
      triangles.push_back({uniform.points[t[0]], uniform.points[t[1]], uniform.points[t[2]]});
    }
    const Deviation found =
        deviation(surface, triangles, {.absolute = tolerance / 64, .threshold = tolerance});
    if (std::max(found.from_surface.distance.upper, found.from_candidate.distance.upper) <= tolerance) {
      return level;
    }
  }
}
#endif

void measure_triangles(const Model& model, Scheme scheme, const Options& options) {
  const double tolerance = share * Surface(model.mesh, {.scheme = scheme}).size();
  const auto made = [&](double error) {
    return tessellate(Surface(model.mesh, {.scheme = scheme}), {.error = error, .normals = false},
                      {.threads = 1});
  };
  const Tessellation found = made(tolerance);
  const auto count = static_cast<double>(found.triangles.size());
  Group group(model.name + ", triangles within 0.1 %, cold", "mesh", options);
  group.limit_rounds(5);
  group.add("snug: tessellate, proved", 1, [&] { return made(tolerance).error_bound; });
  std::vector<std::string> names;
#ifdef SNUG_BENCH_OPENSUBDIV
  // Cold: no surface of ours is alive while these are timed.
  for (const bool limit_points : {true, false}) {
    const std::optional<int> level = near_level(model.mesh, scheme, tolerance, limit_points);
    if (!level) continue;
    names.push_back("level " + std::to_string(*level) + (limit_points ? " with limit points" : ""));
    group.add("Far: uniform refinement, " + names.back(), 1, [&model, limit_points, level = *level] {
      return osd_uniform(model.mesh, level, limit_points).points.front().x;
    });
  }
#endif
  const std::vector<Times> times = group.run();
  std::printf("# %s: %.0f triangles, %.2f us each\n", model.name.c_str(), count,
              1e6 * times[0].median / count);
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::printf("# %s: uniform (%s) over snug: %.2f\n", model.name.c_str(), names[i].c_str(),
                time_of_one(times[i + 1]) / time_of_one(times[0]));
  }
#ifdef SNUG_BENCH_EMBREE
  const Surface surface(model.mesh, {.scheme = scheme});
  const TriangleMesh mesh = triangles_of(found);
  const EmbreeMesh embree(mesh);
  const RayCaster caster(surface, tolerance, {.threads = 1});
  Group builds(model.name + ", to cast rays within 0.1 %", "model", options);
  builds.limit_rounds(5);
  builds.add("snug: RayCaster", 1,
             [&] { return static_cast<double>(RayCaster(surface, tolerance, {.threads = 1}).bytes()); });
  builds.add("Embree: of the triangles", 1,
             [&] { return static_cast<double>(EmbreeMesh(mesh).bytes() > 0); });
  const std::vector<Times> build_times = builds.run();
  std::printf("# %s: caster's build over Embree's: %.2f, bytes %.3f\n", model.name.c_str(),
              ratio(build_times[0], build_times[1]),
              static_cast<double>(caster.bytes()) / static_cast<double>(embree.bytes()));
#endif
}

void measure_hulls(const Model& model, Scheme scheme) {
  constexpr std::size_t most_faces = 3'000;
  if (model.mesh.face_count() > most_faces) return;
  const Surface surface(model.mesh, {.scheme = scheme});
  const double mib = peak_mib([&] {
    const Hulls h = hull(surface, {.error = share * surface.size()}, {.threads = 1, .max_splits = 1'000'000});
    if (h.outcome != Outcome::complete) throw std::runtime_error("no hulls");
    return static_cast<double>(h.outer->triangles.size());
  });
  print_peak(model.name + ", both hulls within 0.1 %", static_cast<double>(model.mesh.face_count()), "face",
             mib);
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, any_files, " MODEL...");
  for (const Model& model : read_models(options.files)) {
    const Scheme scheme = usual_scheme(model.mesh);
    try {
      measure_cold(model, scheme, options);
      measure_triangles(model, scheme, options);
      if (!options.quick) measure_hulls(model, scheme);
    } catch (const std::exception& error) {
      std::printf("# %s: %s\n", model.name.c_str(), error.what());
    }
  }
  return 0;
}
