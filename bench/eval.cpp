// bench_eval: limit points, many a patch, and how far they are from the truth.

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <experiments/quantile.h>
#include <snug/surface/evaluate.h>

#include "evaluation.h"
#include "meshes.h"
#ifdef SNUG_BENCH_OPENSUBDIV
#include "peer_opensubdiv.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

#ifdef SNUG_BENCH_OPENSUBDIV
struct Errors {
  std::vector<double> all;
  void print(const char* name, double size) const {
    std::printf("  %-40s  median %.2e  95 %% %.2e  most %.2e of the size\n", name, quantile(all, 0.5) / size,
                quantile(all, 0.95) / size, quantile(all, 1) / size);
  }
};

// Against uniform refinement and its limit positions in double, which are exact at the corners of the pieces.
void print_errors(std::size_t face_count, int level) {
  const ControlMesh mesh = irregular_mesh(face_count);
  const Subject subject(mesh);
  const OsdMesh osd(mesh);
  OsdSurfaces surfaces(osd, all_faces(mesh.face_count()), true);
  SurfaceEvaluator evaluator(subject.surface());
  std::array<Errors, 2> snug, bfr;  // regular and other faces
  double bound = 0;
  std::array<Point3, 1> out;
  for (const OsdLimitSample& sample : osd_limit_samples(mesh, level)) {
    const bool irregular = extraordinary_corners(subject.surface().kind(sample.face)) > 0;
    const SurfacePoint point = evaluator({sample.face.value(), 0, sample.at.u, sample.at.v});
    bound = std::max(bound, point.error);
    snug[irregular].all.push_back(distance(point.point, sample.point));
    surfaces.evaluate(sample.face.index(), std::array{sample.at}, out);
    bfr[irregular].all.push_back(distance(out[0], sample.point));
  }
  std::printf("distance to Far's limit positions after %d uniform steps, %zu faces, size %.3g\n", level,
              mesh.face_count(), subject.surface().size());
  const double size = subject.surface().size();
  snug[0].print("snug, regular faces", size);
  bfr[0].print("Bfr, regular faces", size);
  snug[1].print("snug, faces with extraordinary corners", size);
  bfr[1].print("Bfr, faces with extraordinary corners", size);
  std::printf("  %-40s  most %.2e of the size a coordinate\n", "snug's own bound of its error", bound / size);
}
#endif

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 0, "");
#ifdef SNUG_BENCH_OPENSUBDIV
  print_errors(options.size<std::size_t>(2'000, 500), options.size(4, 2));
#endif
  const std::size_t faces = options.size(100'000, 2'000);
  for (const ControlMesh& mesh : {irregular_mesh(faces), irregular_quads(faces)}) {
    const bool loop = mesh.face(FaceId(0u)).size() == 3;
    const Subject subject(mesh, {loop ? Scheme::loop : Scheme::catmark});
    for (const std::size_t per_face : {16u, 100u, 256u}) {
      for (const std::size_t corners : {0u, 1u, 3u})
        bench_evaluation(mesh, subject, corners, per_face, options);
    }
  }
  return 0;
}
