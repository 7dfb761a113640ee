#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>

#include "bars.h"
#include "peers.h"

namespace snug::bench {
namespace {

// A question to collide(), and the bar for FCL's time over its own.
struct Question {
  const char* name;
  std::size_t room;
  std::optional<Nearness> nearness;
  WitnessKind witness;
  double bar;
};
constexpr std::array questions{
    Question{"boolean 1 %, room 3, verdict", 3, {}, WitnessKind::none, 9},
    Question{"boolean 1 %, room 3, default options", 3, {}, WitnessKind::exact, 2},
    Question{"boolean 1 %, room 6, verdict", 6, {}, WitnessKind::none, 5.5},
    Question{"boolean 1 %, room 6, default options", 6, {}, WitnessKind::exact, 1.5},
    Question{"boolean 1 %, room 3, far, verdict", 3, Nearness::far, WitnessKind::none, 3.5},
    Question{"boolean 1 %, room 3, near, verdict", 3, Nearness::near, WitnessKind::none, 8},
    Question{"boolean 1 %, room 3, grazing, verdict", 3, Nearness::grazing, WitnessKind::none, 10},
};

#ifdef SNUG_BENCH_FCL
struct Peer {
  FclBuild build;
  FclBoxes boxes;
  FclPair pair;
  [[nodiscard]] std::string name() const {
    return std::string(name_of(build)) + (boxes == FclBoxes::obb ? ", OBB" : ", OBBRSS");
  }
};
#endif

// One pair of models with its contestants.
struct Contest {
  std::string name;
  std::unique_ptr<SnugPair> snug;
#ifdef SNUG_BENCH_FCL
  std::vector<Peer> peers;
#endif
  std::vector<Placed> room_3, room_6;

  Contest(const ModelPair& models, const Options& options) : name(models.name()) {
    SurfaceBvhOptions tight;
    tight.tight = true;
    snug = std::make_unique<SnugPair>(models.a, models.b, std::make_shared<BoundsCache>(), tight);
#ifdef SNUG_BENCH_FCL
    const TriangleMesh a = uniform_mesh(models.a, collide_tolerance),
                       b = uniform_mesh(models.b, collide_tolerance);
    for (const FclBuild build : fcl_builds()) {
      for (const FclBoxes boxes : {FclBoxes::obb, FclBoxes::obbrss}) {
        peers.push_back({build, boxes, FclPair(a, b, boxes, build)});
      }
    }
#endif
    const auto count = options.size<std::size_t>(20'000, 2'000);
    room_3 = sorted_placements(models.a, models.b, 3, count, 3);
    room_6 = sorted_placements(models.a, models.b, 6, count, 3);
  }

