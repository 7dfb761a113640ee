#include <snug/scene.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <string>
#include <tuple>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include <snug/bvh/box_tree.h>
#include <snug/search/placed_box.h>
#include <snug/search/workspace.h>
#include <support/error.h>
#include <support/in_order.h>
#include <support/parallel.h>
#include <support/run.h>
#include <support/workers.h>

namespace snug {
namespace {

// Pairs that are answered between two calls of the broad phase.
constexpr std::size_t pairs_of_a_batch = 16384;

// Parts whose neighbours are looked for between two looks at how many there are.
constexpr std::size_t min_block = 16, max_block = 4096;

PartPair sorted(const PartPair& pair) { return {std::min(pair.a, pair.b), std::max(pair.a, pair.b)}; }
bool before(const PartPair& x, const PartPair& y) { return x.a < y.a || (x.a == y.a && x.b < y.b); }
bool margin_before(const PairMargin& x, const PairMargin& y) { return before(x.parts, y.parts); }

void require_parts(const PartPair& pair, std::size_t parts, const std::string& what) {
  for (const std::uint32_t part : {pair.a, pair.b}) {
    if (part >= parts) {
      refuse_value(
          (what + ": there is no part " + std::to_string(part) + "; the scene has " + std::to_string(parts))
              .c_str());
    }
  }
  if (pair.a == pair.b) {
    refuse_value((what + ": part " + std::to_string(pair.a) + " with itself; give two parts").c_str());
  }
}

std::vector<PairMargin> sorted_margins(const Scene& scene) {
  std::vector<PairMargin> margins = scene.margins;
  for (std::size_t i = 0; i < margins.size(); ++i) {
    const std::string what = "margins[" + std::to_string(i) + "]";
    require_parts(margins[i].parts, scene.parts.size(), what);
    require_length(margins[i].margin, what.c_str());
    margins[i].parts = sorted(margins[i].parts);
  }
  std::sort(margins.begin(), margins.end(), margin_before);
  for (std::size_t i = 1; i < margins.size(); ++i) {
    const PartPair& parts = margins[i].parts;
    if (parts == margins[i - 1].parts) {
      refuse_value(("margins: parts " + std::to_string(parts.a) + " and " + std::to_string(parts.b) +
                    " have two; give one")
                       .c_str());
    }
  }
  return margins;
}

// Runs `work`; refusals begin with the part's place.
template <class Work>
auto naming_parts(const std::string& parts, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(error.problem(), parts + ": " + error.what());
  }
}

std::string names_of(const PartPair& pair) {
  return "parts " + std::to_string(pair.a) + " and " + std::to_string(pair.b);
}

}  // namespace

struct SceneBroadPhase::State {
  State(const Scene& in_scene, double in_margin, bool in_all, const Run& run)
      : scene(in_scene),
        margin(in_margin),
        all(in_all),
        threads(run.threads),
        monitor(stop_only(run)),
        margins(sorted_margins(in_scene)) {
    require_length(margin, "the margin of a scene");
    require_value(scene.parts.size() < UINT32_MAX, "a scene has fewer than 2^32 - 1 parts; take it apart");
    if (scene.pairs) {
      for (std::size_t i = 0; i < scene.pairs->size(); ++i) {
        require_parts((*scene.pairs)[i], scene.parts.size(), "pairs[" + std::to_string(i) + "]");
      }
    }
    make_boxes();
    if (scene.pairs || all) return;
    tree.emplace(boxes);
    reach.assign(scene.parts.size(), margin);
    for (const PairMargin& own : margins) {
      for (const std::uint32_t part : {own.parts.a, own.parts.b}) {
        reach[part] = std::max(reach[part], own.margin);
      }
    }
  }

