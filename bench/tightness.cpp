// bench_tightness MODEL...: radius of the offset triangles over the least possible for the same base
// triangles (experiments/tightness.h), on real meshes and on patches with several extraordinary corners. The
// ratios are upper bounds. `snug-research tightness` has patches with one extraordinary corner, and
// tables.

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <experiments/quantile.h>
#include <experiments/tightness.h>
#include <snug/evaluate.h>
#include <snug/mesh.h>

#include "meshes.h"
#include "runner.h"
#include "subject.h"

namespace {

using namespace snug;
using namespace snug::bench;

struct Ratios {
  std::vector<double> all;

  // Skips patches so flat that rounding makes up the radius.
  void add(Subject& subject, PatchId face, const OffsetTriangle& enclosure, int side) {
    if (enclosure.radius <= 1000 * enclosure.rounding) return;
    const Patch patch = subject.surface().patch(face);
    all.push_back(enclosure.radius / LimitLattice(patch, side).min_radius(enclosure.base));
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

void several_corners(const Options& options, int side) {
  std::printf("irregular mesh, by extraordinary corners\n");
  Subject subject(irregular_mesh(2'000));
  for (std::size_t corners = 0; corners <= 3; ++corners) {
    std::vector<PatchId> faces = faces_with(subject.surface(), corners);
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
    Subject subject(subdivided(mesh, level, false, {.scheme = Scheme::loop}));
    // At most about 300 patches, spread over the whole mesh.
    const std::size_t most = options.size<std::size_t>(300, 5);
    const std::size_t stride = (subject.surface().face_count() + most - 1) / most;
    std::vector<PatchId> faces;
    for (std::size_t f = 0; f < subject.surface().face_count(); f += stride) faces.push_back(PatchId(f));
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
  several_corners(options, side);
  for (const std::string& path : options.files) model(path, options, side);
  return 0;
}
