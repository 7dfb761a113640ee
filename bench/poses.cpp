// bench_poses: many poses of one pair, one by one and all at once, on one thread and on two. Files: the
// triangle models of examples/models.

#include <random>
#include <string>
#include <utility>
#include <vector>

#include <snug/distance.h>

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

// `ask` answers one pose, `ask_all` all of them. Workspaces are warm, as in a long run of either.
template <class Ask, class AskAll>
void bench_pair(const std::string& title, const Surface& a, const Surface& b,
                const std::vector<PosePair>& poses, const Options& options, const Ask& ask,
                const AskAll& ask_all) {
  Workspace workspace;
  const auto count = static_cast<double>(poses.size());
  Group group(title, "pose", options);
  group.add("one by one", count, [&] {
    double sum = 0;
    for (const PosePair& at : poses) sum += ask(a.at(at.a), b.at(at.b), Run{.workspace = &workspace});
    return sum;
  });
  group.add("all, one thread", count,
            [&] { return sum_of(ask_all(Run{.threads = 1, .workspace = &workspace})); });
  group.add("all, two threads", count,
            [&] { return sum_of(ask_all(Run{.threads = 2, .workspace = &workspace})); });
  const std::vector<Times> times = group.run();
  at_most("processor time of all at once over one by one", times[1].median / times[0].median, 1);
  at_least("rate of two threads over twice that of one", times[1].wall / (2 * times[2].wall), 0.9);
  at_most("processor time of two threads over that of one", times[2].median / times[1].median, 1.1);
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 7, " SEVEN-MODELS");
  const std::vector<Model> models = read_models(options.files);
  for (const auto& [name_a, name_b] : model_pairs) {
    const Surface a(named(models, name_a).mesh, {.scheme = Scheme::loop}),
        b(named(models, name_b).mesh, {.scheme = Scheme::loop});
    std::mt19937_64 random(9);
    std::vector<PosePair> poses(options.size<std::size_t>(20'000, 400));
    for (PosePair& pair : poses) pair = place_in_room(3, random);
    const std::string names = std::string(name_a) + ", " + name_b;
    const CollideOptions touch{.tolerance = tolerance};
    bench_pair(
        "collide, room 3, 1 %: " + names, a, b, poses, options,
        [&](const PlacedSurface& x, const PlacedSurface& y, const Run& run) {
          return static_cast<double>(collide(x, y, touch, run).verdict);
        },
        [&](const Run& run) { return collide(a, b, poses, touch, run); });
    poses.resize(poses.size() / 10);
    const DistanceOptions far{.absolute = precision};
    bench_pair(
        "distance, room 3, 0.1 %: " + names, a, b, poses, options,
        [&](const PlacedSurface& x, const PlacedSurface& y, const Run& run) {
          return distance(x, y, far, run).distance.upper;
        },
        [&](const Run& run) { return distance(a, b, poses, far, run); });
  }
  return 0;
}
