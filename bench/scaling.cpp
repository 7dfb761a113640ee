// bench_scaling: time and memory a patch from a thousand to a million patches, and the exponents these fit.

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "meshes.h"
#include "runner.h"
#include "subject.h"

namespace {

using namespace snug;
using namespace snug::bench;

// Slope of log(cost) over log(size), least squares.
double exponent(const std::vector<double>& sizes, const std::vector<double>& costs) {
  double x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double a = std::log(sizes[i]), b = std::log(costs[i]);
    x += a, y += b, xx += a * a, xy += a * b;
  }
  const auto n = static_cast<double>(sizes.size());
  return (n * xy - x * y) / (n * xx - x * x);
}

void bench_family(const char* name, bool regular, const Options& options) {
  std::vector<double> sizes, surface_seconds, bound_seconds, memory;
  for (const std::size_t wanted : {1'000u, 10'000u, 100'000u, 1'000'000u}) {
    if (options.quick && wanted > 10'000) break;
    const ControlMesh mesh = regular ? regular_mesh(wanted) : irregular_mesh(wanted);
    const auto count = static_cast<double>(mesh.face_count());
    const double mib = peak_mib([&] {
      Subject subject(mesh);
      std::vector<OffsetTriangle> out;
      return subject.enclose_all(out);
    });
    const auto library = std::make_shared<BoundsCache>();
    std::unique_ptr<Subject> subject;
    std::vector<OffsetTriangle> out;
    Group group(std::string(name) + ", " + std::to_string(mesh.face_count()) + " faces", "patch", options);
    if (wanted >= 1'000'000) group.limit_rounds(5);
    group.add("surface, kinds known", count, [&] {
      subject = std::make_unique<Subject>(mesh, library);
      return static_cast<double>(subject->surface().kind_count());
    });
    group.add("offset triangles, kinds known", count, [&] { return subject->enclose_all(out); });
    const std::vector<Times> times = group.run();
    print_peak("both, with the kinds", count, "patch", mib);
    sizes.push_back(count);
    surface_seconds.push_back(times[0].median);
    bound_seconds.push_back(times[1].median);
    memory.push_back(mib);
  }
  std::printf("%s: exponents: surface %.3f, offset triangles %.3f, peak memory %.3f\n", name,
              exponent(sizes, surface_seconds), exponent(sizes, bound_seconds), exponent(sizes, memory));
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 0, "");
  bench_family("regular", true, options);
  bench_family("irregular", false, options);
  return 0;
}
