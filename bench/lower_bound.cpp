// bench_lower_bound: how far collide's lower bound stays behind the distance of surfaces that are apart, and
// what a query costs.
// Files: the triangle models of examples/models.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <experiments/quantile.h>

#include "peers.h"
#include "placements.h"

namespace {

using namespace snug;
using namespace snug::bench;

constexpr double one_percent = 0.01;

struct Pairs {
  std::vector<std::unique_ptr<SnugPair>> of_models;
  explicit Pairs(const std::vector<Model>& models) {
    const auto library = std::make_shared<BoundsCache>();
    for (const auto& [a, b] : model_pairs) {
      of_models.push_back(std::make_unique<SnugPair>(named(models, a), named(models, b), library));
    }
  }
};

using PlacementsOfPairs = std::vector<std::vector<PosePair>>;

// Distance over lower bound, wherever collide says separated.
std::vector<double> ratios(Pairs& pairs, const PlacementsOfPairs& at, double tolerance, std::size_t most) {
  std::vector<double> result;
  for (std::size_t p = 0; p < at.size(); ++p) {
    for (std::size_t i = 0; i < std::min(at[p].size(), most); ++i) {
      Queries& queries = pairs.of_models[p]->queries;
      const Collision answer = queries.collide(at[p][i], tolerance);
      if (answer.verdict != Verdict::separated) continue;
      const double distance = queries.distance(at[p][i], 1e-3).distance.lower;
      result.push_back(std::max(1.0, distance / std::max(answer.distance.lower, 1e-300)));
    }
  }
  return result;
}

void measure(Pairs& pairs, const std::string& title, const PlacementsOfPairs& at, const Options& options) {
  double items = 0;
  for (const auto& list : at) items += static_cast<double>(list.size());
  if (items == 0) return;
  Group group(title, "query", options);
  group.add("collide", items, [&] {
    double sum = 0;
    for (std::size_t p = 0; p < at.size(); ++p) {
      for (const PosePair& placed : at[p]) {
        sum += static_cast<double>(pairs.of_models[p]->queries.collide(placed, one_percent).verdict);
      }
    }
    return sum;
  });
  static_cast<void>(group.run());
  const std::vector<double> found = ratios(pairs, at, one_percent, options.size<std::size_t>(1500, 40));
  if (found.empty()) return;
  std::printf("# %s, distance over lower bound, %zu separated: median %.3g, 95 %% at most %.3g, worst %.3g\n",
              title.c_str(), found.size(), quantile(found, 0.5), quantile(found, 0.95), quantile(found, 1));
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 7, " SEVEN-MODELS");
  const std::vector<Model> models = read_models(options.files);
  Pairs pairs(models);
  for (const double side : {3.0, 6.0}) {
    std::vector<std::vector<Placed>> sorted;
    PlacementsOfPairs all;
    for (const auto& [a, b] : model_pairs) {
      sorted.push_back(sorted_placements(named(models, a), named(models, b), side,
                                         options.size<std::size_t>(10'000, 500), 3));
      all.push_back(of(sorted.back()));
    }
    const std::string room = "1 %, room " + std::to_string(static_cast<int>(side));
    measure(pairs, room, all, options);
    for (const Nearness nearness : all_nearness) {
      PlacementsOfPairs some;
      for (const auto& list : sorted) some.push_back(of(list, nearness));
      measure(pairs, room + ", " + name_of(nearness), some, options);
    }
  }
  return 0;
}
