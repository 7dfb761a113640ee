// bench_front: what a warm query through public handles costs beside the query inside, whose trees and
// workspaces are at hand.
// Files: bust and pawn of examples/models.

#include <random>
#include <string>
#include <thread>
#include <vector>

#include <snug/query/closest.h>
#include <snug/query/pair_queries.h>
#include <snug/search/workspace.h>

#include "placements.h"

namespace {

using namespace snug;
using namespace snug::bench;

// Adds both ways to ask, runs them, and holds the one through handles against the other.
template <class Inside, class Handles>
void compare(const std::string& title, std::size_t count, std::size_t repeats, const Options& options,
             const Inside& inside, const Handles& handles) {
  Group group(title, "query", options);
  const auto all = [count, repeats](const auto& ask) {
    return [count, repeats, &ask] {
      double sum = 0;
      for (std::size_t round = 0; round < repeats; ++round) {
        for (std::size_t i = 0; i < count; ++i) sum += ask(i);
      }
      return sum;
    };
  };
  const auto items = static_cast<double>(count * repeats);
  group.add("inside", items, all(inside));
  group.add("handles", items, all(handles));
  const std::vector<Times> times = group.run();
  at_most("handles over inside", times[1].median / times[0].median, 1.05);
}

class Pair {
 public:
  Pair(const Model& a, const Model& b)
      : a_(a.mesh), b_(b.mesh), inside_a_(a_.data()->bvh()), inside_b_(b_.data()->bvh()) {}

  void collide(const std::string& where, const std::vector<PosePair>& poses, std::size_t repeats,
               const CollideOptions& how, const Options& options) {
    compare((how.measure ? "collide and measure, " : "collide, ") + where, poses.size(), repeats, options,
            [&](std::size_t i) {
              return value(snug::collide({inside_a_.model(), inside_a_, poses[i].a},
                                         {inside_b_.model(), inside_b_, poses[i].b}, how));
            },
            [&](std::size_t i) { return value(snug::collide(a_.at(poses[i].a), b_.at(poses[i].b), how)); });
  }

  void distance(const std::string& where, const std::vector<PosePair>& poses, const Options& options) {
    const DistanceOptions how{.absolute = {}, .relative = 0.01};
    compare(
        "distance, " + where, poses.size(), 1, options,
        [&](std::size_t i) {
          return snug::distance({inside_a_.model(), inside_a_, poses[i].a},
                                {inside_b_.model(), inside_b_, poses[i].b}, how)
              .distance.upper;
        },
        [&](std::size_t i) {
          return snug::distance(a_.at(poses[i].a), b_.at(poses[i].b), how).distance.upper;
        });
  }

  void closest(const std::string& where, double reach, std::size_t count, const Options& options) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> coordinate(-reach, reach);
    std::vector<Point3> points(count);
    for (Point3& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
    const Precision how{.absolute = 1e-3};
    compare(
        "closest, " + where, count, 1, options,
        [&](std::size_t i) { return closest_point(inside_a_, points[i], how).distance.upper; },
        [&](std::size_t i) { return closest_point(a_, points[i], how).distance.upper; });
  }

 private:
  static double value(const Collision& answer) {
    return static_cast<double>(answer.verdict) + answer.distance.lower;
  }

  Surface a_, b_;
  PieceCache inside_a_, inside_b_;
};

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 2, " BUST PAWN");
  const std::vector<Model> models = read_models(options.files);
  const Model &bust = named(models, "bust"), &pawn = named(models, "pawn");
  // From its first thread on a process counts the owners of handles atomically.
  std::thread([] {}).join();
  Pair pair(bust, pawn);
  const auto count = options.size<std::size_t>(200, 20);
  const std::vector<PosePair> near = contact_placements(bust, pawn, 3, 0.02, count, 11);
  std::vector<PosePair> far(count);
  std::mt19937_64 random(12);
  for (PosePair& at : far) {
    at = place_in_room(3, random);
    at.b = Motion::translation({5, 0, 0}) * at.b;
  }
  for (const bool measure : {false, true}) {
    const CollideOptions how{.measure = measure};
    pair.collide("near", near, 1, how, options);
    pair.collide("far", far, options.size<std::size_t>(measure ? 1 : 1000, 1), how, options);
  }
  pair.distance("near", near, options);
  pair.distance("far", far, options);
  pair.closest("near", 0.6, 10 * count, options);
  pair.closest("far", 5, 10 * count, options);
  return 0;
}
