// bench_bars: what queries are to reach beside their peers, pair by pair. Files: triangle meshes, each two of
// them a pair.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <experiments/quantile.h>

#include "peers.h"

namespace {

using namespace snug;
using namespace snug::bench;

constexpr double tolerance = 0.01;

// A ratio of times an item.
double ratio(const Times& slow, const Times& fast) {
  return (slow.median / slow.items) / (fast.median / fast.items);
}

// One pair of models, its placements and its contestants.
struct Pair {
  std::string name;
  std::unique_ptr<SnugPair> snug;
#ifdef SNUG_BENCH_FCL
  std::vector<FclPair> peers;
#endif
  std::vector<Placed> rooms[2];

  Pair(const Model& a, const Model& b, const Options& options) : name(a.name + " and " + b.name) {
    SurfaceBvhOptions tight;
    tight.tight = true;
    snug = std::make_unique<SnugPair>(a, b, std::make_shared<BoundsCache>(), tight);
#ifdef SNUG_BENCH_FCL
    for (const FclBoxes boxes : {FclBoxes::obb, FclBoxes::obbrss}) peers.emplace_back(a, b, tolerance, boxes);
#endif
    for (std::size_t room = 0; room < 2; ++room) {
      rooms[room] = sorted_placements(a, b, room == 0 ? 3 : 6, options.size<std::size_t>(20'000, 500), 3);
    }
  }
};

// FCL's better tree over snug; nothing without placements of the sort.
void collide(Pair& pair, const std::string& title, const std::vector<PosePair>& at, const Options& options,
             std::vector<double>& ratios) {
  if (at.empty()) return;
  const double items = static_cast<double>(at.size());
  Group group(pair.name + ", " + title, "query", options);
  group.add("snug", items, [&] {
    double sum = 0;
    for (const PosePair& placed : at) {
      sum += static_cast<double>(pair.snug->queries.collide(placed, tolerance).verdict);
    }
    return sum;
  });
#ifdef SNUG_BENCH_FCL
  for (std::size_t i = 0; i < 2; ++i) {
    group.add(i == 0 ? "FCL OBB" : "FCL OBBRSS", items, [&, i] {
      double sum = 0;
      for (const PosePair& placed : at) sum += pair.peers[i].collide(placed);
      return sum;
    });
  }
#endif
  const std::vector<Times> times = group.run();
  if (times.size() == 3) ratios.push_back(std::min(ratio(times[1], times[0]), ratio(times[2], times[0])));
  Work work;
  for (const PosePair& placed : at) work.add(pair.snug->queries.collide(placed, tolerance).stats);
  work.print("snug");
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, any_files, " MODEL MODEL [MODEL MODEL]...");
  const std::vector<Model> models = read_models(options.files);
  std::vector<double> room_3, room_6, far, near, grazing, colliding;
  for (std::size_t i = 0; i + 1 < models.size(); i += 2) {
    Pair pair(models[i], models[i + 1], options);
    collide(pair, "room 3", of(pair.rooms[0]), options, room_3);
    collide(pair, "room 3, far", of(pair.rooms[0], Nearness::far), options, far);
    collide(pair, "room 3, near", of(pair.rooms[0], Nearness::near), options, near);
    collide(pair, "room 3, grazing", of(pair.rooms[0], Nearness::grazing), options, grazing);
    collide(pair, "room 3, colliding", of(pair.rooms[0], Nearness::colliding), options, colliding);
    collide(pair, "room 6", of(pair.rooms[1]), options, room_6);
  }
  const auto print = [](const char* what, std::vector<double>& ratios, double bar) {
    if (ratios.empty()) return;
    const double least = *std::min_element(ratios.begin(), ratios.end());
    at_least(std::string("FCL over snug, ") + what + ", median pair", quantile(ratios, 0.5), bar);
    at_least(std::string("FCL over snug, ") + what + ", worst pair", least, 0.8 * bar);
  };
  print("room 3", room_3, 8);
  print("room 6", room_6, 5.5);
  print("far", far, 3);
  print("near", near, 5);
  print("grazing", grazing, 2);
  print("colliding", colliding, 5);
  return 0;
}
