// bench_rows: offset triangles of many patches whose kinds are known, from gathering the control points to
// writing.

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

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
  return 0;
}
