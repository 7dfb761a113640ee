// The promises of closest_point, against a twin that refines by itself: points near, on and far from
// surfaces, at centres of curvature and at control points.
//
//   SNUG_PLACEMENTS=100000 build/release/bin/tests/sound_test --gtest_filter=closest.points_are_the_nearest

#include <snug/distance.h>
#include <snug/evaluate.h>

#include <gtest/gtest.h>
#include <oracle/hausdorff_twin.h>
#include <oracle/test_meshes.h>
#include <testing/contact_trials.h>
#include <testing/surfaces.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace snug::closest_test {
namespace {

using oracle::ContactBounds;
using oracle::ContactGoal;
using oracle::Point;
using testing::Contestants;
using testing::Trial;

double between(const Point& p, const Point& q) { return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]); }

Point random_point(Trial& trial, Contestants& pair) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const oracle::TwinMesh& mesh = pair.mesh(0);
  const auto on_surface = [&] {
    for (;;) {
      const auto face = static_cast<std::uint32_t>(trial.random() % mesh.triangles.size());
      const double u = std::abs(unit(trial.random)), v = (1 - u) * std::abs(unit(trial.random));
      try {
        return pair.twin(0).limit_point(face, trial.random() % 4 == 0 ? 0 : u, v);
      } catch (const std::invalid_argument&) {  // a face without a surface
      }
    }
  };
  switch (trial.random() % 6) {
    case 0:  // on the surface, up to roundings
      return on_surface();
    case 1: {  // a hair off
      Point p = on_surface();
      p[trial.random() % 3] += std::ldexp(unit(trial.random), -static_cast<int>(trial.random() % 45));
      return p;
    }
    case 2: {
      const double far = std::pow(10.0, 6 * std::abs(unit(trial.random)));
      return {far * unit(trial.random), far * unit(trial.random), far * unit(trial.random)};
    }
    case 3:
      return mesh.points[trial.random() % mesh.points.size()];
    case 4:
      return {0, 0, 0};
    default:
      return {2 * unit(trial.random), 2 * unit(trial.random), 2 * unit(trial.random)};
  }
}

