// bench_refit: the same mesh with other positions: what it costs until every patch is bounded again.
//
// The peer has no bounds. Its columns are the least that a refit of its tables does, before anything is
// bounded: the vertices of one refinement; three limit corners a patch; ten limit points a patch. All from
// tables made beforehand.

#include <cstdio>
#include <string>
#include <vector>

#include <experiments/corner_nets.h>

#include "meshes.h"
#include "runner.h"
#include "subject.h"
#ifdef SNUG_BENCH_OPENSUBDIV
#include "peer_opensubdiv.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

#ifdef SNUG_BENCH_OPENSUBDIV
struct Table {
  std::string name;
  OsdStencils stencils;
};

std::vector<Table> tables(const ControlMesh& mesh) {
  const std::vector<TriangleParameter> corners{{0, 0}, {1, 0}, {0, 1}};
  std::vector<TriangleParameter> ten;
  for (int j = 0; j <= 3; ++j) {
    for (int i = 0; i + j <= 3; ++i) ten.push_back({i / 3.0, j / 3.0});
  }
  std::vector<Table> all;
  all.push_back({"Far: vertices of one refinement", OsdStencils::refined(mesh)});
  all.push_back({"Far: three limit corners a patch", OsdStencils::limit(mesh, corners, 2)});
  all.push_back({"Far: ten limit points a patch", OsdStencils::limit(mesh, ten, 2)});
  return all;
}
#endif

#ifdef SNUG_BENCH_OPENSUBDIV
// As many limit points a patch as snug has bounding points, spread evenly: what a bound from the peer's points
// would need at least, were it a proof.
void bench_as_many_points(const Options& options) {
  const ControlMesh mesh = irregular_mesh(options.size(5'000, 2'000));
  ControlMesh moved = mesh;
  disturb(moved, 0.01, 0.01, 3);
  Subject subject(mesh);
  const auto count = static_cast<double>(mesh.face_count());
  const auto wanted = static_cast<std::size_t>(static_cast<double>(subject.hull_point_count()) / count);
  std::vector<TriangleParameter> at;
  int steps = 1;
  while (static_cast<std::size_t>((steps + 1) * (steps + 2) / 2) < wanted) ++steps;
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i + j <= steps && at.size() < wanted; ++i) {
      at.push_back({static_cast<double>(i) / steps, static_cast<double>(j) / steps});
    }
  }
  OsdStencils stencils = OsdStencils::limit(mesh, at, 2);
  BatchBounds bounds = subject.bounds(all_faces(mesh.face_count()));
  std::vector<OffsetTriangle> triangles;
  Group group("new positions, " + std::to_string(mesh.face_count()) + " faces, " + std::to_string(wanted) +
                  " bounding points a patch in the mean",
              "patch", options);
  group.add("snug: offset triangles", count, [&] { return update(bounds, moved.points, triangles); });
  group.add("Far: as many limit points, double", count, [&] { return stencils.update(moved.points); });
  group.run();
}
#endif

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 0, "");
  const ControlMesh mesh = irregular_mesh(options.size(100'000, 2'000));
  ControlMesh moved = mesh;
  disturb(moved, 0.01, 0.01, 3);
  const auto count = static_cast<double>(mesh.face_count());

  Subject subject(mesh);
  print_statistics("irregular", subject.surface());
  const std::vector<PatchId> faces = all_faces(mesh.face_count());
  std::vector<OffsetTriangle> triangles;
  std::vector<Box3> boxes;
  Group group("new positions", "patch", options);
  BatchBounds rows = subject.bounds(faces), by_tables = subject.bounds(faces, BoundMethod::table);
  group.add("snug: offset triangles", count, [&] { return update(rows, moved.points, triangles); });
  group.add("snug: offset triangles from tables", count,
            [&] { return update(by_tables, moved.points, triangles); });
  group.add("snug: boxes of the control points", count, [&] { return subject.box(faces, boxes); });
#ifdef SNUG_BENCH_OPENSUBDIV
  std::vector<Table> all = tables(mesh);
  for (Table& table : all) {
    OsdStencils& stencils = table.stencils;
    std::printf("%s: %zu stencils, %zu weights\n", table.name.c_str(), stencils.count(), stencils.weights());
    stencils.set_float_points(moved.points);
    group.add(table.name + ", double", count, [&] { return stencils.update(moved.points); });
    group.add(table.name + ", float (Osd)", count, [&] { return stencils.update_float(); });
  }
#endif
  group.run();
#ifdef SNUG_BENCH_OPENSUBDIV
  bench_as_many_points(options);
#endif
  return 0;
}
