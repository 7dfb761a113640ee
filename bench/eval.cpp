// bench_eval: limit points, many a patch, and how far they are from the truth.

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <experiments/quantile.h>

#include "meshes.h"
#include "runner.h"
#include "subject.h"
#ifdef SNUG_BENCH_OPENSUBDIV
#include "peer_opensubdiv.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

std::vector<TriangleParameter> random_parameters(std::size_t count) {
  std::mt19937_64 random(5);
  std::vector<TriangleParameter> points;
  while (points.size() < count) {
    const double u = static_cast<double>(random() >> 11) * 0x1p-53;
    const double v = static_cast<double>(random() >> 11) * 0x1p-53;
    if (u + v <= 1) points.push_back({u, v});
  }
  return points;
}

void bench_faces(const ControlMesh& mesh, Subject& subject, std::size_t corners, std::size_t per_face,
                 const Options& options) {
  std::vector<PatchId> faces = faces_with(subject.surface(), corners);
  faces.resize(std::min(faces.size(), options.size<std::size_t>(128'000, 6'400) / per_face));
  const auto points = static_cast<double>(faces.size() * per_face);
  const std::vector<TriangleParameter> at = random_parameters(per_face);
  std::vector<Point3> out(per_face);
  Group group(std::to_string(corners) + " extraordinary corners, " + std::to_string(per_face) +
                  " points a patch, " + std::to_string(faces.size()) + " patches",
              "point", options);
  group.add("snug: limit points with error bounds", points, [&] {
    double sum = 0;
    for (const PatchId f : faces) {
      static_cast<void>(subject.evaluate(f, at, out));
      sum += out.back().x;
    }
    return sum;
  });
  std::vector<LimitEvaluator> kept;
  for (const PatchId f : faces) kept.emplace_back(subject.surface().patch(f));
  group.add("snug: the same, pieces kept", points, [&] {
    double sum = 0;
    for (LimitEvaluator& face : kept) {
      static_cast<void>(subject.evaluate(face, at, out));
      sum += out.back().x;
    }
    return sum;
  });
#ifdef SNUG_BENCH_OPENSUBDIV
  const OsdMesh osd(mesh);
  OsdSurfaces surfaces(osd, faces, true);
  group.add("Bfr: patch points and points, in double", points, [&] {
    double sum = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      surfaces.evaluate(i, at, out);
      sum += out.back().x;
    }
    return sum;
  });
#else
  static_cast<void>(mesh);
#endif
  group.run();
}

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
  Subject subject(mesh);
  const OsdMesh osd(mesh);
  OsdSurfaces surfaces(osd, all_faces(mesh.face_count()), true);
  std::array<Errors, 2> snug, bfr;  // regular and other faces
  double bound = 0;
  std::array<Point3, 1> out;
  for (const OsdLimitSample& sample : osd_limit_samples(mesh, level)) {
    const bool irregular = extraordinary_corners(subject.surface().kind(sample.face)) > 0;
    bound = std::max(bound, subject.evaluate(sample.face, std::array{sample.at}, out));
    snug[irregular].all.push_back(distance(out[0], sample.point));
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
  const ControlMesh mesh = irregular_mesh(options.size(100'000, 2'000));
  Subject subject(mesh);
  for (const std::size_t per_face : {16u, 256u}) {
    for (const std::size_t corners : {0u, 1u, 3u}) bench_faces(mesh, subject, corners, per_face, options);
  }
  return 0;
}
