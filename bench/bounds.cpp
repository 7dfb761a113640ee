// bench_bounds A B: what bounds cost beside the cheapest baseline, the box of the control points, and what
// queries cost.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <vector>

#include <snug/evaluate.h>
#include <snug/mesh.h>
#include <snug/query/pair_queries.h>

#include "runner.h"
#include "subject.h"

namespace {

using namespace snug;
using namespace snug::bench;

void bench_patches(const char* title, ControlMesh mesh, std::shared_ptr<BoundsCache> library,
                   const Options& options) {
  Subject subject(std::move(mesh), std::move(library));
  std::printf("%s: %zu patches, %zu kinds\n", title, subject.surface().face_count(),
              subject.surface().kind_count());
  const std::vector<PatchId> faces = all_faces(subject.surface().face_count());
  const auto count = static_cast<double>(faces.size());
  std::vector<Box3> boxes;
  std::vector<OffsetTriangle> triangles;
  Group group(title, "patch", options);
  group.add("box of the control points", count, [&] { return subject.box(faces, boxes); });
  group.add("offset triangle from bounding rows", count, [&] { return subject.enclose(faces, triangles); });
  group.run();
}

Motion random_pose(std::mt19937_64& random, double half_room) {
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  double q[4], norm = 0;
  do {
    norm = 0;
    for (double& x : q) {
      x = unit();
      norm += x * x;
    }
  } while (norm > 1 || norm < 0.01);
  for (double& x : q) x /= std::sqrt(norm);
  const auto [w, x, y, z] = std::to_array(q);
  return Motion::from_3x4({1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
                           half_room * unit(), 2 * (x * y + w * z), 1 - 2 * (x * x + z * z),
                           2 * (y * z - w * x), half_room * unit(), 2 * (x * z - w * y), 2 * (y * z + w * x),
                           1 - 2 * (x * x + y * y), half_room * unit()});
}

void bench_queries(const LimitSurface& a, const LimitSurface& b, const Options& options) {
  const SurfaceBvh model_a(a, {.threads = 1}), model_b(b, {.threads = 1});
  PieceCache scratch_a(model_a), scratch_b(model_b);
  const double size = std::max(a.size(), b.size());
  const int count = options.size(5000, 200);
  for (const double room : {6.0, 3.0}) {
    char title[100];
    std::snprintf(title, sizeof title, "collide in a room of side %g sizes, %d placements", room, count);
    Group group(title, "query", options);
    for (const double tolerance : {0.02, 0.01, 0.001}) {
      std::snprintf(title, sizeof title, "tolerance %g %%", 100 * tolerance);
      group.add(title, count, [&, tolerance] {
        std::mt19937_64 random(7);
        double within = 0;
        for (int i = 0; i < count; ++i) {
          const Motion place_a = random_pose(random, (room - 1) / 2 * size);
          const Motion place_b = random_pose(random, (room - 1) / 2 * size);
          within +=
              collide({model_a, scratch_a, place_a}, {model_b, scratch_b, place_b}, {tolerance * size, 0})
                  .verdict == Verdict::within;
        }
        return within;
      });
    }
    group.run();
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 2, " A B");
  const auto library = std::make_shared<BoundsCache>();
  const ControlMesh mesh = read_mesh(options.files[0]);
  const SchemeOptions rules;
  bench_patches("control mesh", mesh, library, options);
  bench_patches("refined three times", subdivided(mesh, 3), library, options);
  bench_queries(LimitSurface(mesh, rules, library), LimitSurface(read_mesh(options.files[1]), rules, library),
                options);
  return 0;
}
