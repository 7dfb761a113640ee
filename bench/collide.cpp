// bench_collide: triangles, first answers, memory and boolean queries, beside the dissertation's method and
// beside OpenSubdiv with FCL. Files: the triangle models of examples/models.

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <experiments/printed_hierarchy.h>
#include <experiments/quantile.h>

#include "peers.h"
#ifdef SNUG_BENCH_MESHOPT
#include "peer_meshopt.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

using Library = std::shared_ptr<BoundsCache>;

constexpr double one_percent = 0.01;

// --- 1. how many triangles ---

void bench_leaves(const std::vector<Model>& models) {
  constexpr double tolerance = 0.005;
  std::printf("leaves at 0.5 %%\n  %-8s %9s %9s %9s %12s %9s  %s\n", "model", "faces", "rows", "tables",
              "dissertation", "uniform", "rows/dissertation, rows/tables, rows/uniform");
  std::vector<double> over_printed, over_uniform;
  for (const Model& model : models) {
    const LimitSurface surface(model.mesh, loop_rules(), std::make_shared<BoundsCache>());
    const auto count = [&](const LeafOptions& options) {
      return static_cast<double>(leaves(surface, options).size());
    };
    const double rows = count({tolerance, BoundMethod::rows}),
                 tables = count({tolerance, BoundMethod::table}),
                 printed = count({tolerance, BoundMethod::table, true});
    over_printed.push_back(rows / printed);
    std::printf("  %-8s %9zu %9.0f %9.0f %12.0f", model.name.c_str(), model.mesh.face_count(), rows, tables,
                printed);
#ifdef SNUG_BENCH_FCL
    const double uniform = static_cast<double>(model.mesh.face_count()) *
                           static_cast<double>(1u << (2 * osd_uniform_level(model.mesh, tolerance)));
    over_uniform.push_back(rows / uniform);
    std::printf(" %9.0f  %.3f %.3f %.3f\n", uniform, rows / printed, rows / tables, rows / uniform);
#else
    std::printf(" %9s  %.3f %.3f\n", "-", rows / printed, rows / tables);
#endif
  }
  std::printf("# leaves at 0.5 %%, over the dissertation's, worst model: %.3f\n", quantile(over_printed, 1));
  at_most("leaves at 0.5 %, over the dissertation's, median model", quantile(over_printed, 0.5), 0.6);
  if (over_uniform.empty()) return;
  at_most("leaves at 0.5 %, over uniform Loop, median model", quantile(over_uniform, 0.5), 0.25);
  at_most("leaves at 0.5 %, over uniform Loop, best model", quantile(over_uniform, 0), 0.1);
}

// --- 2. from two control meshes in memory to the first answer ---

double first_answer(const Model& a, const Model& b, const PosePair& at, double tolerance,
                    const Library& library) {
  SnugPair pair(a, b, library);
  return static_cast<double>(pair.queries.collide(at, tolerance).verdict);
}

void bench_first_answer(const Model& a, const Model& b, const Options& options) {
  const std::vector<PosePair> near = contact_placements(a, b, 3, 0.01, 5, 7);
  const Library library = std::make_shared<BoundsCache>();
  for (const double percent : {2.0, 1.0, 0.5, 0.1}) {
    if (options.quick && percent < 1) continue;
    const double tolerance = percent / 100;
    char text[80];
    std::snprintf(text, sizeof text, "first answer, %s and %s, %g %%", a.name.c_str(), b.name.c_str(),
                  percent);
    const std::string title = text;
    Group group(title, "answer", options);
    if (percent < 0.5) group.limit_rounds(5);
    const auto answers = [&](const std::function<Library()>& take) {
      double sum = 0;
      for (const PosePair& at : near) sum += first_answer(a, b, at, tolerance, take());
      return sum;
    };
    const double items = static_cast<double>(near.size());
    group.add("snug, kinds known", items, [&] { return answers([&] { return library; }); });
    group.add("snug, nothing known", items,
              [&] { return answers([] { return std::make_shared<BoundsCache>(); }); });
#ifdef SNUG_BENCH_FCL
    const auto add_peer = [&](const char* name, int level_a, int level_b, bool snapped) {
      std::printf("# %s: levels %d and %d, %zu and %zu triangles\n", name, level_a, level_b,
                  a.mesh.face_count() << (2 * level_a), b.mesh.face_count() << (2 * level_b));
      const std::size_t placements = level_a > 3 ? 1 : near.size();  // seconds each, wherever models are
      group.add(name, static_cast<double>(placements),
                [&a, &b, &near, placements, level_a, level_b, snapped] {
                  double sum = 0;
                  for (std::size_t i = 0; i < placements; ++i) {
                    const FclPair pair(osd_uniform(a.mesh, level_a, snapped),
                                       osd_uniform(b.mesh, level_b, snapped), FclBoxes::obbrss);
                    sum += pair.collide(near[i]);
                  }
                  return sum;
                });
    };
    add_peer("uniform Loop, FCL OBBRSS", osd_uniform_level(a.mesh, tolerance),
             osd_uniform_level(b.mesh, tolerance), false);
    add_peer("snapped to the limit, FCL OBBRSS", osd_snapped_level(a.mesh, tolerance),
             osd_snapped_level(b.mesh, tolerance), true);
#endif
    const std::vector<Times> times = group.run();
    const double limit = percent == 1 ? 15 : percent == 0.1 ? 60 : 0;
    for (std::size_t peer = 2; peer < times.size() && limit > 0; ++peer) {
      at_least(title + ", " + times[peer].name + " over snug", ratio(times[peer], times[0]), limit);
    }
  }
}