TEST(closest, points_are_the_nearest) {
  const std::uint64_t first = testing::first_trial(), count = testing::trial_count(800);
  constexpr int max_failures = 20;
  int failures = 0;
  std::size_t reached = 0, asked = 0, open = 0, approximate = 0;
  double seconds = 0, slowest = 0;
  std::uint64_t slowest_trial = 0;
  testing::Trials trials;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; i < count && failures < max_failures; ++i) {
    Trial trial = trials.make(first + i);
    Contestants& pair = *trial.pair;
    const double size = pair.size();
    const Point to = random_point(trial, pair);
    const Point3 scaled{pair.scaled(to[0]), pair.scaled(to[1]), pair.scaled(to[2])};
    Precision options{.absolute = 0, .relative = 0};
    const std::uint64_t choice = trial.random() % 6;
    if (choice < 3) options.relative = choice == 0 ? 1e-9 : choice == 1 ? 1e-6 : 1e-2;
    if (choice >= 2 && choice < 5)
      options.absolute =
          pair.scaled(size * (choice == 2   ? 1e-3
                              : choice == 3 ? std::pow(10.0, -2 - static_cast<double>(trial.random() % 5))
                                            : 1e-9));
    const bool exact = trial.random() % 3 != 0;
    options.witness = exact ? WitnessKind::exact : WitnessKind::approximate;
    const snug::Run run{.max_splits = choice == 5 ? 500 : 3000};
    const auto before = std::chrono::steady_clock::now();
    const ClosestPoint answer = closest_point(pair.surface(0), scaled, options, run);
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    seconds += took;
    if (took > slowest) slowest = took, slowest_trial = trial.number;
    ++asked;
    reached += (answer.outcome == Outcome::complete);

    const double lower = pair.back(answer.distance.lower), upper = pair.back(answer.distance.upper),
                 error = pair.back(answer.error);
    const Point point = pair.back(answer.point);
    const auto expect = [&](bool holds, const char* claim, double found, double bound) {
      if (holds) return;
      ++failures;
      char numbers[300];
      std::snprintf(numbers, sizeof numbers,
                    " (%.17g, %.17g): [%.17g, %.17g] to (%.17g %.17g %.17g) face %u u %.17g v %.17g; ", found,
                    bound, lower, upper, to[0], to[1], to[2], answer.at->owner, answer.at->u, answer.at->v);
      ADD_FAILURE() << claim << numbers << testing::describe(trial);
    };
    const double coordinates = std::max({size, std::abs(to[0]), std::abs(to[1]), std::abs(to[2])});
    const double rounding = 0x1p-50 * coordinates;
    expect(lower >= 0 && lower <= upper && std::isfinite(upper), "an interval", lower, upper);
    if (answer.outcome == Outcome::complete) {
      const double width =
          std::max(pair.back(options.absolute.value_or(0)), options.relative.value_or(0) * upper);
      expect(upper - lower <= width * (1 + 1e-12) + 1e-300, "reached is reached", upper - lower, width);
    }
    if (exact) {
      expect(between(point, to) <= upper * (1 + 1e-12) + rounding, "the point is at most upper away",
             between(point, to), upper);
    }
    // The same place by the twin: the face, the parameter and the point belong together.
    expect(answer.at->u >= 0 && answer.at->v >= 0 && answer.at->u + answer.at->v <= 1, "a parameter",
           answer.at->u, answer.at->v);
    const Point same = pair.twin(0).limit_point(answer.at->owner, answer.at->u, answer.at->v);
    expect(between(same, point) <= 2 * error + 1e-12 * size, "face, u and v are those of the point",
           between(same, point), error);
    expect(between(same, to) <= upper * (1 + 1e-12) + rounding + 1e-12 * size, "the limit point is, too",
           between(same, to), upper);
    if (exact) {
      expect(between(same, point) <= 1e-9 * size, "the point is on the surface", between(same, point), size);
    }
    approximate += error > 1e-9 * size;
    ContactGoal goal;
    goal.effort = 3000;
    goal.precision = {1e-14 * size, trial.number % 10 == 3 ? 1e-9 : 1e-3};
    if (lower > 0) {
      goal.threshold = lower;
      const ContactBounds found = pair.twin(0).distance_to(oracle::kUnmoved, to, goal);
      expect(found.upper >= lower - 2 * rounding, "the twin finds a nearer point", found.upper, lower);
      open += found.spent;
    }
    if ((i + 1) % 20'000 == 0)
      std::fprintf(stderr, "%llu points, %.0f s\n", static_cast<unsigned long long>(i + 1),
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::printf(
      "  %zu points, %zu reached, %.3f ms each, slowest %.0f ms (trial %llu); %zu points approximate; the "
      "twin left %zu open\n",
      asked, reached, 1e3 * seconds / static_cast<double>(asked), 1e3 * slowest,
      static_cast<unsigned long long>(slowest_trial), approximate, open);
  EXPECT_GE(reached * 10, asked * 6);
  EXPECT_GE(approximate * 20, asked);
}

// Single precision says less of points far away; what was asked for is reached all the same, without many splits.
TEST(closest, of_points_some_sizes_away_is_as_narrow_as_asked) {
  std::mt19937_64 random(17);
  const Surface surface = testing::public_surface(
      oracle::meshes::disturbed(oracle::meshes::quartered(oracle::meshes::icosahedron()), 9, 0.2, random));
  for (int exponent = 0; exponent < 96; ++exponent) {
    const double far = std::exp2(exponent / 4.0) * surface.size() / 2;
    for (const Point3& way : {Point3{1, 1, 1}, {-1, 0.3, 0.7}, {0, 0, 1}}) {
      const Point3 to{far * way.x, far * way.y, far * way.z};
      for (const double share : {0.0, 1e-1, 1e-2, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5}) {
        Precision precision;
        if (share > 0) precision.absolute = share * surface.size();
        const ClosestPoint found = closest_point(surface, to, precision, {.max_splits = 100});
        EXPECT_EQ(found.outcome, Outcome::complete) << exponent << ", " << share;
      }
    }
  }
}

// Plane quads that are no parallelograms, against their halves: no part of one need be split for its set, but points lie elsewhere
// than in a triangle.
TEST(closest, of_plane_quads_is_as_narrow_as_asked) {
  std::mt19937_64 random(5);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  constexpr double rounding = 1e-13;  // of corners that lie in one plane
  for (int quad = 0; quad < 40; ++quad) {
    const Point3 apex{unit() - 0.5, 1 + unit(), unit()};
    const double left = 0.1 + 0.8 * unit(), right = 0.1 + 0.8 * unit();
    const Point3 a{-1, 0, 0}, b{1, 0, quad % 2 == 0 ? 0.0 : unit()};
    ControlMesh mesh;
    mesh.points = {a, b, b + right * (apex - b), a + left * (apex - a)};
    mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2), VertexId(3)});
    const Surface surface(mesh, {.scheme = Scheme::bilinear});
    const auto corner = [&](std::size_t v) {
      return Point{mesh.points[v].x, mesh.points[v].y, mesh.points[v].z};
    };
    const std::vector<oracle::Corners> halves{{corner(0), corner(1), corner(2)},
                                              {corner(0), corner(2), corner(3)}};
    for (int k = 0; k < 20; ++k) {
      const Point3 to{3 * unit() - 1.5, 3 * unit() - 1, k % 4 == 0 ? 0 : unit() - 0.5};
      for (const WitnessKind witness : {WitnessKind::exact, WitnessKind::approximate}) {
        for (const double absolute : {1e-1, 1e-2, 1e-4, 1e-6, 1e-9}) {
          const ClosestPoint found =
              closest_point(surface, to, {.absolute = absolute, .witness = witness}, {.max_splits = 2000});
          const std::string where =
              std::to_string(quad) + ", " + std::to_string(k) + ", " + std::to_string(absolute);
          EXPECT_EQ(found.outcome, Outcome::complete) << where;
          // Quads are facets: no more is left open however little is asked for.
          EXPECT_LE(found.distance.upper - found.distance.lower, std::min(absolute, 2 * rounding)) << where;
          const oracle::HausdorffBounds truth = oracle::distance_to_triangles({to.x, to.y, to.z}, halves);
          EXPECT_LE(found.distance.lower, static_cast<double>(truth.upper) + rounding) << where;
          EXPECT_GE(found.distance.upper, static_cast<double>(truth.lower) - rounding) << where;
          const Point3 there = evaluate(surface, *found.at).point;
          EXPECT_LE(max_abs(there - found.point), found.error + rounding) << where;
          EXPECT_LE(distance(there, to), found.distance.upper + rounding) << where;
          EXPECT_LE(distance(found.point, to), found.distance.upper + rounding) << where;
        }
      }
    }
  }
}