  // Trees of all surfaces first, each by one thread: the first query would make them one after the other.
  void make_boxes() {
    std::unordered_map<const SurfaceData*, std::size_t> first;
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
      first.try_emplace(scene.parts[i].surface().data().get(), i);
    }
    std::vector<std::size_t> surfaces;
    for (const auto& [surface, part] : first) surfaces.push_back(part);
    std::sort(surfaces.begin(), surfaces.end());
    parallel_for(surfaces.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        monitor.checkpoint();
        naming_parts("part " + std::to_string(surfaces[i]),
                     [&] { static_cast<void>(scene.parts[surfaces[i]].surface().data()->bvh()); });
      }
    });
    boxes.resize(scene.parts.size());
    parallel_for(boxes.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        boxes[i] = placed_box(scene.parts[i].surface().data()->bvh(), scene.parts[i].pose());
      }
    });
  }

  [[nodiscard]] double margin_of(const PartPair& pair) const {
    if (margins.empty()) return margin;
    const auto at =
        std::lower_bound(margins.begin(), margins.end(), PairMargin{sorted(pair), 0}, margin_before);
    return at != margins.end() && at->parts == sorted(pair) ? at->margin : margin;
  }
  [[nodiscard]] ScenePair pair_of(const PartPair& parts) const {
    return {parts, margin_of(parts), gap_of(boxes[parts.a], boxes[parts.b])};
  }

  // Pairs of part `a` with parts after it.
  void add_pairs_of(std::uint32_t a, std::vector<ScenePair>& out) const {
    const auto add = [&](std::uint32_t b) {
      const ScenePair pair = pair_of({a, b});
      if (all || !pair.separated_by_boxes()) out.push_back(pair);
    };
    if (all) {
      for (std::uint32_t b = a + 1; b < boxes.size(); ++b) add(b);
      return;
    }
    tree->find_near(boxes[a], reach[a], a, add);
    std::sort(out.begin(), out.end(),
              [](const ScenePair& x, const ScenePair& y) { return x.parts.b < y.parts.b; });
  }

  void add_listed(std::size_t count, std::vector<ScenePair>& out) {
    for (; done < scene.pairs->size() && out.size() < count; ++done) {
      const ScenePair pair = pair_of((*scene.pairs)[done]);
      if (all || !pair.separated_by_boxes()) out.push_back(pair);
    }
  }

  // Neighbours of some parts at once, of more the fewer they have.
  void add_block(std::vector<ScenePair>& out) {
    const std::size_t size = std::min(block, boxes.size() - done);
    std::vector<std::vector<ScenePair>> found(size);
    parallel_for(size, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) add_pairs_of(static_cast<std::uint32_t>(done + i), found[i]);
    });
    const std::size_t old = out.size();
    for (const std::vector<ScenePair>& pairs : found) out.insert(out.end(), pairs.begin(), pairs.end());
    done += size;
    const bool few = out.size() - old < pairs_of_a_batch;
    block = few ? std::min(2 * block, max_block) : std::max<std::size_t>(block / 2, 1);
  }

  const Scene& scene;
  double margin;
  bool all;
  int threads;
  WorkMonitor monitor;
  std::vector<PairMargin> margins;  // in the order of parts
  std::vector<Box3> boxes;
  std::vector<double> reach;  // largest margin of a part; with a tree only
  std::optional<BoxTree> tree;
  std::size_t done = 0;  // pairs where they are listed, else parts
  std::size_t block = min_block;
};

SceneBroadPhase::SceneBroadPhase(const Scene& scene, double margin, bool all, const Run& run)
    : state_(std::make_unique<State>(scene, margin, all, run)) {}
SceneBroadPhase::~SceneBroadPhase() = default;

std::vector<ScenePair> SceneBroadPhase::next(std::size_t count) {
  State& state = *state_;
  std::vector<ScenePair> result;
  if (state.scene.pairs) {
    state.add_listed(count, result);
    return result;
  }
  while (result.size() < count && state.done < state.boxes.size()) {
    state.monitor.checkpoint();
    state.add_block(result);
  }
  return result;
}

std::uint64_t SceneBroadPhase::pair_count() const {
  if (state_->scene.pairs) return state_->scene.pairs->size();
  const std::uint64_t parts = state_->scene.parts.size();
  return parts == 0 ? 0 : parts * (parts - 1) / 2;
}