// --- 3. memory ---

constexpr double mib = 0x1p20;

double run_queries(SnugPair& pair, const std::vector<PosePair>& at, double tolerance) {
  double sum = 0;
  for (const PosePair& placed : at) {
    sum += static_cast<double>(pair.queries.collide(placed, tolerance).verdict);
  }
  return sum;
}

void bench_memory(const Model& a, const Model& b, const Options& options) {
  std::mt19937_64 random(11);
  std::vector<PosePair> at(options.size<std::size_t>(5000, 200));
  for (PosePair& placed : at) placed = place_in_room(3, random);
  const PosePair first = contact_placements(a, b, 3, 0.01, 1, 7)[0];

  const std::size_t before = heap_bytes();
  const Library library = std::make_shared<BoundsCache>();
  {
    SnugPair pair(a, b, library);
    static_cast<void>(pair.queries.collide(first, one_percent));
    static_cast<void>(run_queries(pair, at, one_percent));
  }
  const std::size_t known = heap_bytes();
  double surfaces = 0;
  {
    const LimitSurface alone_a(a.mesh, loop_rules(), library), alone_b(b.mesh, loop_rules(), library);
    surfaces = static_cast<double>(heap_bytes() - known) / mib;
  }
  const auto pair = std::make_unique<SnugPair>(a, b, library);
  static_cast<void>(pair->queries.collide(first, one_percent));
  const double after_first = static_cast<double>(heap_bytes() - known) / mib;
  static_cast<void>(run_queries(*pair, at, one_percent));
  const double after_all = static_cast<double>(heap_bytes() - known) / mib;
  std::printf("memory, %s and %s, 1 %%, as malloc counts it\n", a.name.c_str(), b.name.c_str());
  std::printf("  the library of kinds, shared by all surfaces   %8.3f MiB\n",
              static_cast<double>(known - before) / mib);
  std::printf("  surfaces                                       %8.3f MiB\n", surfaces);
  std::printf("  surfaces, models and scratch, first answer     %8.3f MiB\n", after_first);
  std::printf("  surfaces, models and scratch, %5zu queries    %8.3f MiB\n", at.size(), after_all);
  std::printf("  of that models and scratch, as they count      %8.3f MiB\n",
              static_cast<double>(pair->queries.bytes()) / mib);
  print_peak("snug, first answer", 1, "pair",
             peak_mib([&] { return first_answer(a, b, first, one_percent, library); }));
  print_peak("snug, all queries", 1, "pair", peak_mib([&] {
               SnugPair fresh(a, b, library);
               return run_queries(fresh, at, one_percent);
             }));
#ifdef SNUG_BENCH_FCL
  const int level_a = osd_uniform_level(a.mesh, one_percent),
            level_b = osd_uniform_level(b.mesh, one_percent);
  const auto peer = [&] {
    const FclPair meshes(osd_uniform(a.mesh, level_a), osd_uniform(b.mesh, level_b), FclBoxes::obbrss);
    static_cast<void>(meshes.collide(first));
    return static_cast<double>(meshes.bytes());
  };
  std::printf("  FCL OBBRSS, nodes and meshes                   %8.3f MiB\n", peer() / mib);
  print_peak("uniform Loop, FCL OBBRSS", 1, "pair", peak_mib(peer));
#endif
  at_most("memory at 1 % after the queries, MiB", after_all, 0.5);
}

