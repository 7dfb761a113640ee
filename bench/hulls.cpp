// bench_hulls: both hulls of solids, and envelopes, within 1 % of their size, verified. Files: closed models.

#include <cmath>
#include <string>

#include <snug/hull.h>

#include "placements.h"
#include "runner.h"

int main(int argc, char** argv) {
  using namespace snug;
  using namespace snug::bench;
  const Options options = start(argc, argv, any_files, " MODEL...");
  const double share = options.size(1e-2, 3e-2);
  for (const Model& model : read_models(options.files)) {
    const Surface surface(model.mesh, {.scheme = usual_scheme(model.mesh)});
    surface.prepare();
    Group group(model.name + ", both hulls within " + std::to_string(share) + " of the size, verified",
                "pair of hulls", options);
    for (const int threads : {1, 2}) {
      group.add("hulls, threads: " + std::to_string(threads), 1, [&, threads] {
        const Hulls h = hull(surface, {.error = share * surface.size()}, {.threads = threads});
        return h.outcome == Outcome::complete
                   ? static_cast<double>(h.outer->triangles.size() + h.inner->triangles.size())
                   : NAN;
      });
    }
    group.run();
    Group wraps(model.name + ", envelope within " + std::to_string(share) + " of the size, verified",
                "envelope", options);
    for (const int threads : {1, 2}) {
      wraps.add("envelope, threads: " + std::to_string(threads), 1, [&, threads] {
        const Envelope e = envelope(surface, {.error = share * surface.size()}, {.threads = threads});
        return e.outcome == Outcome::complete ? static_cast<double>(e.triangles.size()) : NAN;
      });
    }
    wraps.run();
  }
  return 0;
}
