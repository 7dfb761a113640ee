// Deviations of extraordinary corners from a few triangles, and from other such surfaces: the precision is
// reached, or the tolerance decided, wherever the budget was not spent.
//
//   SNUG_PLACEMENTS=20000 build/release/bin/tests/sound_test --gtest_filter='*reached*'

#include <snug/distance.h>

#include <gtest/gtest.h>
#include <support/error.h>
#include <testing/candidates.h>
#include <testing/solid_cases.h>
#include <testing/tagged.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snug::deviation_reached_test {
namespace {

using oracle::Point;
using testing::number_of;
using testing::TriangleSet;

constexpr std::array schemes{Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge};
constexpr std::array precisions{1e-2, 2e-3, 1e-3, 2e-4, 1e-4, 1e-5};

/// Around its corners the surface is of valence 3 and more, its faces have three corners and more.
oracle::TaggedMesh shape_of(Scheme scheme, std::mt19937_64& random) {
  namespace meshes = oracle::meshes;
  const auto n = static_cast<std::uint32_t>(3 + random() % 7);
  oracle::TaggedMesh mesh;
  switch (random() % 4) {
    case 0:
      mesh = meshes::pyramid(n);
      break;
    case 1:
      mesh = meshes::prism(n);
      break;
    case 2:
      mesh = meshes::cube();
      break;
    default:
      mesh = meshes::quad_grid(3, 3);
      break;
  }
  if (scheme == Scheme::loop) mesh = meshes::triangulated(mesh);
  const std::array shakes{0.0, 0.1, 0.3};
  return meshes::shaken(mesh, shakes[random() % 3], random);
}

/// Triangles about `size` large, some `away` from a place.
TriangleSet soup_at(const Point& place, double size, double away, std::mt19937_64& random) {
  const auto near = [&](const Point& p, double reach) {
    Point moved = p;
    for (double& x : moved) x += testing::between(random, -reach, reach);
    return moved;
  };
  TriangleSet soup(1 + random() % 8);
  for (oracle::Corners& t : soup) {
    const Point middle = near(place, away);
    for (Point& p : t) p = near(middle, size);
  }
  return soup;
}

struct Reached {
  std::size_t asked = 0, spent = 0, decided = 0;
};

double width(const Interval& d) { return d.upper - d.lower; }

// More effort changes a result that the budget has ended. Much more: an eighth of the budget, and 2^17, is what
// pieces of surfaces are held to.
template <class Candidate>
bool is_spent(const Surface& surface, const Candidate& candidate, const DeviationOptions& options,
              const Run& run, const Deviation& found) {
  const Deviation more = deviation(surface, candidate, options,
                                   {.threads = run.threads, .max_splits = 100 * run.max_splits.value()});
  return more.from_surface.distance != found.from_surface.distance ||
         more.from_candidate.distance != found.from_candidate.distance;
}

template <class Candidate>
Deviation expect_reached(const Surface& surface, const Candidate& candidate, const DeviationOptions& options,
                         const Run& run, const std::string& name, Reached& counts) {
  const Deviation found = deviation(surface, candidate, options, run);
  ++counts.asked;
  bool answered = true;
  for (const Interval& d : {found.from_surface.distance, found.from_candidate.distance}) {
    const bool decided = options.threshold && (d.lower > *options.threshold || d.upper <= *options.threshold);
    answered = answered && (decided || width(d) <= *options.absolute);
    counts.decided += decided;
  }
  EXPECT_EQ(found.outcome == Outcome::complete, answered) << name;
  if (answered) return found;
  const bool spent = is_spent(surface, candidate, options, run, found);
  counts.spent += spent;
  EXPECT_TRUE(spent) << name << ": " << width(found.from_surface.distance) << " and "
                     << width(found.from_candidate.distance) << " for " << *options.absolute;
  return found;
}

// First how far, then whether farther than a tolerance near that.
template <class Candidate>
void check(const Surface& surface, const Candidate& candidate, double precision, const std::string& name,
           std::mt19937_64& random, Reached& counts) {
  DeviationOptions options;
  const Run run{.threads = 1, .max_splits = 50'000};
  options.absolute = precision * surface.size();
  const Deviation found = expect_reached(surface, candidate, options, run, name, counts);
  constexpr std::array factors{0.5, 0.99, 0.999, 1.001, 1.01};
  options.threshold = factors[random() % factors.size()] *
                      std::max(found.from_surface.distance.upper, found.from_candidate.distance.upper);
  expect_reached(surface, candidate, options, run, name + ", tolerance", counts);
}

TEST(deviation, of_extraordinary_corners_is_reached_unless_the_budget_is_spent) {
  const std::uint64_t trials = number_of("SNUG_PLACEMENTS", 200), first = number_of("SNUG_FIRST", 0);
  Reached counts;
  constexpr std::array sizes{0.01, 0.1, 0.5, 2.0}, aways{0.0, 0.1, 1.0, 3.0};
  testing::PairsDrawn pairs({schemes.size(), precisions.size(), sizes.size(), aways.size()});
  for (std::uint64_t i = first; i < first + trials && !HasFatalFailure(); ++i) {
    std::mt19937_64 random(i * 9973 + 17);
    const std::size_t scheme = i % schemes.size(), precision = i / schemes.size() % precisions.size(),
                      size = random() % sizes.size(), away = random() % aways.size();
    const oracle::TaggedMesh mesh = shape_of(schemes[scheme], random);
    const Surface surface(testing::control_mesh(mesh), {.scheme = schemes[scheme]});
    pairs.add({scheme, precision, size, away});
    const std::string name = "trial " + std::to_string(i) + ", " + name_of(schemes[scheme]);
    if (i % 5 == 0) {
      const Scheme other = schemes[random() % schemes.size()];
      oracle::TaggedMesh star = shape_of(other, random);
      for (Point& p : star.points)
        p = {sizes[size] * p[0] + aways[away], sizes[size] * p[1], sizes[size] * p[2]};
      check(surface, Surface(testing::control_mesh(star), {.scheme = other}), precisions[precision], name,
            random, counts);
      continue;
    }
    const TriangleSet soup =
        soup_at(mesh.points[random() % mesh.points.size()], sizes[size], aways[away], random);
    check(surface, testing::candidate_of(soup), precisions[precision], name, random, counts);
  }
  std::cout << "  " << counts.asked << " questions, " << counts.decided
            << " distances decided by a tolerance; " << counts.spent << " budgets spent; " << pairs.missing()
            << " pairs of choices not drawn\n";
  EXPECT_LE(20 * counts.spent, counts.asked);
}

}  // namespace
}  // namespace snug::deviation_reached_test
