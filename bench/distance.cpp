// bench_distance: distances of limit surfaces beside FCL's distances of uniform meshes. Files: the triangle
// models of examples/models.

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "peers.h"

namespace {

using namespace snug;
using namespace snug::bench;

constexpr double mesh_tolerance = 0.01, precision = 0.001;

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 7, " SEVEN-MODELS");
  const std::vector<Model> models = read_models(options.files);
  const auto library = std::make_shared<BoundsCache>();
  std::vector<std::unique_ptr<SnugPair>> snug, tight;
  std::vector<std::vector<Placed>> placements;
#ifdef SNUG_BENCH_FCL
  std::vector<FclPair> peers;
#endif
  for (const auto& [a, b] : model_pairs) {
    const Model &model_a = named(models, a), &model_b = named(models, b);
    snug.push_back(std::make_unique<SnugPair>(model_a, model_b, library));
    SurfaceBvhOptions model_options;
    model_options.tight = true;
    tight.push_back(std::make_unique<SnugPair>(model_a, model_b, library, model_options));
    placements.push_back(sorted_placements(model_a, model_b, 3, options.size<std::size_t>(600, 30), 3));
#ifdef SNUG_BENCH_FCL
    peers.emplace_back(model_a, model_b, mesh_tolerance, FclBoxes::obbrss);
#endif
  }
  // All disjoint placements, then sort by sort.
  for (std::size_t choice = 0; choice < all_nearness.size(); ++choice) {
    const bool all = choice == 0;
    std::vector<std::vector<PosePair>> at(placements.size());
    double items = 0;
    for (std::size_t p = 0; p < placements.size(); ++p) {
      for (const Placed& placed : placements[p]) {
        const bool wanted =
            all ? placed.nearness != Nearness::colliding : placed.nearness == all_nearness[choice];
        if (wanted) at[p].push_back(placed.at);
      }
      items += static_cast<double>(at[p].size());
    }
    if (items == 0) continue;
    Group group(
        std::string("distance to 0.1 %, room 3, ") + (all ? "all disjoint" : name_of(all_nearness[choice])),
        "query", options);
    const auto ask = [&at](const std::vector<std::unique_ptr<SnugPair>>& pairs) {
      double sum = 0;
      for (std::size_t p = 0; p < at.size(); ++p) {
        for (const PosePair& placed : at[p])
          sum += pairs[p]->queries.distance(placed, precision).distance.upper;
      }
      return sum;
    };
    group.add("snug", items, [&] { return ask(snug); });
    group.add("snug, tight trees", items, [&] { return ask(tight); });
#ifdef SNUG_BENCH_FCL
    group.add("FCL OBBRSS, uniform Loop of 1 %", items, [&] {
      double sum = 0;
      for (std::size_t p = 0; p < at.size(); ++p) {
        for (const PosePair& placed : at[p]) sum += peers[p].distance(placed);
      }
      return sum;
    });
#endif
    const std::vector<Times> times = group.run();
    for (const auto* pairs : {&snug, &tight}) {
      Work work;
      for (std::size_t p = 0; p < at.size(); ++p) {
        for (const PosePair& placed : at[p]) {
          work.add((*pairs)[p]->queries.distance(placed, precision).stats);
        }
      }
      work.print(pairs == &snug ? "snug" : "snug, tight trees");
    }
    for (std::size_t subject = 0; subject < 2 && all && times.size() == 3; ++subject) {
      at_least("distance to 0.1 %, FCL over " + times[subject].name, times[2].median / times[subject].median,
               5);
    }
  }
#ifdef SNUG_BENCH_FCL
  // How far the mesh's distance is from the surface's.
  double most = 0;
  std::size_t outside = 0, count = 0;
  for (std::size_t p = 0; p < placements.size(); ++p) {
    for (const Placed& placed : placements[p]) {
      if (placed.nearness == Nearness::colliding) continue;
      const Distance surface = snug[p]->queries.distance(placed.at, precision);
      const double mesh = peers[p].distance(placed.at);
      const double off = std::max(surface.distance.lower - mesh, mesh - surface.distance.upper);
      ++count;
      outside += off > 0;
      most = std::max(most, off);
    }
  }
  std::printf("# distances of the uniform mesh outside of snug's interval: %zu of %zu, by %.4f at most\n",
              outside, count, most);
#endif
  return 0;
}
