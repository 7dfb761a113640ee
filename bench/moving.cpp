// bench_moving: a surface whose control points move: what a frame costs with a tree that is refitted, beside a
// surface and tree built anew, and what queries on such trees cost beside those on trees built there.

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <snug/query/closest.h>
#include <snug/query/pair_queries.h>
#include <snug/search/surface_data.h>
#include <snug/snug.h>

#include "meshes.h"
#include "placements.h"
#include "runner.h"

namespace {

using namespace snug;
using namespace snug::bench;

struct Way {
  std::string name;
  std::function<Point3(const Point3& rest, double time)> at;  ///< time from 0 to 1
};

// A torus of radii 3 and 1 about the z axis, as all of these meshes are.
std::vector<Way> ways() {
  const auto turned = [](double a, double b, double angle) {
    return std::pair{std::cos(angle) * a - std::sin(angle) * b, std::sin(angle) * a + std::cos(angle) * b};
  };
  return {{"turned by a right angle",
           [=](const Point3& p, double t) {
             const auto [x, y] = turned(p.x, p.y, t * std::numbers::pi / 2);
             const auto [u, z] = turned(x, p.z, t * std::numbers::pi / 2);
             return Point3{u, y, z};
           }},
          {"bent by 90 degrees",
           [=](const Point3& p, double t) {
             const double angle = t * std::numbers::pi / 2 * p.x / 8,
                          radius = 8 / (std::numbers::pi / 2 * t + 1e-9);
             return Point3{std::sin(angle) * (radius + p.z), p.y, std::cos(angle) * (radius + p.z) - radius};
           }},
          {"twisted by 90 degrees",
           [=](const Point3& p, double t) {
             const auto [y, z] = turned(p.y, p.z, t * std::numbers::pi / 2 * p.x / 8);
             return Point3{p.x, y, z};
           }},
          {"breathing by 10 %",
           [](const Point3& p, double t) {
             const double by = 1 + 0.1 * t * std::cos(p.x) * std::cos(p.y);
             return Point3{by * p.x, by * p.y, by * p.z};
           }},
          {"waves of a tenth",
           [](const Point3& p, double t) {
             return Point3{p.x, p.y, p.z + 0.6 * t * std::sin(3 * p.x + 2 * p.y)};
           }},
          {"twisted by two turns",
           [=](const Point3& p, double t) {
             const auto [y, z] = turned(p.y, p.z, t * 4 * std::numbers::pi * p.x / 8);
             return Point3{p.x, y, z};
           }},
          {"stretched six times",
           [](const Point3& p, double t) {
             return Point3{(1 + 5 * t) * p.x, p.y, p.z};
           }},
          {"everything thrown about", [](const Point3& p, double t) {
             const auto noise = [&](double a, double b, double c) {
               const double x = 4375.85453 * std::sin(a * p.x + b * p.y + c * p.z);
               return t * (x - std::floor(x) - 0.5);
             };
             return Point3{p.x + noise(12.9898, 78.233, 37.719), p.y + noise(39.346, 11.135, 83.155),
                           p.z + noise(73.156, 52.235, 9.151)};
           }}};
}

std::vector<Point3> moved(const ControlMesh& mesh, const Way& way, double time) {
  std::vector<Point3> points;
  points.reserve(mesh.points.size());
  for (const Point3& p : mesh.points) points.push_back(way.at(p, time));
  return points;
}

constexpr std::size_t frames = 8;

// Ball's and box's numbers, so that nothing is left out.
double checksum(const SurfaceBvh& tree) { return tree.ball().radius + tree.box().half.x; }

void bench_frames(const std::string& name, const ControlMesh& mesh, const Options& options) {
  const Surface first(mesh);
  const auto patches = static_cast<double>(first.data()->limit().patch_count());
  const Way bend = ways()[1];
  std::vector<std::vector<Point3>> points;
  for (std::size_t f = 0; f < frames; ++f) {
    points.push_back(moved(mesh, bend, static_cast<double>(f + 1) / frames));
  }
  const auto each_frame = [&points](const auto& show) {
    return [&points, show] {
      double sum = 0;
      for (const std::vector<Point3>& now : points) sum += show(now);
      return sum;
    };
  };
  Group group("a frame: " + name + ", " + std::to_string(first.data()->limit().patch_count()) + " patches",
              "patch", options);
  const double items = patches * frames;
  MovingSurface moving(first), positions(first);
  group.add("refitted: move() and the tree", items, each_frame([&](const std::vector<Point3>& now) {
              return checksum(moving.move(now).data()->bvh());
            }));
  group.add("refitted: move() alone", items,
            each_frame([&](const std::vector<Point3>& now) { return positions.move(now).size(); }));
  group.add("built anew: Surface and whole tree", items, each_frame([&](const std::vector<Point3>& now) {
              ControlMesh copy = mesh;
              copy.points = now;
              const Surface surface(std::move(copy));
              return checksum(SurfaceBvh(surface.data()->limit(), {.threads = 1, .min_lazy = SIZE_MAX}));
            }));
  group.add("built anew: Surface and what a first query needs", items,
            each_frame([&](const std::vector<Point3>& now) {
              ControlMesh copy = mesh;
              copy.points = now;
              const Surface surface(std::move(copy));
              return checksum(SurfaceBvh(surface.data()->limit(), {.threads = 1}));
            }));
  group.run();
}

// A tree with its workspace.
struct QueriedModel {
  explicit QueriedModel(const SurfaceBvh& tree) : model(tree), scratch(tree) {}
  const SurfaceBvh& model;
  PieceCache scratch;
};

void bench_queries(const std::string& name, const ControlMesh& mesh, const Way& way, const Options& options) {
  ControlMesh other_mesh = regular_mesh(options.size(2'000, 500));
  const Surface other(std::move(other_mesh)), first(mesh);
  MovingSurface moving(first);
  ControlMesh there = mesh;
  double refit_looser = 0;
  for (std::size_t f = 1; f <= frames; ++f) {
    there.points = moved(mesh, way, static_cast<double>(f) / frames);
    refit_looser = checksum(moving.move(there.points).data()->bvh());
  }
  static_cast<void>(refit_looser);
  const LimitSurface& limit = moving.now().data()->limit();
  const SurfaceBvh built(limit, {.threads = 1, .min_lazy = SIZE_MAX});
  QueriedModel fresh(built), refitted(moving.now().data()->bvh()), against(other.data()->bvh());

  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const double size = first.size();
  std::vector<Point3> points;
  std::vector<Motion> poses;
  for (std::size_t i = 0; i < options.size<std::size_t>(400, 50); ++i) {
    points.push_back({size * unit(random), size * unit(random), 0.5 * size * unit(random)});
    poses.push_back(
        Motion::from_quaternion({unit(random), unit(random), unit(random), unit(random)},
                                {size * unit(random), size * unit(random), 0.5 * size * unit(random)}));
  }
  const auto items = static_cast<double>(points.size());
  const auto closest = [&](QueriedModel& in) {
    return [&in, &points] {
      double sum = 0;
      for (const Point3& p : points) sum += closest_point(in.scratch, p, {.relative = 1e-3}).distance.upper;
      return sum;
    };
  };
  const auto pair = [&](QueriedModel& in, const auto& ask) {
    return [&in, &poses, &against, ask] {
      double sum = 0;
      for (const Motion& pose : poses) {
        sum += ask(PlacedBvh{in.model, in.scratch, {}}, PlacedBvh{against.model, against.scratch, pose});
      }
      return sum;
    };
  };
  const auto ask_distance = [](const PlacedBvh& a, const PlacedBvh& b) {
    return distance(a, b, {.absolute = {}, .relative = 0.01}).distance.lower;
  };
  const auto ask_contact = [](const PlacedBvh& a, const PlacedBvh& b) {
    return static_cast<double>(collide(a, b, {.tolerance = 1e-3}).verdict);
  };
  const auto against_fresh = [&](const char* what, const auto& of) {
    Group group(std::string(what) + ": " + name + ", " + way.name, "query", options);
    group.add("tree built there", items, of(fresh));
    group.add("tree refitted", items, of(refitted));
    group.run();
  };
  against_fresh("closest point", closest);
  against_fresh("distance", [&](QueriedModel& in) { return pair(in, ask_distance); });
  against_fresh("collide", [&](QueriedModel& in) { return pair(in, ask_contact); });
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 0, "");
  const ControlMesh triangles = irregular_mesh(options.size(10'000, 1'000)),
                    quads = character_mesh(options.size(4'000, 500), 200);
  bench_frames("irregular triangles", triangles, options);
  bench_frames("character", quads, options);
  for (const Way& way : ways()) bench_queries("irregular triangles", triangles, way, options);
  return 0;
}
