// bench_rows: offset triangles of many patches whose kinds are known, from gathering the control points to
// writing.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <snug/query/subdivide.h>

#include "meshes.h"
#include "runner.h"
#include "subject.h"

namespace {

using namespace snug;
using namespace snug::bench;

void bench_faces(const std::string& title, Subject& subject, const std::vector<PatchId>& faces,
                 const Options& options) {
  const auto count = static_cast<double>(faces.size());
  std::vector<Box3> boxes;
  std::vector<OffsetTriangle> triangles;
  Group group(title + ", " + std::to_string(faces.size()) + " patches", "patch", options);
  group.add("box of the control points", count, [&] { return subject.box(faces, boxes); });
  const auto& points = subject.surface().mesh().points;
  BatchBounds rows = subject.bounds(faces), tables = subject.bounds(faces, BoundMethod::table);
  group.add("offset triangle from hull rows, a patch at a time", count,
            [&] { return subject.enclose(faces, triangles); });
  group.add("offset triangle from hull rows", count, [&] { return update(rows, points, triangles); });
  group.add("offset triangle from tables", count, [&] { return update(tables, points, triangles); });
  group.run();
}

// Both ways of Catmull-Clark patches, by the corners of theirs that are not regular.
void bench_quads(const std::string& title, const ControlMesh& mesh, const Options& options) {
  const SchemeOptions scheme{Scheme::catmark, BoundaryRule::edge_and_corner};
  const LimitSurface surface(mesh, scheme, std::make_shared<BoundsCache>(), 1);
  std::vector<std::vector<PatchId>> patches(4);
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    patches[extraordinary_corners(surface.kind(PatchId(p)))].push_back(PatchId(p));
  }
  for (std::size_t corners = 0; corners <= 3; ++corners) {
    const std::vector<PatchId>& some = patches[corners];
    if (some.empty()) continue;
    const auto count = static_cast<double>(some.size());
    Group group(title + ", " + std::to_string(corners) + " extraordinary corners, " +
                    std::to_string(some.size()) + " patches",
                "patch", options);
    std::vector<OffsetTriangle> triangles;
    BatchBounds rows(surface, some, BoundMethod::rows, 1), tables(surface, some, BoundMethod::table, 1);
    group.add("offset triangle from hull rows", count, [&] { return update(rows, mesh.points, triangles); });
    group.add("offset triangle from tables", count, [&] { return update(tables, mesh.points, triangles); });
    group.run();
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 0, "");
  {
    Subject regular(regular_mesh(options.size(1'000'000, 2'000)));
    bench_faces("regular", regular, all_faces(regular.surface().face_count()), options);
  }
  Subject irregular(irregular_mesh(options.size(100'000, 2'000)));
  print_statistics("irregular", irregular.surface());
  for (std::size_t corners = 0; corners <= 3; ++corners) {
    bench_faces(std::to_string(corners) + " extraordinary corners", irregular,
                faces_with(irregular.surface(), corners), options);
  }
  bench_quads("regular quads", quad_torus(options.size(200'000, 2'000)), options);
  bench_quads("irregular quads",
              subdivide(irregular_mesh(options.size(30'000, 1'000)), {Scheme::catmark}, 1, false), options);
  return 0;
}
