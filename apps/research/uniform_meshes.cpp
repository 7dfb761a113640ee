#include "uniform_meshes.h"

#ifdef SNUG_BENCH_FCL
#include <ctime>
#include <functional>
#include <random>

#include <experiments/quantile.h>
#include <experiments/room_tables.h>
#include <experiments/rooms.h>
#include <peer_fcl.h>
#include <peer_opensubdiv.h>
#endif

namespace snug {

#ifdef SNUG_BENCH_FCL
namespace {

using namespace bench;

constexpr int creation_rounds = 5;

double seconds_of(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double creation_ms(const ControlMesh& mesh, int level, FclBoxes boxes) {
  std::vector<double> times;
  for (int round = 0; round < creation_rounds; ++round) {
    times.push_back(seconds_of([&] { const FclModel tree(osd_uniform(mesh, level), boxes); }));
  }
  return 1e3 * quantile(times, 0.5);
}

double query_us(const FclModel& a, const FclModel& b, const std::vector<PosePair>& at, std::size_t& hits) {
  hits = 0;
  const double seconds = seconds_of([&] {
    for (const PosePair& placed : at) hits += fcl_collide(a, placed.a, b, placed.b);
  });
  return 1e6 * seconds / static_cast<double>(at.size());
}

TriangleMesh uniform(const ControlMesh& mesh, double tolerance) {
  return osd_uniform(mesh, osd_uniform_level(mesh, tolerance));
}

}  // namespace

std::optional<std::vector<std::size_t>> uniform_triangles(const std::vector<ControlMesh>& models,
                                                          const WorkMonitor& monitor) {
  std::vector<std::size_t> rows;
  for (const ControlMesh& mesh : models) {
    for (const double tolerance : table_tolerances) {
      monitor.checkpoint();
      rows.push_back(mesh.face_count() << (2 * osd_uniform_level(mesh, tolerance)));
    }
  }
  return rows;
}

std::optional<std::vector<UniformTimes>> uniform_creation(const std::vector<ControlMesh>& models,
                                                          const WorkMonitor& monitor) {
  std::vector<UniformTimes> rows;
  for (const ControlMesh& mesh : models) {
    for (const double tolerance : table_tolerances) {
      monitor.checkpoint();
      const int level = osd_uniform_level(mesh, tolerance);
      rows.push_back({creation_ms(mesh, level, FclBoxes::obb), creation_ms(mesh, level, FclBoxes::obbrss)});
    }
  }
  return rows;
}

std::optional<std::vector<UniformTimes>> uniform_rooms(const std::vector<ControlMesh>& models,
                                                       std::size_t placements, std::uint64_t seed,
                                                       const WorkMonitor& monitor) {
  std::vector<UniformTimes> rows;
  for (const double side : room_sides) {
    // Those of measure_room().
    std::mt19937_64 random(seed);
    std::vector<PosePair> at(placements);
    for (PosePair& placed : at) placed = place_in_room(side, random);
    for (std::size_t pair = 0; pair + 1 < models.size(); pair += 2) {
      for (const double tolerance : table_tolerances) {
        monitor.checkpoint();
        const TriangleMesh mesh_a = uniform(models[pair], tolerance),
                           mesh_b = uniform(models[pair + 1], tolerance);
        UniformTimes row;
        for (const FclBoxes boxes : {FclBoxes::obb, FclBoxes::obbrss}) {
          const FclModel a(mesh_a, boxes), b(mesh_b, boxes);
          (boxes == FclBoxes::obb ? row.obb : row.obbrss) = query_us(a, b, at, row.hits);
        }
        rows.push_back(row);
      }
    }
  }
  return rows;
}

#else

std::optional<std::vector<std::size_t>> uniform_triangles(const std::vector<ControlMesh>&,
                                                          const WorkMonitor&) {
  return {};
}

std::optional<std::vector<UniformTimes>> uniform_creation(const std::vector<ControlMesh>&,
                                                          const WorkMonitor&) {
  return {};
}

std::optional<std::vector<UniformTimes>> uniform_rooms(const std::vector<ControlMesh>&, std::size_t,
                                                       std::uint64_t, const WorkMonitor&) {
  return {};
}

#endif

}  // namespace snug