  // snug, then all peers.
  std::vector<Times> collide(const char* title, const std::vector<PosePair>& at, WitnessKind witness,
                             const Options& options) {
    const auto items = static_cast<double>(at.size());
    Group group(name + ", " + title, "query", options);
    group.add("snug", items, [&] {
      double sum = 0;
      for (const PosePair& placed : at) {
        sum += static_cast<double>(snug->queries.collide(placed, collide_tolerance, 0, witness).verdict);
      }
      return sum;
    });
#ifdef SNUG_BENCH_FCL
    for (const Peer& peer : peers) {
      group.add(peer.name(), items, [&] {
        double sum = 0;
        for (const PosePair& placed : at) sum += peer.pair.collide(placed);
        return sum;
      });
    }
#endif
    return group.run();
  }
};

#ifdef SNUG_BENCH_FCL
// The better tree of each build over snug, with the build's name.
template <class Use>
void for_each_build(const std::vector<Times>& times, const Use& use) {
  for (std::size_t i = 0; i < fcl_builds().size(); ++i) {
    use(name_of(fcl_builds()[i]),
        std::min(ratio(times[1 + 2 * i], times[0]), ratio(times[2 + 2 * i], times[0])));
  }
}

// Meshes are up to the collide_tolerance away from the surfaces, so that both may be right where they differ.
void print_agreement(Contest& contest) {
  std::size_t alike = 0, mesh_alone = 0, snug_alone = 0;
  for (const Placed& placed : contest.room_3) {
    const bool hit =
        contest.snug->queries.collide(placed.at, collide_tolerance).verdict != Verdict::separated;
    const bool mesh_hit = contest.peers.front().pair.collide(placed.at);
    ++(hit == mesh_hit ? alike : mesh_hit ? mesh_alone : snug_alone);
  }
  std::printf("# answers in room 3: %zu alike; within 1 %% where meshes miss: %zu; only meshes meet: %zu\n",
              alike, snug_alone, mesh_alone);
}
#endif

void add_booleans(Contest& contest, const Options& options, BarTable& table) {
  for (const Question& question : questions) {
    const std::vector<Placed>& room = question.room == 3 ? contest.room_3 : contest.room_6;
    const std::vector<PosePair> at = question.nearness ? of(room, *question.nearness) : of(room);
    if (at.empty()) continue;
    const std::vector<Times> times = contest.collide(question.name, at, question.witness, options);
#ifdef SNUG_BENCH_FCL
    for_each_build(times, [&](const char* build, double value) {
      table.at_least(question.name, std::string(build) + " over snug", question.bar, contest.name, value);
    });
#else
    static_cast<void>(table);
#endif
  }
}

// With workspaces that know nothing, beside the pass after it.
void add_first_pass(Contest& contest, const Options& options, BarTable& table) {
  const std::vector<PosePair> at = of(contest.room_3);
  const auto items = static_cast<double>(at.size());
  const auto ask_all = [&] {
    double sum = 0;
    for (const PosePair& placed : at) {
      sum += static_cast<double>(contest.snug->queries.collide(placed, collide_tolerance).verdict);
    }
    return sum;
  };
  Group group(contest.name + ", boolean 1 %, room 3, first pass", "query", options);
  group.add("first pass", items, [&] { return contest.snug->queries.forget(), ask_all(); });
  group.add("next pass", items, ask_all);
  const std::vector<Times> times = group.run();
  table.at_most("boolean 1 %, room 3", "first pass over the next", 1.3, contest.name,
                ratio(times[0], times[1]));
}

void add_distances(Contest& contest, const Options& options, BarTable& table) {
  std::vector<PosePair> at;
  for (const Placed& placed : contest.room_3) {
    if (placed.nearness != Nearness::colliding) at.push_back(placed.at);
  }
  at.resize(std::min(at.size(), options.size<std::size_t>(150, 15)));
  const auto items = static_cast<double>(at.size());
  Group group(contest.name + ", distance 0.1 %, disjoint in room 3", "query", options);
  group.add("snug", items, [&] {
    double sum = 0;
    for (const PosePair& placed : at)
      sum += contest.snug->queries.distance(placed, distance_precision).distance.upper;
    return sum;
  });
#ifdef SNUG_BENCH_FCL
  for (const Peer& peer : contest.peers) {
    if (peer.boxes != FclBoxes::obbrss) continue;
    group.add(peer.name(), items, [&] {
      double sum = 0;
      for (const PosePair& placed : at) sum += peer.pair.distance(placed);
      return sum;
    });
  }
#endif
  const std::vector<Times> times = group.run();
  for (std::size_t i = 1; i < times.size(); ++i) {
    table.at_least("distance 0.1 %, FCL on the mesh of 1 %", times[i].name + " over snug", 4.5, contest.name,
                   ratio(times[i], times[0]));
  }
  if (times.size() > 1) {
    std::printf("# distances, mean of what snug's upper ends are above FCL's: %.5f\n",
                (times[0].checksum - times[1].checksum) / items);
  }
}

}  // namespace

void query_bars(const std::vector<ModelPair>& pairs, const Options& options, BarTable& table) {
  for (const ModelPair& models : pairs) {
    Contest contest(models, options);
    add_booleans(contest, options, table);
    add_first_pass(contest, options, table);
    add_distances(contest, options, table);
#ifdef SNUG_BENCH_FCL
    print_agreement(contest);
#endif
  }
#ifdef SNUG_BENCH_FCL
  if (fcl_builds().size() == 1) {
    table.missing("the same beside FCL with snug's flags", "give cmake -DSNUG_FCL_SOURCE=...");
  }
#else
  table.missing("booleans and distances", "FCL is not installed");
#endif
}

}  // namespace snug::bench