double SceneBroadPhase::share() const {
  const std::size_t all = state_->scene.pairs ? state_->scene.pairs->size() : state_->scene.parts.size();
  return all == 0 ? 1 : static_cast<double>(state_->done) / static_cast<double>(all);
}

const Box3& SceneBroadPhase::box(std::uint32_t part) const { return state_->boxes.at(part); }

namespace {

// Calls what a monitor has for a part of the work that takes it from `from` to `to`.
void report_part(const WorkMonitor& monitor, double from, double to, std::size_t done, std::size_t count) {
  if (done % 64 != 0) return monitor.checkpoint();
  monitor.report(from + (to - from) * static_cast<double>(done) / static_cast<double>(count));
}

// All that an answer depends on: two surfaces, the bits of their poses, options.
template <class... Options>
struct PairQuery {
  std::array<std::uint64_t, 26> placed;
  std::tuple<Options...> options;
  PairQuery(const PlacedSurface& a, const PlacedSurface& b, const Options&... in_options)
      : options(in_options...) {
    auto* next = placed.data();
    for (const PlacedSurface* part : {&a, &b}) {
      *next++ = part->surface().data()->number();
      for (const double x : part->pose().numbers()) *next++ = std::bit_cast<std::uint64_t>(x);
    }
  }
  friend bool operator==(const PairQuery&, const PairQuery&) = default;
  [[nodiscard]] std::size_t hash() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t word : placed) sum = (sum ^ word) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(sum >> 32);
  }
};

// Some answers, for copies of parts in one place, whose pairs differ in nothing but names.
template <class Query, class Answer>
class KnownAnswers {
 public:
  [[nodiscard]] const Answer* find(const Query& query) const {
    const auto& place = places_[query.hash() % places_.size()];
    return place && place->first == query ? &place->second : nullptr;
  }
  void keep(const Query& query, const Answer& answer) {
    places_[query.hash() % places_.size()].emplace(query, answer);
  }

 private:
  std::array<std::optional<std::pair<Query, Answer>>, 64> places_;
};

auto query_of(const PlacedSurface& a, const PlacedSurface& b, const CollideOptions& options,
              const std::optional<std::uint64_t>& max_splits) {
  const auto& [tolerance, margin, witness, prove_contact, solid, measure] = options;
  return PairQuery(a, b, max_splits, tolerance, margin, witness, prove_contact, solid, measure);
}

}  // namespace

Collision collide(const Scene& scene, const ScenePair& pair, CollideOptions options, const Run& run) {
  require_parts(pair.parts, scene.parts.size(), "the pair");
  const PlacedSurface &a = scene.parts[pair.parts.a], &b = scene.parts[pair.parts.b];
  options.margin = pair.margin;
  const auto query = query_of(a, b, options, run.max_splits);
  auto& known =
      workspace_of(run).pieces().kept<KnownAnswers<std::remove_const_t<decltype(query)>, Collision>>(
          Workspace::Pieces::Kept::collisions);
  if (const Collision* const answer = known.find(query)) return *answer;
  const Collision answer = naming_parts(names_of(pair.parts), [&] { return collide(a, b, options, run); });
  // Answers from the root boxes are cheaper to compute again than to keep.
  if (answer.stats.box_tests > 0) known.keep(query, answer);
  return answer;
}

std::optional<Distance> distance(const Scene& scene, const ScenePair& pair, const DistanceOptions& options,
                                 const Run& run) {
  require_parts(pair.parts, scene.parts.size(), "the pair");
  const PlacedSurface &a = scene.parts[pair.parts.a], &b = scene.parts[pair.parts.b];
  const auto& [absolute, relative, solid] = options;
  const PairQuery query(a, b, pair.margin, run.max_splits, absolute, relative, solid);
  auto& known = workspace_of(run).pieces().kept<KnownAnswers<std::remove_const_t<decltype(query)>, Distance>>(
      Workspace::Pieces::Kept::distances);
  if (const Distance* const answer = known.find(query)) return *answer;
  return naming_parts(names_of(pair.parts), [&]() -> std::optional<Distance> {
    // A verdict finds pairs beyond the limit sooner than a distance does.
    const CollideOptions beyond{.margin = pair.margin, .witness = WitnessKind::none, .solid = options.solid};
    if (collide(a, b, beyond, run).verdict == Verdict::separated) return {};
    Distance found = distance(a, b, options, run);
    if (found.distance.lower > pair.margin) return {};
    known.keep(query, found);
    return found;
  });
}