// --- 4. boolean queries ---

// The three pairs of table 5.3, and what is asked of each.
struct Contest {
  std::vector<std::unique_ptr<SnugPair>> snug, tight;
#ifdef SNUG_BENCH_FCL
  std::vector<FclPair> obb, obbrss;
#endif
  explicit Contest(const std::vector<Model>& models) {
    const auto library = std::make_shared<BoundsCache>();
    for (const auto& [a, b] : model_pairs) {
      snug.push_back(std::make_unique<SnugPair>(named(models, a), named(models, b), library));
      SurfaceBvhOptions model_options;
      model_options.tight = true;
      tight.push_back(std::make_unique<SnugPair>(named(models, a), named(models, b), library, model_options));
#ifdef SNUG_BENCH_FCL
      obb.emplace_back(named(models, a), named(models, b), one_percent, FclBoxes::obb);
      obbrss.emplace_back(named(models, a), named(models, b), one_percent, FclBoxes::obbrss);
#endif
    }
  }
};

using PlacementsOfPairs = std::vector<std::vector<PosePair>>;

// Times of snug as it is and with tight trees, of FCL's OBB and FCL's OBBRSS.
std::vector<Times> run_contest(Contest& contest, const std::string& title, const PlacementsOfPairs& at,
                               const Options& options) {
  double items = 0;
  for (const auto& list : at) items += static_cast<double>(list.size());
  if (items == 0) return {};
  Group group(title, "query", options);
  const auto ask = [&at](const std::vector<std::unique_ptr<SnugPair>>& pairs) {
    double sum = 0;
    for (std::size_t p = 0; p < at.size(); ++p) sum += run_queries(*pairs[p], at[p], one_percent);
    return sum;
  };
  group.add("snug", items, [&] { return ask(contest.snug); });
  group.add("snug, tight trees", items, [&] { return ask(contest.tight); });
#ifdef SNUG_BENCH_FCL
  const auto peer = [&at](const std::vector<FclPair>& pairs) {
    double sum = 0;
    for (std::size_t p = 0; p < at.size(); ++p) {
      for (const PosePair& placed : at[p]) sum += pairs[p].collide(placed);
    }
    return sum;
  };
  group.add("FCL OBB, uniform Loop", items, [&] { return peer(contest.obb); });
  group.add("FCL OBBRSS, uniform Loop", items, [&] { return peer(contest.obbrss); });
#endif
  const std::vector<Times> times = group.run();
  for (const auto* pairs : {&contest.snug, &contest.tight}) {
    Work work;
    for (std::size_t p = 0; p < at.size(); ++p) {
      for (const PosePair& placed : at[p]) {
        work.add((*pairs)[p]->queries.collide(placed, one_percent).stats);
      }
    }
    work.print(pairs == &contest.snug ? "snug" : "snug, tight trees");
  }
  return times;
}

