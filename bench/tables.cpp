// bench_tables: the peers' columns of `snug experiment table-5-1`, `table-5-2` and `table-5-3`, which runs this program and reads
// what it prints: a line "NAME NUMBER NAME NUMBER ..." for each of its own rows, in their order.
//
//   bench_tables NAME PLACEMENTS SEED MODEL...

#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include <experiments/quantile.h>
#include <experiments/room_tables.h>

#include "peer_fcl.h"
#include "peer_opensubdiv.h"
#include "placements.h"

namespace {

using namespace snug;
using namespace snug::bench;

constexpr int creation_rounds = 5;

double seconds_of(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void leaves_table(const std::vector<Model>& models) {
  for (const Model& model : models) {
    for (const double tolerance : table_tolerances) {
      const int level = osd_uniform_level(model.mesh, tolerance);
      std::printf("level %d triangles %zu\n", level, model.mesh.face_count() << (2 * level));
    }
  }
}

double creation_ms(const Model& model, int level, FclBoxes boxes) {
  std::vector<double> times;
  for (int round = 0; round < creation_rounds; ++round) {
    times.push_back(seconds_of([&] { const FclModel tree(osd_uniform(model.mesh, level), boxes); }));
  }
  return 1e3 * quantile(times, 0.5);
}

void creation_table(const std::vector<Model>& models) {
  for (const Model& model : models) {
    for (const double tolerance : table_tolerances) {
      const int level = osd_uniform_level(model.mesh, tolerance);
      std::printf("obb_ms %.17g obbrss_ms %.17g\n", creation_ms(model, level, FclBoxes::obb),
                  creation_ms(model, level, FclBoxes::obbrss));
    }
  }
}

// Microseconds a query.
double query_us(const FclModel& a, const FclModel& b, const std::vector<PosePair>& at, std::size_t& hits) {
  hits = 0;
  const double seconds = seconds_of([&] {
    for (const PosePair& placed : at) hits += fcl_collide(a, placed.a, b, placed.b);
  });
  return 1e6 * seconds / static_cast<double>(at.size());
}

void room_table(const std::vector<Model>& models, std::size_t placements, std::uint64_t seed) {
  for (const double side : room_sides) {
    // The command draws the same ones for each pair and tolerance.
    std::mt19937_64 random(seed);
    std::vector<PosePair> at(placements);
    for (PosePair& placed : at) placed = place_in_room(side, random);
    for (std::size_t pair = 0; pair + 1 < models.size(); pair += 2) {
      for (const double tolerance : table_tolerances) {
        std::vector<TriangleMesh> meshes;
        for (const std::size_t which : {pair, pair + 1}) {
          const ControlMesh& mesh = models[which].mesh;
          meshes.push_back(osd_uniform(mesh, osd_uniform_level(mesh, tolerance)));
        }
        std::size_t hits = 0;
        double times[2];
        for (const FclBoxes boxes : {FclBoxes::obb, FclBoxes::obbrss}) {
          const FclModel a(meshes[0], boxes), b(meshes[1], boxes);
          times[boxes == FclBoxes::obb ? 0 : 1] = query_us(a, b, at, hits);
        }
        std::printf("obb_us %.17g obbrss_us %.17g hits %zu\n", times[0], times[1], hits);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 4) {
    std::fprintf(stderr, "usage: %s table-5-1|table-5-2|table-5-3 PLACEMENTS SEED MODEL...\n", argv[0]);
    return 2;
  }
  try {
    std::vector<Model> models = read_models({words.begin() + 3, words.end()});
    for (Model& model : models) model.mesh.tags = {};
    if (words[0] == "table-5-1") {
      leaves_table(models);
    } else if (words[0] == "table-5-2") {
      creation_table(models);
    } else {
      room_table(models, std::stoull(words[1]), std::stoull(words[2]));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
  return 0;
}
