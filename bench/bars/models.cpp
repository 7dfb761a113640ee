#include <algorithm>
#include <cstdio>
#include <memory>
#include <random>

#include <snug/evaluate.h>
#include <snug/measure.h>
#include <snug/surface.h>

#include "bars.h"
#include "peers.h"

namespace snug::bench {
namespace {

// Two models of about 3,000 faces, seen from all sides, with trees made where queries come.
void add_memory(const ModelPair& pair, const Options& options, BarTable& table) {
  const auto refined = [](const Model& model) {
    unsigned level = 0;
    while (model.mesh.face_count() << (2 * level) < 2'000) ++level;
    return Model{model.name, subdivided(model.mesh, level)};
  };
  const Model a = refined(pair.a), b = refined(pair.b);
  SnugPair models(a, b, std::make_shared<BoundsCache>());
  std::mt19937_64 random(11);
  const auto count = options.size<std::size_t>(20'000, 1'000);
  for (std::size_t i = 0; i < count; ++i) {
    static_cast<void>(models.queries.collide(place_in_room(3, random), collide_tolerance));
  }
  constexpr double megabyte = 1e6;
  const auto all = static_cast<double>(models.queries.bytes()) / megabyte;
  const auto scratch = static_cast<double>(models.queries.scratch_bytes()) / megabyte;
  std::printf("%s, %zu and %zu faces, %zu queries: workspaces %.2f MB, trees and workspaces %.2f MB\n",
              pair.name().c_str(), a.mesh.face_count(), b.mesh.face_count(), count, scratch, all);
  table.at_most("memory after 20,000 queries", "MB of both workspaces", 3, pair.name(), scratch);
  table.at_most("memory after 20,000 queries", "MB of both trees and workspaces", 3, pair.name(), all);
}

void add_tight(const Model& model, const Options& options, BarTable& table) {
  const LimitSurface surface(model.mesh, loop_rules(), std::make_shared<BoundsCache>());
  SurfaceBvhOptions tight;
  tight.tight = true;
  tight.threads = 1;
  Group group(model.name + ", a tight tree", "face", options);
  group.add("surface and kinds known", static_cast<double>(surface.face_count()),
            [&] { return static_cast<double>(SurfaceBvh(surface, tight).bytes()); });
  const Times times = group.run().front();
  table.at_most("tight model", "us a face", 2.5, model.name, 1e6 * times.median / times.items);
}

// Area, volume, centroid and inertia within a percent.
void add_measures(const Model& model, const Options& options, BarTable& table) {
  const Surface surface(model.mesh, {.scheme = Scheme::loop});
  const Run alone{.threads = 1};
  Group group(model.name + ", measures to 1 %", "face", options);
  group.add("kinds known", static_cast<double>(model.mesh.face_count()),
            [&] { return measure(surface, {.relative = 0.01}, alone).area.upper; });
  const Times times = group.run().front();
  table.at_most("measures to 1 %", "us a face", 40, model.name, 1e6 * times.median / times.items);
}

}  // namespace

void model_bars(const std::vector<ModelPair>& pairs, const Options& options, BarTable& table) {
  // Large enough to be no mesh of some dozen faces refined.
  for (const ModelPair& pair : pairs) {
    const auto [fewest, most] = std::minmax({pair.a.mesh.face_count(), pair.b.mesh.face_count()});
    if (fewest >= 600 && most <= 4'000) add_memory(pair, options, table);
  }
  for (const Model* model : models_of(pairs)) {
    add_tight(*model, options, table);
    if (model->mesh.face_count() <= 2'000) add_measures(*model, options, table);
  }
}

}  // namespace snug::bench
