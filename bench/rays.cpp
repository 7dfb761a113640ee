// bench_rays: the 800 x 600 rays of a picture's pixels against the limit surface, beside Embree on triangles whose
// error is one pixel. Files: any models.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <snug/mesh.h>
#include <snug/ray.h>
#include <snug/tessellate.h>

#include "runner.h"

#ifdef SNUG_BENCH_EMBREE
#include "peer_embree.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

// Rays of an eye above the model, to its right, for 800 x 600 pixels; the model fills about half of their height.
struct Pixels {
  Point3 eye;
  double size;  // of a pixel at the model's middle
  std::vector<Vector3> directions;
  std::vector<Ray> rays;
};

Pixels pixels_of(const Surface& surface, const Options& options) {
  Box3 box;
  for (const Point3& p : surface.mesh().points) box.add(p);
  const auto scaled = [](double s, const Vector3& v) { return Vector3{s * v.x, s * v.y, s * v.z}; };
  const Vector3 forward{-0.5, -0.35, -0.7921489759}, right{0.8456, 0, -0.5338};
  const Vector3 up{right.y * forward.z - right.z * forward.y, right.z * forward.x - right.x * forward.z,
                   right.x * forward.y - right.y * forward.x};
  const double distance = 2.2 * surface.size(), tangent = 0.27;
  const int width = options.size(800, 80), height = options.size(600, 60);
  Pixels result{{}, 2 * tangent * distance / height, {}, {}};
  const Vector3 back = scaled(-distance, forward);
  result.eye = {(box.lower.x + box.upper.x) / 2 + back.x, (box.lower.y + box.upper.y) / 2 + back.y,
                (box.lower.z + box.upper.z) / 2 + back.z};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vector3 a = scaled((2 * x + 1 - width) * tangent / height, right),
                    b = scaled((height - 2 * y - 1) * tangent / height, up);
      result.directions.push_back({forward.x + a.x + b.x, forward.y + a.y + b.y, forward.z + a.z + b.z});
      result.rays.push_back({result.eye, result.directions.back()});
    }
  }
  return result;
}

// From every hit towards a light beside the eye, beginning some pixels off the surface.
std::vector<Ray> shadows_of(const Surface& surface, const Pixels& pixels, std::span<const QuickHit> hits) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double t = hits[i].t;
    if (!std::isfinite(t)) continue;
    const Vector3& d = pixels.directions[i];
    const Point3 at{pixels.eye.x + t * d.x, pixels.eye.y + t * d.y, pixels.eye.z + t * d.z};
    const Vector3 to_light{0.3, 0.8, 0.52};
    rays.push_back({at, to_light, 4 * pixels.size, 4 * surface.size()});
  }
  return rays;
}

double sum(std::span<const std::uint8_t> blocked) {
  return static_cast<double>(std::count(blocked.begin(), blocked.end(), std::uint8_t{1}));
}

double sum(std::span<const QuickHit> hits) {
  double total = 0;
  for (const QuickHit& hit : hits) total += std::isfinite(hit.t) ? hit.t : 0;
  return total;
}

