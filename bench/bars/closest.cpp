#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include <snug/surface/evaluate.h>
#include <support/error.h>

#include "bars.h"
#include "peers.h"
#if defined(SNUG_BENCH_EMBREE) && defined(SNUG_BENCH_FCL)
#include "peer_embree.h"
#endif

namespace snug::bench {
namespace {

constexpr double near_reach = 0.01;

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

std::vector<Point3> in_box(const Box3& box, std::size_t count) {
  std::mt19937_64 random(21);
  std::vector<Point3> points(count);
  for (Point3& p : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = 0.5 * (box.lower[k] + box.upper[k] + (box.upper[k] - box.lower[k]) * unit(random));
    }
  }
  return points;
}

// Limit points of faces taken at random, moved by up to 1 % of the size along each axis.
std::vector<Point3> near_surface(const LimitSurface& surface, std::size_t count) {
  std::mt19937_64 random(22);
  SurfaceEvaluator evaluator(surface);
  std::vector<Point3> points(count);
  for (Point3& p : points) {
    const auto face = static_cast<std::uint32_t>(random() % surface.face_count());
    const double u = 0.5 * (1 + unit(random)), v = (1 - u) * 0.5 * (1 + unit(random));
    p = evaluator({face, 0, u, v}).point;
    for (std::size_t k = 0; k < 3; ++k) p[k] += near_reach * unit(random);
  }
  return points;
}

// Least ratios, with limit points and with approximate ones.
struct Goals {
  double exact, approximate;
};

void add_points(const Model& model, const char* where, const Goals& goals, PointQueries& queries,
                const std::vector<Point3>& points, const Options& options, BarTable& table) {
  const auto items = static_cast<double>(points.size());
  Group group("closest point 0.1 %, " + model.name + ", " + where, "point", options);
  for (const auto& [name, witness] : {std::pair("snug", WitnessKind::exact),
                                      std::pair("snug, approximate points", WitnessKind::approximate)}) {
    group.add(name, items, [&, witness = witness] {
      double sum = 0;
      for (const Point3& p : points) sum += queries.closest(p, distance_precision, witness).distance.upper;
      return sum;
    });
  }
#if defined(SNUG_BENCH_EMBREE) && defined(SNUG_BENCH_FCL)
  const EmbreeMesh mesh(uniform_mesh(model, collide_tolerance));
  group.add("Embree, mesh of 1 %", items, [&] {
    double sum = 0;
    for (const Point3& p : points) sum += mesh.distance(p);
    return sum;
  });
  const std::vector<Times> times = group.run();
  const std::string row = std::string("closest point 0.1 %, ") + where,
                    what = "Embree on the mesh of 1 % over snug";
  table.at_least(row, what, goals.exact, model.name, ratio(times[2], times[0]));
  table.at_least(row + ", approximate", what, goals.approximate, model.name, ratio(times[2], times[1]));
  double most = 0;
  for (const Point3& p : points) {
    most =
        std::max(most, std::fabs(queries.closest(p, distance_precision).distance.upper - mesh.distance(p)));
  }
  std::printf("# the two distances differ by %.5f at most\n", most);
#else
  static_cast<void>(goals), static_cast<void>(table);
  group.run();
#endif
}

}  // namespace

void closest_bars(const std::vector<ModelPair>& pairs, const Options& options, BarTable& table) {
  const auto count = options.size<std::size_t>(5'000, 500);
  SurfaceBvhOptions tight;
  tight.tight = true;
  for (const Model* model : models_of(pairs)) {
    const LimitSurface surface(model->mesh, loop_rules(), std::make_shared<BoundsCache>());
    PointQueries queries(surface, tight);
    add_points(*model, "in the box", {1.1, 1.1}, queries, in_box(used_box(model->mesh), count), options,
               table);
    add_points(*model, "near the surface", {0.8, 1.3}, queries, near_surface(surface, count), options, table);
  }
#if !defined(SNUG_BENCH_EMBREE) || !defined(SNUG_BENCH_FCL)
  table.missing("closest point 0.1 %", "Embree 3 is not installed");
#endif
}

}  // namespace snug::bench
