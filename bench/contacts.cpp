// bench_contacts: all contacts of two models that cross, against collide(); how the cost grows with the faces away from
// the contact, with the precision, and with the length of the curve. Files: models.

#include <cmath>
#include <memory>
#include <string>

#include <snug/query/contacts.h>
#include <snug/query/pair_queries.h>

#include "meshes.h"
#include "placements.h"
#include "runner.h"

namespace {

using namespace snug;
using namespace snug::bench;

struct Pair {
  Pair(const ControlMesh& mesh, const Motion& pose)
      : surface(mesh, {usual_scheme(mesh)}, std::make_shared<BoundsCache>()),
        bvh(surface),
        a(bvh),
        b(bvh),
        at(pose) {}
  LimitSurface surface;
  SurfaceBvh bvh;
  SurfaceWorkspace a, b;
  Motion at;
  [[nodiscard]] PlacedBvh first() { return {bvh, a, {}}; }
  [[nodiscard]] PlacedBvh second() { return {bvh, b, at}; }
};

double points_of(const Contacts& found) {
  std::size_t sum = 0;
  for (const IntersectionCurve& curve : found.curves) sum += curve.points.size();
  return static_cast<double>(sum);
}

void measure(const std::string& name, Pair& pair, const Options& options) {
  Group group(name + ", the sum is of points of curves", "answer", options);
  group.add("collide", 1,
            [&] { return static_cast<double>(collide(pair.first(), pair.second(), {}).verdict); });
  group.add("regions alone", 1, [&] {
    return static_cast<double>(contacts(pair.first(), pair.second(), {.curves = false}).regions.size());
  });
  for (const double share : {1e-2, 1e-3, 1e-4}) {
    group.add("contacts, precision " + std::to_string(share), 1, [&, share] {
      const double precision = share * pair.surface.size();
      return points_of(contacts(pair.first(), pair.second(), {.error = precision}, {.threads = 1}));
    });
  }
  group.run();
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, any_files, " MODEL...");
  for (const Model& model : read_models(options.files)) {
    const LimitSurface surface(model.mesh, {usual_scheme(model.mesh)}, std::make_shared<BoundsCache>());
    Pair pair(model.mesh,
              Motion::translation({0.13 * surface.size(), 0.11 * surface.size(), 0.07 * surface.size()}) *
                  Motion::rotation({1, 2, 3}, 0.7));
    measure(model.name, pair, options);
  }
  // The same contact, of two tori that cross in two small places, with ever more faces.
  for (const std::size_t faces : {1000, 10'000, 100'000}) {
    const ControlMesh mesh = regular_mesh(faces);
    Pair pair(mesh, Motion::translation({5.7, 0, 0.1}) * Motion::rotation({1, 0.1, 0}, 1.5));
    measure("torus of " + std::to_string(faces) + " faces", pair, options);
  }
  return 0;
}