#ifdef SNUG_BENCH_EMBREE
TriangleMesh triangles_of(const Surface& surface, double tolerance) {
  TessellateOptions options;
  options.error = tolerance;
  options.normals = false;
  const Tessellation found = tessellate(surface, options, {.threads = 1});
  TriangleMesh mesh;
  mesh.points = found.positions;
  for (const auto& t : found.triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
  return mesh;
}

double sum(std::span<const float> distances) {
  double total = 0;
  for (const float t : distances) total += std::isfinite(t) ? static_cast<double>(t) : 0;
  return total;
}
#endif

void measure_model(const std::string& file, const Options& options) {
  const Surface surface = load(file);
  const Pixels pixels = pixels_of(surface, options);
  const double count = static_cast<double>(pixels.rays.size());
  const std::string name = file.substr(file.find_last_of('/') + 1);
  const RayCaster caster(surface, pixels.size, {.threads = 1});
  std::vector<QuickHit> hits(pixels.rays.size());
  Group group(name + ", a ray a pixel", "ray", options);
  group.add("snug, RayCaster", count, [&] {
    caster.cast(pixels.rays, hits, {.threads = 1});
    return sum(hits);
  });
  group.add("snug, RayCaster, one at a time", count, [&] {
    for (std::size_t i = 0; i < hits.size(); ++i) hits[i] = caster.cast(pixels.rays[i]);
    return sum(hits);
  });
  group.add("snug, ray(), proved", count, [&] {
    double total = 0;
    for (const RayHits& found : snug::ray(surface, pixels.rays, {.absolute = pixels.size}, {.threads = 1})) {
      total += found.certain_hit() ? found.hits.back().t.lower : 0;
    }
    return total;
  });
#ifdef SNUG_BENCH_EMBREE
  const TriangleMesh mesh = triangles_of(surface, pixels.size);
  const EmbreeMesh embree(mesh);
  std::vector<float> distances(pixels.rays.size());
  group.add("Embree, one at a time", count, [&] {
    embree.first_hits(pixels.eye, pixels.directions, distances);
    return sum(distances);
  });
  group.add("Embree, eight at once", count, [&] {
    embree.first_hits_by_eights(pixels.eye, pixels.directions, distances);
    return sum(distances);
  });
#endif
  const std::vector<Times> times = group.run();
  std::printf("# a proved hit takes %.1f times as long\n", ratio(times[2], times[0]));
#ifdef SNUG_BENCH_EMBREE
  std::printf("# rays a second over Embree's: %.2f, over those of eight at once %.2f\n",
              ratio(times[3], times[0]), ratio(times[4], times[0]));
  std::printf("# one at a time, snug over Embree: %.2f\n", ratio(times[1], times[3]));
  caster.cast(pixels.rays, hits, {.threads = 1});
  const std::vector<Ray> shadows = shadows_of(surface, pixels, hits);
  std::vector<std::uint8_t> blocked(shadows.size());
  Group dark(name + ", a shadow ray a hit", "ray", options);
  dark.add("snug, RayCaster", static_cast<double>(shadows.size()), [&] {
    for (std::size_t i = 0; i < shadows.size(); ++i) blocked[i] = caster.blocked(shadows[i]);
    return sum(blocked);
  });
  dark.add("snug, ray(), proved", static_cast<double>(shadows.size()), [&] {
    double total = 0;
    for (const RayHits& found : snug::ray(surface, shadows, {.query = RayQuery::any}, {.threads = 1}))
      total += found.certain_hit();
    return total;
  });
  dark.add("Embree", static_cast<double>(shadows.size()), [&] {
    embree.blocked(shadows, blocked);
    return sum(blocked);
  });
  const std::vector<Times> dark_times = dark.run();
  std::printf("# shadows, snug over Embree: %.2f; proved over unproved: %.1f\n",
              ratio(dark_times[0], dark_times[2]), ratio(dark_times[1], dark_times[0]));
  std::printf("# %zu triangles, %zu KiB; snug %zu KiB, %.3f of it\n", mesh.triangles.size(),
              embree.bytes() / 1024, caster.bytes() / 1024,
              static_cast<double>(caster.bytes()) / static_cast<double>(embree.bytes()));
  Group first(name + ", the first picture: from the surface to its rays' hits", "picture", options);
  first.set_cold();
  first.add("snug", 1, [&] {
    RayCaster(load(file), pixels.size, {.threads = 1}).cast(pixels.rays, hits, {.threads = 1});
    return sum(hits);
  });
  first.add("Embree", 1, [&] {
    const EmbreeMesh made(triangles_of(load(file), pixels.size));
    made.first_hits(pixels.eye, pixels.directions, distances);
    return sum(distances);
  });
  const std::vector<Times> pictures = first.run();
  std::printf("# Embree over snug: %.2f\n", ratio(pictures[1], pictures[0]));
#endif
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, any_files, " MODEL...");
  for (const std::string& file : options.files) measure_model(file, options);
  return 0;
}
