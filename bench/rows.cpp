// bench_rows: offset triangles of many patches whose kinds are known, from gathering the control points to
// writing.

#include <string>

#include <snug/evaluate.h>

#include "meshes.h"
#include "patches.h"

using namespace snug;
using namespace snug::bench;

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
              subdivided(irregular_mesh(options.size(30'000, 1'000)), 1, false, {.scheme = Scheme::catmark}),
              options);
  return 0;
}
