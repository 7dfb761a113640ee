#include <experiments/room_tables.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include <experiments/bound_counts.h>
#include <experiments/printed_hierarchy.h>
#include <experiments/quantile.h>
#include <experiments/rooms.h>
#include <snug/query/pair_queries.h>
#include <snug/search/piece_cache.h>
#include <support/contract.h>
#include <support/error.h>

namespace snug {
namespace {

// Tolerance of Moeller against rounding.
constexpr double moeller_epsilon = 1e-6;
// Surfaces this near are counted as hits.
constexpr double contact = 1e-7;
// Of the checksum FNV-1a.
constexpr std::uint64_t fnv_offset = 0xcbf29ce484222325, fnv_prime = 0x100000001b3;

constexpr LeafOptions with_rows(double tolerance) { return {tolerance, BoundMethod::rows, false}; }
constexpr LeafOptions with_tables(double tolerance) { return {tolerance, BoundMethod::table, false}; }
constexpr LeafOptions as_printed(double tolerance) { return {tolerance, BoundMethod::table, true}; }

double seconds_of(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

SurfaceBvhOptions model_options(BoundMethod method, bool tight) {
  SurfaceBvhOptions options;
  options.method = method;
  options.tight = tight;
  options.threads = 1;
  return options;
}

std::vector<PosePair> placements_in(const RoomOptions& options) {
  std::mt19937_64 random(options.seed);
  std::vector<PosePair> placements(options.placements);
  for (PosePair& placed : placements) placed = place_in_room(options.side, random);
  return placements;
}

// Two models and the memory of their queries.
class QueryPair {
 public:
  QueryPair(const LimitSurface& a, const LimitSurface& b, BoundMethod method)
      : a_(a, model_options(method, true)),
        b_(b, model_options(method, true)),
        scratch_a_(a_),
        scratch_b_(b_) {}

  Verdict ask(const PosePair& at, double tolerance, double margin = 0) {
    CollideOptions options{.tolerance = 0, .prove_contact = false, .measure = false};
    options.tolerance = tolerance;
    options.margin = margin;
    return collide({a_, scratch_a_, at.a}, {b_, scratch_b_, at.b}, options).verdict;
  }

 private:
  SurfaceBvh a_, b_;
  PieceCache scratch_a_, scratch_b_;
};

}  // namespace

LeafCounts count_leaves(const LimitSurface& surface, double tolerance, const WorkMonitor& monitor) {
  LayoutTables tables(surface.library());
  return {leaves(surface, with_rows(tolerance), monitor).size(),
          leaves(surface, with_tables(tolerance), monitor).size(),
          leaves(surface, as_printed(tolerance), monitor).size(),
          count_pieces(surface, tables, BoundWay::control_box, {.tolerance = tolerance, .budget = UINT64_MAX})
              .count};
}

CreationTimes measure_creation(const ControlMesh& mesh, const SchemeOptions& rules, double tolerance,
                               unsigned rounds, const WorkMonitor& monitor) {
  require_value(rounds >= 1, "creation times: give at least one round");
  const auto library = std::make_shared<BoundsCache>();
  const std::array<std::function<void()>, 4> works{
      [&] {
        const LimitSurface surface(mesh, rules, library);
        const SurfaceBvh model(surface, model_options({}, false));
      },
      [&] {
        const LimitSurface surface(mesh, rules, library);
        const SurfaceBvh model(surface, model_options({}, true));
      },
      [&] { const PrintedHierarchy tree(LimitSurface(mesh, rules, library), with_rows(tolerance), monitor); },
      [&] {
        const PrintedHierarchy tree(LimitSurface(mesh, rules, library), as_printed(tolerance), monitor);
      }};
  std::array<double, 4> medians{};
  for (std::size_t w = 0; w < works.size(); ++w) {
    works[w]();  // makes rows and tables of the kinds
    std::vector<double> times;
    for (unsigned round = 0; round < rounds; ++round) times.push_back(seconds_of(works[w]));
    medians[w] = quantile(times, 0.5);
  }
  return {medians[0], medians[1], medians[2], medians[3]};
}

RoomRow measure_room(const LimitSurface& a, const LimitSurface& b, const RoomOptions& options,
                     const WorkMonitor& monitor) {
  require_value(options.placements >= 1, "room: give at least one placement");
  const double tolerance = options.tolerance;
  QueryPair rows(a, b, BoundMethod::rows), tables(a, b, BoundMethod::table);
  const PrintedHierarchy printed_a(a, as_printed(tolerance), monitor),
      printed_b(b, as_printed(tolerance), monitor);
  const std::vector<PosePair> placements = placements_in(options);

  // Each method answers all placements; the first ones beforehand, too.
  using Ask = std::function<Verdict(const PosePair&)>;
  const std::array<Ask, 3> asks{[&](const PosePair& at) { return rows.ask(at, tolerance); },
                                [&](const PosePair& at) { return tables.ask(at, tolerance); },
                                [&](const PosePair& at) {
                                  return PrintedHierarchy::says_separated(printed_a, at.a, printed_b, at.b,
                                                                          tolerance)
                                             ? Verdict::separated
                                             : Verdict::undecided;
                                }};
  std::array<double, 3> times{};
  std::array<std::vector<Verdict>, 3> said;
  for (std::size_t m = 0; m < asks.size(); ++m) {
    const std::size_t warm = std::min<std::size_t>(500, placements.size());
    for (std::size_t i = 0; i < warm; ++i) static_cast<void>(asks[m](placements[i]));
    said[m].reserve(placements.size());
    times[m] = seconds_of([&] {
      for (std::size_t i = 0; i < placements.size(); ++i) {
        if (i % 512 == 0) {
          monitor.report(
              (static_cast<double>(m) + static_cast<double>(i) / static_cast<double>(placements.size())) /
              asks.size());
        }
        said[m].push_back(asks[m](placements[i]));
      }
    });
  }
  RoomRow row;
  const double count = static_cast<double>(placements.size());
  row.rows = times[0] / count;
  row.tables = times[1] / count;
  row.printed = times[2] / count;
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const bool apart = said[0][i] == Verdict::separated, within = said[0][i] == Verdict::within,
               printed_apart = said[2][i] == Verdict::separated;
    const bool moeller_apart =
        within && PrintedHierarchy::says_separated(printed_a, placements[i].a, printed_b, placements[i].b,
                                                   moeller_epsilon);
    const Verdict touching = apart ? Verdict::separated : rows.ask(placements[i], contact);
    const bool hit = touching == Verdict::within || touching == Verdict::intersecting;
    row.within += within;
    row.hits += hit;
    row.printed_missed += within && printed_apart;
    row.printed_missed_moeller += moeller_apart;
    row.printed_missed_hits += hit && (printed_apart || moeller_apart);
    row.printed_alarms += !printed_apart && rows.ask(placements[i], contact, tolerance) == Verdict::separated;
  }
  return row;
}

std::vector<VolumeRow> measure_volumes(const LimitSurface& a, const LimitSurface& b,
                                       const RoomOptions& options, const WorkMonitor& monitor) {
  require_value(options.placements >= 1, "room: give at least one placement");
  constexpr std::size_t rounds = 5;
  const std::vector<PosePair> placements = placements_in(options);
  const PrintedHierarchy hierarchy_a(a, with_rows(options.tolerance), monitor),
      hierarchy_b(b, with_rows(options.tolerance), monitor);
  struct Subject {
    VolumeRow row;
    VolumeTree a, b;
    std::vector<double> times;
  };
  std::vector<Subject> subjects;
  for (const Volume volume : all_volumes) {
    for (const Turning turning : {Turning::bounded, Turning::refitted}) {
      if (volume == Volume::obb && turning == Turning::refitted) continue;
      subjects.push_back({{.volume = volume, .turning = turning},
                          VolumeTree(hierarchy_a, volume),
                          VolumeTree(hierarchy_b, volume),
                          {}});
    }
  }
  const double count = static_cast<double>(placements.size());
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t s = 0; s < subjects.size(); ++s) {
      monitor.report(static_cast<double>(round * subjects.size() + s) /
                     static_cast<double>(rounds * subjects.size()));
      Subject& subject = subjects[s];
      VolumeRow& row = subject.row;
      std::uint64_t volume_tests = 0, triangle_tests = 0;
      row.possible = 0;
      row.verdicts_sum = fnv_offset;
      subject.times.push_back(seconds_of([&] {
        for (const PosePair& at : placements) {
          const VolumeTree::Answer answer =
              VolumeTree::compare(subject.a, at.a, subject.b, at.b, row.turning);
          volume_tests += answer.volume_tests;
          triangle_tests += answer.triangle_tests;
          row.possible += !answer.separated;
          row.verdicts_sum = (row.verdicts_sum ^ static_cast<std::uint64_t>(answer.separated)) * fnv_prime;
        }
      }));
      row.volume_tests = static_cast<double>(volume_tests) / count;
      row.triangle_tests = static_cast<double>(triangle_tests) / count;
    }
  }
  std::vector<VolumeRow> rows;
  for (const Subject& subject : subjects) {
    VolumeRow row = subject.row;
    row.bytes = subject.a.bytes() + subject.b.bytes();
    row.seconds = quantile(subject.times, 0.5) / count;
    SNUG_EXPECT(row.verdicts_sum == subjects[0].row.verdicts_sum);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace snug
