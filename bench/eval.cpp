// bench_eval: limit points, many a patch, and how far they are from the truth.

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <experiments/quantile.h>
#include <snug/surface/evaluate.h>

#include "meshes.h"
#include "runner.h"
#include "subject.h"
#ifdef SNUG_BENCH_OPENSUBDIV
#include "peer_opensubdiv.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

std::vector<TriangleParameter> random_parameters(std::size_t count, bool triangular) {
  std::mt19937_64 random(5);
  std::vector<TriangleParameter> points;
  while (points.size() < count) {
    const double u = static_cast<double>(random() >> 11) * 0x1p-53;
    const double v = static_cast<double>(random() >> 11) * 0x1p-53;
    if (!triangular || u + v <= 1) points.push_back({u, v});
  }
  return points;
}

// The same parameters on each of some faces, one face after the other.
std::vector<SurfaceParameter> on_faces(const LimitSurface& surface, std::span<const PatchId> faces,
                                       std::span<const TriangleParameter> at) {
  std::vector<SurfaceParameter> places;
  for (const PatchId f : faces) {
    const std::uint32_t owner = surface.place(f).owner;
    for (const TriangleParameter& p : at) places.push_back({owner, 0, p.u, p.v});
  }
  return places;
}

std::vector<SurfaceParameter> shuffled(std::vector<SurfaceParameter> places) {
  std::shuffle(places.begin(), places.end(), std::mt19937_64(6));
  return places;
}

struct Faces {
  const LimitSurface& surface;
  std::vector<PatchId> patches;
  std::vector<TriangleParameter> at;
  std::vector<SurfaceParameter> places;
};

void add_snug(const Faces& faces, Group& group) {
  const auto points = static_cast<double>(faces.places.size());
  group.add("snug: limit points with error bounds", points,
            [&faces, out = std::vector<BoundedPoint>(faces.at.size())]() mutable {
              SurfaceEvaluator evaluator(faces.surface);
              const std::size_t count = faces.at.size();
              double sum = 0;
              for (std::size_t begin = 0; begin < faces.places.size(); begin += count) {
                evaluator.positions({faces.places.data() + begin, count}, out);
                sum += out.back().position.x;
              }
              return sum;
            });
  group.add("snug: the same in single precision", points,
            [&faces, out = std::vector<float>(3 * faces.places.size())]() mutable {
              evaluate(faces.surface, faces.places, {out}, 1);
              double sum = 0;
              for (std::size_t i = faces.at.size(); i <= faces.places.size(); i += faces.at.size()) {
                sum += static_cast<double>(out[3 * (i - 1)]);
              }
              return sum;
            });
}

void add_snug_shuffled(const Faces& faces, Group& group) {
  group.add(
      "snug: in single precision, shuffled", static_cast<double>(faces.places.size()),
      [&faces, places = shuffled(faces.places), out = std::vector<float>(3 * faces.places.size())]() mutable {
        evaluate(faces.surface, places, {out}, 1);
        return static_cast<double>(out[0]);
      });
}

void add_snug_frames(const Faces& faces, Group& group) {
  group.add("snug: with derivatives and normals", static_cast<double>(faces.places.size()), [&faces] {
    SurfaceEvaluator evaluator(faces.surface);
    double sum = 0;
    for (std::size_t i = 0; i < faces.places.size(); ++i) {
      const SurfacePoint point = evaluator(faces.places[i]);
      if ((i + 1) % faces.at.size() == 0) sum += point.tangents[0].x;
    }
    return sum;
  });
}

void bench_faces(const ControlMesh& mesh, const Subject& subject, std::size_t corners, std::size_t per_face,
                 const Options& options) {
  const LimitSurface& surface = subject.surface();
  Faces faces{surface, faces_with(surface, corners), {}, {}};
  faces.patches.resize(std::min(faces.patches.size(), options.size<std::size_t>(128'000, 6'400) / per_face));
  faces.at = random_parameters(per_face, surface.rules().triangular());
  faces.places = on_faces(surface, faces.patches, faces.at);
  Group group(std::string(surface.rules().name) + ", " + std::to_string(corners) +
                  " extraordinary corners, " + std::to_string(per_face) + " points a patch, " +
                  std::to_string(faces.patches.size()) + " patches",
              "point", options);
  add_snug(faces, group);
#ifdef SNUG_BENCH_OPENSUBDIV
  std::vector<PatchId> face_numbers;
  for (const PatchId p : faces.patches) face_numbers.emplace_back(surface.place(p).owner);
  const OsdMesh osd(mesh);
  OsdSurfaces surfaces(osd, face_numbers, true);
  std::vector<Point3> out(per_face);
  std::vector<std::array<Vector3, 2>> derivatives(per_face);
  const auto points = static_cast<double>(faces.places.size());
  group.add("Bfr: patch points and points, in double", points, [&] {
    double sum = 0;
    for (std::size_t i = 0; i < faces.patches.size(); ++i) {
      surfaces.evaluate(i, faces.at, out);
      sum += out.back().x;
    }
    return sum;
  });
#else
  static_cast<void>(mesh);
#endif
  add_snug_frames(faces, group);
  add_snug_shuffled(faces, group);
#ifdef SNUG_BENCH_OPENSUBDIV
  group.add("Bfr: with derivatives", points, [&] {
    double sum = 0;
    for (std::size_t i = 0; i < faces.patches.size(); ++i) {
      surfaces.evaluate(i, faces.at, out, derivatives);
      sum += derivatives.back()[0].x;
    }
    return sum;
  });
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
  const Subject subject(mesh);
  const OsdMesh osd(mesh);
  OsdSurfaces surfaces(osd, all_faces(mesh.face_count()), true);
  SurfaceEvaluator evaluator(subject.surface());
  std::array<Errors, 2> snug, bfr;  // regular and other faces
  double bound = 0;
  std::array<Point3, 1> out;
  for (const OsdLimitSample& sample : osd_limit_samples(mesh, level)) {
    const bool irregular = extraordinary_corners(subject.surface().kind(sample.face)) > 0;
    const BoundedPoint point = evaluator({sample.face.value(), 0, sample.at.u, sample.at.v});
    bound = std::max(bound, point.error);
    snug[irregular].all.push_back(distance(point.position, sample.point));
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
    for (const std::size_t per_face : {16u, 256u}) {
      for (const std::size_t corners : {0u, 1u, 3u}) bench_faces(mesh, subject, corners, per_face, options);
    }
  }
  return 0;
}
