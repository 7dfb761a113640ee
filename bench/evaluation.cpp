#include "evaluation.h"

#include <algorithm>
#include <array>
#include <random>
#include <span>

#include <snug/surface/evaluate.h>

#include "meshes.h"
#ifdef SNUG_BENCH_OPENSUBDIV
#include "peer_opensubdiv.h"
#endif

namespace snug::bench {
namespace {

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
std::vector<Place> on_faces(const LimitSurface& surface, std::span<const PatchId> faces,
                            std::span<const TriangleParameter> at) {
  std::vector<Place> places;
  for (const PatchId f : faces) {
    const std::uint32_t owner = surface.place(f).owner;
    for (const TriangleParameter& p : at) places.push_back({owner, 0, p.u, p.v});
  }
  return places;
}

std::vector<Place> shuffled(std::vector<Place> places) {
  std::shuffle(places.begin(), places.end(), std::mt19937_64(6));
  return places;
}

struct Faces {
  const LimitSurface& surface;
  std::vector<PatchId> patches;
  std::vector<TriangleParameter> at;
  std::vector<Place> places;
};

void add_snug(const Faces& faces, Group& group) {
  const auto points = static_cast<double>(faces.places.size());
  group.add(snug_with_errors, points, [&faces, out = std::vector<BoundedPoint>(faces.at.size())]() mutable {
    SurfaceEvaluator evaluator(faces.surface);
    const std::size_t count = faces.at.size();
    double sum = 0;
    for (std::size_t begin = 0; begin < faces.places.size(); begin += count) {
      evaluator.positions({faces.places.data() + begin, count}, out);
      sum += out.back().position.x;
    }
    return sum;
  });
  group.add(snug_single, points, [&faces, out = std::vector<float>(3 * faces.places.size())]() mutable {
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

}  // namespace

std::vector<Times> bench_evaluation(const ControlMesh& mesh, const Subject& subject, std::size_t corners,
                                    std::size_t per_face, const Options& options) {
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
  group.add(bfr_points, points, [&] {
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
  return group.run();
}

}  // namespace snug::bench
