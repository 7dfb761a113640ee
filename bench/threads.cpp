// bench_threads: everything that takes --threads, on two threads against one. Wall time, in turns.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <experiments/convergence.h>
#include <experiments/quantile.h>
#include <experiments/tightness.h>
#include <snug/distance.h>
#include <snug/search/surface_data.h>
#include <snug/surface/batch_bounds.h>
#include <support/parallel.h>
#ifdef SNUG_BENCH_PICTURE
#include <picture/render.h>
#endif

#include "meshes.h"
#include "runner.h"

namespace {

using namespace snug;
using namespace snug::bench;

// Does the work with so many threads; returns a checksum.
using Work = std::function<double(int threads)>;

struct Run {
  double wall, processor, checksum;
};

Run run(const Work& work, int threads) {
  const std::clock_t before = std::clock();
  const auto start = std::chrono::steady_clock::now();
  const double checksum = work(threads);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {wall, static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, checksum};
}

// A line: milliseconds of both, how many times faster two threads are, and how much processor time they take
// beside one: what they do twice, which shows on a busy machine, too.
void compare(const Options& options, const std::string& name, const Work& work) {
  std::vector<double> one, two, faster, more;
  double checksum = 0;
  for (int round = -1; round < options.rounds; ++round) {
    const Run of_one = run(work, 1), of_two = run(work, 2);
    if (of_one.checksum != of_two.checksum || (round >= 0 && of_one.checksum != checksum)) {
      throw std::logic_error(name + ": the checksum depends on threads");
    }
    checksum = of_one.checksum;
    if (round < 0) continue;  // the first round warms up
    one.push_back(of_one.wall);
    two.push_back(of_two.wall);
    faster.push_back(of_one.wall / of_two.wall);
    more.push_back(of_two.processor / of_one.processor);
  }
  std::printf("  %-42s  %9.2f ms  %9.2f ms  x %.2f  [%.2f-%.2f]  processor x %.2f  sum %.17g\n", name.c_str(),
              1e3 * quantile(one, 0.5), 1e3 * quantile(two, 0.5), quantile(one, 0.5) / quantile(two, 0.5),
              quantile(faster, 0), quantile(faster, 1), quantile(more, 0.5), checksum);
  std::fflush(stdout);
}

LimitSurface surface_of(const ControlMesh& mesh) {
  return {mesh, {Scheme::loop, BoundaryRule::edge_and_corner}, std::make_shared<BoundsCache>()};
}

void compare_surfaces(const Options& options, const ControlMesh& mesh, const Surface& handle) {
  const LimitSurface& surface = handle.data()->limit();
  compare(options, "surface, kinds and rows not known", [&](int threads) {
    return static_cast<double>(BatchBounds(surface_of(mesh), {}, threads).patches().size());
  });
  for (const bool tight : {false, true}) {
    compare(options, tight ? "model, tight" : "model", [&, tight](int threads) {
      return SurfaceBvh(surface, {.tight = tight, .threads = threads}).ball().radius;
    });
  }
  BatchBounds bounds(surface, {}, 1);
  std::vector<OffsetTriangle> out(bounds.patches().size());
  compare(options, "bounds of all patches, refit", [&](int threads) {
    bounds.update(mesh.points, out, threads);
    double sum = 0;
    for (const OffsetTriangle& triangle : out) sum += triangle.radius;
    return sum;
  });
  for (const unsigned level : {0u, 1u}) {
    compare(options, "bound, level " + std::to_string(level), [&, level](int threads) {
      double sum = 0;
      BoundOptions how;
      how.level = level;
      bound(handle, how, [&](const PatchEnclosure& piece) { sum += piece.offset.radius; },
            {.threads = threads});
      return sum;
    });
  }
}

void compare_closest(const Options& options, const Surface& surface) {
  surface.prepare();
  std::mt19937_64 random(1);
  const auto draw = [&](double reach) { return reach * (static_cast<double>(random() >> 11) * 0x1p-52 - 1); };
  for (const double reach : {5.0, 100.0}) {
    std::vector<Point3> points(options.size(20'000, 500));
    for (Point3& p : points) p = {draw(reach), draw(reach), draw(reach)};
    for (const double precision : {1e-2, 1e-4}) {
      char name[64];
      std::snprintf(name, sizeof name, "closest, %zu points in +-%.0f, to %.0e", points.size(), reach,
                    precision);
      compare(options, name, [&, precision](int threads) {
        double sum = 0;
        for (const ClosestPoint& at :
             closest_point(surface, points, {.absolute = precision}, {.threads = threads})) {
          sum += at.distance.upper;
        }
        return sum;
      });
    }
  }
}

void compare_experiments(const Options& options) {
  compare(options, "experiment rates", [&](int threads) {
    RateOptions how;
    how.nets = options.size<std::size_t>(10, 1);
    how.threads = threads;
    double sum = 0;
    for (const RateRow& row : measure_rates(how)) sum += row.factor;
    return sum;
  });
  compare(options, "experiment tightness", [&](int threads) {
    TightnessOptions how;
    how.nets = options.size<std::size_t>(4, 1);
    how.threads = threads;
    double sum = 0;
    for (const TightnessRow& row : measure_tightness(how)) sum += row.median;
    return sum;
  });
}

#ifdef SNUG_BENCH_PICTURE
void compare_picture(const Options& options, const ControlMesh& mesh) {
  PictureScene scene;
  scene.materials.emplace_back();
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    ShadedTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle.corner[k] = mesh.points[mesh.face(FaceId(f))[k].index()];
    scene.triangles.push_back(triangle);
  }
  Box3 box;
  for (const Point3& p : mesh.points) box.add(p);
  const Camera camera = frame(box, {0.4, 0.7, -1}, {0, 0, 1}, 1);
  compare(options, "render, flat triangles", [&](int threads) {
    RenderOptions how;
    how.width = how.height = options.size(600, 60);
    how.parallel_for = [threads](std::size_t count, const auto& body) { parallel_for(count, threads, body); };
    return static_cast<double>(render_counted(scene, camera, how).hits);
  });
}
#endif

}  // namespace

int main(int argc, char** argv) {
  Options options = start(argc, argv, 0, "");
  options.rounds = std::min(options.rounds, 5);
  std::printf(
      "one thread, two threads, medians of %d rounds in turns; how many times faster [range]; processor time "
      "beside one "
      "thread's; %d cores\n",
      options.rounds, hardware_threads());
  const ControlMesh mesh = irregular_mesh(options.size(100'000, 2'000));
  const Surface surface(mesh, {.scheme = Scheme::loop});
  compare_surfaces(options, mesh, surface);
  compare_closest(options, surface);
#ifdef SNUG_BENCH_PICTURE
  compare_picture(options, mesh);
#endif
  compare_experiments(options);
  std::printf(
      "# eval, subdivide, collide, distance and curves answer on one thread: --threads is for their "
      "set-up\n");
  return 0;
}