void bench_queries(const std::vector<Model>& models, const Options& options) {
  Contest contest(models);
  for (const double side : {3.0, 6.0}) {
    const std::string room = "room " + std::to_string(static_cast<int>(side));
    std::vector<std::vector<Placed>> sorted;
    PlacementsOfPairs all;
    for (const auto& [a, b] : model_pairs) {
      sorted.push_back(sorted_placements(named(models, a), named(models, b), side,
                                         options.size<std::size_t>(20'000, 500), 3));
      all.push_back(of(sorted.back()));
    }
    for (const Nearness nearness : all_nearness) {
      std::printf("# %s, %-9s:", room.c_str(), name_of(nearness));
      for (const auto& list : sorted) {
        std::printf(" %5.2f %%",
                    100 * static_cast<double>(of(list, nearness).size()) / static_cast<double>(list.size()));
      }
      std::printf("\n");
    }
    const std::vector<Times> times = run_contest(contest, "boolean query, 1 %, " + room, all, options);
    for (std::size_t subject = 0; subject < 2 && times.size() == 4; ++subject) {
      at_least(room + ", mean of all queries, the better tree of FCL over " + times[subject].name,
               std::min(ratio(times[2], times[subject]), ratio(times[3], times[subject])), side == 3 ? 5 : 3);
    }
    for (const Nearness nearness : all_nearness) {
      PlacementsOfPairs some;
      for (const auto& list : sorted) some.push_back(of(list, nearness));
      static_cast<void>(
          run_contest(contest, "boolean query, 1 %, " + room + ", " + name_of(nearness), some, options));
    }
  }
}

// --- 6. wrong answers of meshes ---

#ifdef SNUG_BENCH_FCL
struct WrongAnswers {
  const char* name;
  std::size_t triangles = 0, missed = 0, invented = 0;
};

// Meshes of one pair of models, in the order of the counts.
std::vector<FclPair> meshes_of(const Model& a, const Model& b, std::vector<WrongAnswers>& counts) {
  const int level_a = osd_uniform_level(a.mesh, one_percent),
            level_b = osd_uniform_level(b.mesh, one_percent);
  std::vector<FclPair> peers;
  const auto add = [&](const TriangleMesh& mesh_a, const TriangleMesh& mesh_b) {
    counts[peers.size()].triangles += mesh_a.triangles.size() + mesh_b.triangles.size();
    peers.emplace_back(mesh_a, mesh_b, FclBoxes::obb);
  };
  add(osd_uniform(a.mesh, level_a), osd_uniform(b.mesh, level_b));
  const TriangleMesh snapped_a = osd_uniform(a.mesh, level_a, true),
                     snapped_b = osd_uniform(b.mesh, level_b, true);
  add(snapped_a, snapped_b);
#ifdef SNUG_BENCH_MESHOPT
  add(meshopt_simplified(snapped_a, one_percent), meshopt_simplified(snapped_b, one_percent));
#endif
  return peers;
}

void bench_wrong_answers(const std::vector<Model>& models, bool near_contact, const Options& options) {
  std::vector<WrongAnswers> counts{{"uniform Loop of 1 %"}, {"the same, snapped to the limit"}};
#ifdef SNUG_BENCH_MESHOPT
  counts.push_back({"snapped, simplified by 1 %"});
#endif
  std::size_t hits = 0, misses = 0, unsure = 0;
  const Library library = std::make_shared<BoundsCache>();
  std::mt19937_64 random(6);
  const std::size_t count = options.size<std::size_t>(10'000, 200) / model_pairs.size();
  for (const auto& [name_a, name_b] : model_pairs) {
    const Model &a = named(models, name_a), &b = named(models, name_b);
    const std::vector<FclPair> peers = meshes_of(a, b, counts);
    std::vector<PosePair> at(count);
    if (near_contact) {
      at = contact_placements(a, b, 3, one_percent, count, 5);
    } else {
      for (PosePair& placed : at) placed = place_in_room(3, random);
    }
    SnugPair pair(a, b, library);
    for (const PosePair& placed : at) {
      const std::optional<bool> truth = pair.queries.meet(placed);
      if (!truth) {
        ++unsure;
        continue;
      }
      ++(*truth ? hits : misses);
      for (std::size_t p = 0; p < peers.size(); ++p) {
        const bool said = peers[p].collide(placed);
        counts[p].missed += *truth && !said;
        counts[p].invented += !*truth && said;
      }
    }
  }
  std::printf("wrong answers, %s: %zu hits, %zu misses, %zu left out, where snug proves neither\n",
              near_contact ? "within 1 % of first contact" : "room 3", hits, misses, unsure);
  for (const WrongAnswers& wrong : counts) {
    std::printf("  %-32s %8zu triangles  misses %5zu of the hits (%.2f %%), invents %5zu (%.2f %%)\n",
                wrong.name, wrong.triangles, wrong.missed,
                100 * static_cast<double>(wrong.missed) / static_cast<double>(hits), wrong.invented,
                100 * static_cast<double>(wrong.invented) / static_cast<double>(misses));
  }
}
#endif

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 7, " SEVEN-MODELS");
  const std::vector<Model> models = read_models(options.files);
  bench_leaves(models);
  bench_first_answer(named(models, "bust"), named(models, "pawn"), options);
  bench_first_answer(named(models, "bust"), named(models, "figure"), options);
  bench_memory(named(models, "bust"), named(models, "pawn"), options);
  bench_queries(models, options);
#ifdef SNUG_BENCH_FCL
  for (const bool near_contact : {false, true}) bench_wrong_answers(models, near_contact, options);
#endif
  return 0;
}
