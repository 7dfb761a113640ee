#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include <snug/evaluate.h>

#include "bars.h"
#include "peers.h"

namespace snug::bench {
namespace {

// The larger model of a pair, and the same limit surface with many control faces.
struct Sizes {
  std::string name;
  const Model *partner, *small;
  Model large;
};

// Nothing if no level has about `faces` faces.
std::optional<Sizes> sizes_of(const ModelPair& pair, std::size_t faces) {
  const bool a_larger = pair.a.mesh.face_count() >= pair.b.mesh.face_count();
  const Model &small = a_larger ? pair.a : pair.b, &partner = a_larger ? pair.b : pair.a;
  for (unsigned level = 1; small.mesh.face_count() << (2 * level) <= faces * 11 / 10; ++level) {
    if (small.mesh.face_count() << (2 * level) < faces * 9 / 10) continue;
    ControlMesh mesh = subdivided(small.mesh, level);
    const std::string name = small.name + " of " + std::to_string(mesh.face_count()) + " faces";
    return Sizes{name + " and " + partner.name, &partner, &small, {name, std::move(mesh)}};
  }
  return {};
}

std::vector<PosePair> disjoint_placements(const Sizes& sizes, std::size_t count) {
  std::vector<PosePair> at;
  for (const Placed& placed : sorted_placements(*sizes.small, *sizes.partner, 3, 2 * count, 3)) {
    if (placed.nearness != Nearness::colliding) at.push_back(placed.at);
  }
  at.resize(std::min(at.size(), count));
  return at;
}

void add_growth(const Sizes& sizes, const Options& options, BarTable& table) {
  SurfaceBvhOptions tight;
  tight.tight = true;
  const auto library = std::make_shared<BoundsCache>();
  SnugPair small(*sizes.small, *sizes.partner, library, tight),
      large(sizes.large, *sizes.partner, library, tight);
  const std::vector<PosePair> at = disjoint_placements(sizes, options.size<std::size_t>(200, 20));
  const auto items = static_cast<double>(at.size());
  Group group("distance 0.1 %, " + sizes.name, "query", options);
  for (SnugPair* pair : {&small, &large}) {
    group.add(pair == &small ? "as it is" : "with many faces", items, [&at, pair] {
      double sum = 0;
      for (const PosePair& placed : at)
        sum += pair->queries.distance(placed, distance_precision).distance.upper;
      return sum;
    });
  }
  const std::vector<Times> times = group.run();
  std::printf("# mean difference of the upper ends: %.5f\n", (times[1].checksum - times[0].checksum) / items);
  table.at_most("distance 0.1 %, growth with faces", "363k faces over 1.4k", 1.5, sizes.name,
                ratio(times[1], times[0]));
}

void add_first_answer(const Sizes& sizes, const Options& options, BarTable& table) {
  const Model &a = sizes.large, &b = *sizes.partner;
  const std::vector<PosePair> near = contact_placements(*sizes.small, b, 3, 0.01, 3, 7);
  const auto library = std::make_shared<BoundsCache>();
  Group group("first answer 1 %, " + sizes.name, "answer", options);
  group.add("snug, kinds known", static_cast<double>(near.size()), [&] {
    double sum = 0;
    for (const PosePair& at : near) {
      SnugPair pair(a, b, library);
      sum += static_cast<double>(pair.queries.collide(at, collide_tolerance, 0, WitnessKind::none).verdict);
    }
    return sum;
  });
#ifdef SNUG_BENCH_FCL
  const int level_a = osd_uniform_level(a.mesh, collide_tolerance),
            level_b = osd_uniform_level(b.mesh, collide_tolerance);
  std::printf("# FCL: levels %d and %d\n", level_a, level_b);
  for (const FclBuild build : fcl_builds()) {
    for (const FclBoxes boxes : {FclBoxes::obb, FclBoxes::obbrss}) {
      group.add(std::string(name_of(build)) + (boxes == FclBoxes::obb ? ", OBB" : ", OBBRSS"), 1,
                [&, build, boxes] {
                  const FclPair pair(osd_uniform(a.mesh, level_a), osd_uniform(b.mesh, level_b), boxes,
                                     build);
                  return static_cast<double>(pair.collide(near.front()));
                });
    }
  }
  const std::vector<Times> times = group.run();
  for (std::size_t i = 0; i < fcl_builds().size(); ++i) {
    table.at_least("first answer 1 %, 363k faces", std::string(name_of(fcl_builds()[i])) + " over snug", 15,
                   sizes.name,
                   std::min(ratio(times[1 + 2 * i], times[0]), ratio(times[2 + 2 * i], times[0])));
  }
#else
  table.missing("first answer 1 %, 363k faces", "FCL is not installed");
  group.run();
#endif
}

}  // namespace

void size_bars(const std::vector<ModelPair>& pairs, const Options& options, BarTable& table) {
  // Seconds a pair: the first and the last that have such a size.
  std::vector<Sizes> chosen;
  for (const ModelPair& pair : pairs) {
    std::optional<Sizes> sizes = sizes_of(pair, options.size<std::size_t>(363'000, 22'700));
    if (!sizes) continue;
    if (chosen.size() == 2) chosen.pop_back();
    chosen.push_back(std::move(*sizes));
  }
  for (const Sizes& sizes : chosen) {
    add_growth(sizes, options, table);
    add_first_answer(sizes, options, table);
  }
  if (chosen.empty()) table.missing("distance and first answer, 363k faces", "no model has such a size");
}

}  // namespace snug::bench
