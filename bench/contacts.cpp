// bench_contacts: all contacts of two models that cross, against collide(); how the cost grows with the faces away from
// the contact, with the precision, and with the length of the curve. Files: models.

#include <cmath>
#include <string>

#include <snug/contacts.h>

#include "meshes.h"
#include "placements.h"
#include "runner.h"

namespace {

using namespace snug;
using namespace snug::bench;

double points_of(const Contacts& found) {
  std::size_t sum = 0;
  for (const IntersectionCurve& curve : found.curves) sum += curve.points.size();
  return static_cast<double>(sum);
}

void measure(const std::string& name, const Surface& first, const PlacedSurface& second,
             const Options& options) {
  Group group(name + ", the sum is of points of curves", "answer", options);
  group.add("collide", 1, [&] { return static_cast<double>(collide(first, second).verdict); });
  group.add("regions alone", 1,
            [&] { return static_cast<double>(contacts(first, second, {.curves = false}).regions.size()); });
  for (const double share : {1e-2, 1e-3, 1e-4}) {
    group.add("contacts, precision " + std::to_string(share), 1, [&, share] {
      const double precision = share * first.size();
      return points_of(contacts(first, second, {.error = precision}, {.threads = 1}));
    });
  }
  group.run();
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, any_files, " MODEL...");
  for (const Model& model : read_models(options.files)) {
    const Surface surface(model.mesh, {.scheme = usual_scheme(model.mesh)});
    const double size = surface.size();
    const Motion pose =
        Motion::translation({0.13 * size, 0.11 * size, 0.07 * size}) * Motion::rotation({1, 2, 3}, 0.7);
    measure(model.name, surface, surface.at(pose), options);
  }
  // The same contact, of two tori that cross in two small places, with ever more faces.
  for (const std::size_t faces : {1000, 10'000, 100'000}) {
    const Surface torus(regular_mesh(faces));
    const Motion pose = Motion::translation({5.7, 0, 0.1}) * Motion::rotation({1, 0.1, 0}, 1.5);
    measure("torus of " + std::to_string(faces) + " faces", torus, torus.at(pose), options);
  }
  return 0;
}