// Many points at once, in any number of threads: bit for bit what each gives alone.
TEST(closest, many_in_threads_are_the_same_as_one_by_one) {
  testing::Trials trials;
  std::uint64_t number = 0;
  for (int surface = 0; surface < 12; ++surface) {
    Trial trial = trials.make(number);
    while (trial.family != "random" && trial.family != "shells") trial = trials.make(++number);
    ++number;
    Contestants& pair = *trial.pair;
    std::vector<Point3> to;
    for (int k = 0; k < 60; ++k) {
      const Point p = random_point(trial, pair);
      to.push_back({pair.scaled(p[0]), pair.scaled(p[1]), pair.scaled(p[2])});
    }
    Precision options{.absolute = 0, .relative = 0};
    options.relative = 1e-6;
    options.absolute = pair.scaled(1e-9 * pair.size());
    for (const int threads : {1, 3}) {
      const std::vector<ClosestPoint> all = closest_point(pair.surface(0), to, options, {.threads = threads});
      ASSERT_EQ(all.size(), to.size());
      for (std::size_t k = 0; k < to.size(); ++k) {
        Workspace fresh;
        const ClosestPoint one = closest_point(pair.surface(0), to[k], options, {.workspace = &fresh});
        EXPECT_EQ(all[k].distance.lower, one.distance.lower);
        EXPECT_EQ(all[k].distance.upper, one.distance.upper);
        EXPECT_EQ(all[k].point, one.point);
        EXPECT_EQ(all[k].at->owner, one.at->owner);
        EXPECT_EQ(all[k].at->u, one.at->u);
        EXPECT_EQ(all[k].at->v, one.at->v);
      }
    }
  }
}

}  // namespace
}  // namespace snug::closest_test
