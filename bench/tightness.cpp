// bench_tightness MODEL...: radius of the offset triangles over the least possible for the same base triangles.
//
// The least possible is the largest distance of a limit point from the base: found on a lattice of limit points and
// improved around its largest by a pattern search. It is a lower bound, so the ratios are upper bounds.

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <snug/enclose/triangle.h>
#include <snug/io/mesh_file.h>
#include <snug/query/subdivide.h>

#include "meshes.h"
#include "runner.h"
#include "subject.h"

namespace {

using namespace snug;
using namespace snug::bench;

// Distance of one patch's limit points from a triangle.
class Deviation {
 public:
  Deviation(const Patch& patch, const Triangle& base)
      : patch_(patch),
        foot_(base[0] - patch.origin, base[1] - patch.origin, base[2] - patch.origin),
        corner_(base[0] - patch.origin) {}

  [[nodiscard]] double at(TriangleParameter p) const {
    const Vector3 q = limit_point(patch_, p).relative;
    const Barycentric foot = foot_(q);
    return length(q - corner_ - foot.b * foot_.edge_b() - foot.c * foot_.edge_c());
  }

  [[nodiscard]] double largest(int side) const {
    TriangleParameter best;
    double value = -1;
    for (int j = 0; j <= side; ++j) {
      for (int i = 0; i + j <= side; ++i) improve({double(i) / side, double(j) / side}, best, value);
    }
    for (double step = 0.5 / side; step > 1e-5; step /= 2) {
      const TriangleParameter c = best;
      for (const auto& [du, dv] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}}) {
        improve({c.u + du * step, c.v + dv * step}, best, value);
      }
    }
    return value;
  }

 private:
  void improve(TriangleParameter p, TriangleParameter& best, double& value) const {
    p.u = std::clamp(p.u, 0.0, 1.0);
    p.v = std::clamp(p.v, 0.0, 1 - p.u);
    const double d = at(p);
    if (d > value) {
      value = d;
      best = p;
    }
  }

  const Patch& patch_;
  TriangleFoot foot_;
  Vector3 corner_;
};

struct Ratios {
  std::vector<double> all;

  // Skips patches so flat that rounding makes up the radius.
  void add(Subject& subject, FaceId face, const OffsetTriangle& enclosure, int side) {
    if (enclosure.radius <= 1000 * enclosure.rounding) return;
    all.push_back(enclosure.radius / Deviation(subject.surface().patch(face), enclosure.base).largest(side));
  }
  void print(const std::string& name) const {
    if (all.empty()) return;
    double sum = 0;
    for (const double r : all) sum += r;
    std::printf("  %-40s  median %.4f  95 %% %.4f  most %.4f  of %zu patches  sum %.12g\n", name.c_str(),
                quantile(all, 0.5), quantile(all, 0.95), quantile(all, 1), all.size(), sum);
    std::fflush(stdout);
  }
};

struct NetShape {
  const char* name;
  double along, across;
};

// Patches around a vertex of valence n in random control nets.
void random_nets(const NetShape& shape, const Options& options, int side) {
  std::printf("one extraordinary corner, %s\n", shape.name);
  for (const std::size_t n : {3u, 4u, 5u, 6u, 7u, 8u, 9u, 10u, 11u, 12u, 20u, 50u}) {
    const auto library = std::make_shared<BoundLibrary>();
    Ratios ratios;
    // Spokes are of length 1, edges across them of about 6 / n: moves along the net must not fold it.
    const double along = shape.along * std::min(1.0, 6.0 / static_cast<double>(n));
    for (int net = 0; net < options.size(60, 3); ++net) {
      ControlMesh mesh = fan_mesh(n, 3);
      disturb(mesh, along, shape.across, static_cast<std::uint64_t>(net) + 1);
      Subject subject(std::move(mesh), library);
      const std::vector<FaceId> faces{FaceId(0), FaceId(n / 2)};
      std::vector<OffsetTriangle> out;
      static_cast<void>(subject.enclose(faces, out));
      for (std::size_t i = 0; i < faces.size(); ++i) ratios.add(subject, faces[i], out[i], side);
    }
    ratios.print("valence " + std::to_string(n));
  }
}

void several_corners(const Options& options, int side) {
  std::printf("irregular mesh, by extraordinary corners\n");
  Subject subject(irregular_mesh(2'000));
  for (std::size_t corners = 0; corners <= 3; ++corners) {
    std::vector<FaceId> faces = faces_with(subject.surface(), corners);
    faces.resize(std::min(faces.size(), options.size<std::size_t>(200, 5)));
    std::vector<OffsetTriangle> out;
    static_cast<void>(subject.enclose(faces, out));
    Ratios ratios;
    for (std::size_t i = 0; i < faces.size(); ++i) ratios.add(subject, faces[i], out[i], side);
    ratios.print(std::to_string(corners) + " extraordinary corners");
  }
}

void model(const std::string& path, const Options& options, int side) {
  std::printf("%s\n", path.c_str());
  const ControlMesh mesh = read_mesh(path);
  for (unsigned level = 0; level <= 2; ++level) {
    Subject subject(subdivide(mesh, {}, level, false));
    // At most about 300 patches, spread over the whole mesh.
    const std::size_t most = options.size<std::size_t>(300, 5);
    const std::size_t stride = (subject.surface().face_count() + most - 1) / most;
    std::vector<FaceId> faces;
    for (std::size_t f = 0; f < subject.surface().face_count(); f += stride) faces.push_back(FaceId(f));
    std::vector<OffsetTriangle> out;
    static_cast<void>(subject.enclose(faces, out));
    Ratios regular, other;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const bool is_regular = extraordinary_corners(subject.surface().kind(faces[i])) == 0;
      (is_regular ? regular : other).add(subject, faces[i], out[i], side);
    }
    regular.print("level " + std::to_string(level) + ", regular");
    other.print("level " + std::to_string(level) + ", extraordinary");
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t files = 0;
  for (int i = 1; i < argc; ++i) files += argv[i][0] != '-' && std::string(argv[i - 1]) != "--rounds";
  const Options options = start(argc, argv, files, " [MODEL...]");
  const int side = options.size(64, 16);
  std::printf("radius over the least possible; lattice of %d steps\n", side);
  for (const NetShape& shape : {NetShape{"flat nets with noise (0.05 across)", 0, 0.05},
                                NetShape{"bumpy nets (0.25 along, 0.5 across)", 0.25, 0.5}}) {
    random_nets(shape, options, side);
  }
  several_corners(options, side);
  for (const std::string& path : options.files) model(path, options, side);
  return 0;
}