namespace {

// Answers every pair with ask(pair, workspace) and passes the answers to take(pair, answer) in order.
template <class Answer, class Ask, class Take>
std::uint64_t answer_pairs(SceneBroadPhase& pairs, const Run& run, const Ask& ask, const Take& take) {
  Workers<Workspace> workers = workers_of(run);
  const WorkMonitor quiet = stop_only(run);
  std::uint64_t count = 0;
  for (double before = 0;; before = pairs.share()) {
    const std::vector<ScenePair> batch = pairs.next(pairs_of_a_batch);
    if (batch.empty()) return count;
    count += batch.size();
    std::atomic<std::size_t> done{0};
    InOrder<Answer> answers(batch.size(), [&](std::size_t i, Answer& answer) { take(batch[i], answer); });
    workers.for_each(batch.size(), [&](Workspace& workspace, std::size_t i) {
      report_part(monitor_of(run), before, pairs.share(), done++, batch.size());
      answers.put(
          i, ask(batch[i], Run{.monitor = &quiet, .workspace = &workspace, .max_splits = run.max_splits}));
    });
  }
}

}  // namespace

SceneCounts collide(const Scene& scene, const CollideOptions& options,
                    const std::function<void(const PairCollision&)>& sink, const Run& run) {
  SceneBroadPhase pairs(scene, options.margin, false, run);
  SceneCounts counts;
  std::vector<PairCollision> proved;
  const auto ask = [&](const ScenePair& pair, const Run& each) {
    return collide(scene, pair, options, each);
  };
  const auto take = [&](const ScenePair& pair, Collision& answer) {
    const Verdict verdict = answer.verdict;
    ++(verdict == Verdict::separated      ? counts.separated
       : verdict == Verdict::within       ? counts.within
       : verdict == Verdict::intersecting ? counts.intersecting
                                          : counts.undecided);
    if (run.certificate != nullptr) proved.push_back({pair.parts, answer});
    sink({pair.parts, std::move(answer)});
  };
  const std::uint64_t near = answer_pairs<Collision>(pairs, run, ask, take);
  certify(scene, options, proved, run);
  counts.pairs = pairs.pair_count();
  counts.separated_by_boxes = counts.pairs - near;
  return counts;
}

SceneCounts distance(const Scene& scene, double limit, const DistanceOptions& options,
                     const std::function<void(const PairDistance&)>& sink, const Run& run) {
  require_length(limit, "distance: the limit");
  const Scene bare{scene.parts, scene.pairs, {}};
  SceneBroadPhase pairs(bare, limit, false, run);
  SceneCounts counts;
  std::vector<PairDistance> proved;
  const auto ask = [&](const ScenePair& pair, const Run& each) {
    return distance(bare, pair, options, each);
  };
  const auto take = [&](const ScenePair& pair, std::optional<Distance>& answer) {
    if (!answer) {
      ++counts.separated;
      return;
    }
    ++(answer->distance.upper == 0 ? counts.intersecting : counts.within);
    if (run.certificate != nullptr) proved.push_back({pair.parts, *answer});
    sink({pair.parts, std::move(*answer)});
  };
  const std::uint64_t near = answer_pairs<std::optional<Distance>>(pairs, run, ask, take);
  certify(bare, limit, options, proved, run);
  counts.pairs = pairs.pair_count();
  counts.separated_by_boxes = counts.pairs - near;
  return counts;
}

}  // namespace snug
