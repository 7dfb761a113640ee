// bench_poses: many poses of one pair, one by one and all at once, on one thread and on two. Files: the
// triangle models of examples/models.

#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <snug/query/pair_queries.h>

#include "placements.h"

namespace {

using namespace snug;
using namespace snug::bench;

constexpr double tolerance = 0.01, precision = 0.001;

double sum_of(const std::vector<Collision>& answers) {
  double sum = 0;
  for (const Collision& answer : answers) sum += static_cast<double>(answer.verdict);
  return sum;
}

double sum_of(const std::vector<Distance>& answers) {
  double sum = 0;
  for (const Distance& answer : answers) sum += answer.distance.upper;
  return sum;
}

// `ask` answers one pose, `ask_all` all of them. Scratch memory is warm, as in a long run of either.
template <class Ask, class AskAll>
void bench_pair(const std::string& title, const SurfaceBvh& a, const SurfaceBvh& b,
                const std::vector<PosePair>& poses, const Options& options, const Ask& ask,
                const AskAll& ask_all) {
  SurfaceWorkspace scratch_a(a), scratch_b(b);
  PairWorkspaces one(a, b, 1), two(a, b, 2);
  const auto count = static_cast<double>(poses.size());
  Group group(title, "pose", options);
  group.add("one by one", count, [&] {
    double sum = 0;
    for (const PosePair& at : poses) sum += ask({a, scratch_a, at.a}, {b, scratch_b, at.b});
    return sum;
  });
  group.add("all, one thread", count, [&] { return sum_of(ask_all(one)); });
  group.add("all, two threads", count, [&] { return sum_of(ask_all(two)); });
  const std::vector<Times> times = group.run();
  at_least("rate of two threads over twice that of one", times[1].wall / (2 * times[2].wall), 0.9);
  at_most("processor time of two threads over that of one", times[2].median / times[1].median, 1.1);
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 7, " SEVEN-MODELS");
  const std::vector<Model> models = read_models(options.files);
  const auto library = std::make_shared<BoundsCache>();
  for (const auto& [name_a, name_b] : model_pairs) {
    const LimitSurface surface_a(named(models, name_a).mesh, loop_rules(), library),
        surface_b(named(models, name_b).mesh, loop_rules(), library);
    const SurfaceBvh a(surface_a, {.threads = 1}), b(surface_b, {.threads = 1});
    std::mt19937_64 random(9);
    std::vector<PosePair> poses(options.size<std::size_t>(20'000, 400));
    for (PosePair& pair : poses) pair = place_in_room(3, random);
    const std::string names = std::string(name_a) + ", " + name_b;
    const CollideOptions touch{.tolerance = tolerance, .prove_contact = false, .measure = false};
    bench_pair(
        "collide, room 3, 1 %: " + names, a, b, poses, options,
        [&](const PlacedBvh& x, const PlacedBvh& y) {
          return static_cast<double>(collide(x, y, touch).verdict);
        },
        [&](PairWorkspaces& scratches) { return scratches.answers(collide, poses, touch); });
    poses.resize(poses.size() / 10);
    const DistanceOptions far{.absolute = precision};
    bench_pair(
        "distance, room 3, 0.1 %: " + names, a, b, poses, options,
        [&](const PlacedBvh& x, const PlacedBvh& y) { return distance(x, y, far).distance.upper; },
        [&](PairWorkspaces& scratches) { return scratches.answers(distance, poses, far); });
  }
  return 0;
}
