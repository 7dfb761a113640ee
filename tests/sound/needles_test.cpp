// Needles, flat and nearly flat surfaces a hair apart or through each other, in exact arithmetic: rows and
// tables of both layouts, all schemes, moved and not.
//
//   SNUG_PLACEMENTS=40000 build/release/bin/tests/sound_test --gtest_filter='needles.*'
//
// runs 4,000 of each; a placement takes some 10 ms.

#include <snug/distance.h>

#include <gtest/gtest.h>
#include <testing/counts.h>
#include <testing/six_sheets.h>
#include <testing/tagged.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "testing/verdict_only.h"

namespace snug::needles_test {
namespace {

using Whole = std::array<std::int64_t, 3>;

std::size_t trial_count(std::size_t usual) { return testing::number_of("SNUG_PLACEMENTS", 10 * usual) / 10; }

// Columns of a whole-numbered matrix of determinant 1, by random steps; the longer they are, the thinner the
// needles. The first row of the inverse is a plane that columns 1 and 2 lie in and column 0 is one step away
// from.
struct Lattice {
  std::array<Whole, 3> column{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

  Lattice(std::mt19937_64& random, std::int64_t most) {
    for (int step = 0; step < 400; ++step) {
      const std::size_t to = random() % 3, from = (to + 1 + random() % 2) % 3;
      const std::int64_t times = static_cast<std::int64_t>(random() % 5) - 2;
      Whole sum;
      bool fits = true;
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] = column[to][k] + times * column[from][k];
        fits = fits && std::llabs(sum[k]) <= most;
      }
      if (fits) column[to] = sum;
    }
  }
  // Distance of the planes of two neighbouring layers, but for some roundings.
  [[nodiscard]] double layer() const {
    const auto at = [&](std::size_t c, std::size_t k) { return static_cast<long double>(column[c][k]); };
    long double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const long double minor = at(1, i) * at(2, j) - at(1, j) * at(2, i);  // exact: below 2^63
      sum += minor * minor;
    }
    return static_cast<double>(1 / std::sqrt(sum));
  }
  [[nodiscard]] Point3 point(std::int64_t layer, std::int64_t i, std::int64_t j) const {
    Point3 p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = static_cast<double>(layer * column[0][k] + i * column[1][k] + j * column[2][k]);
    }
    return p;
  }
};

// A grid of quads or triangles, at places on and between the lattice's; `layer` says how high each vertex is.
template <class Layer>
ControlMesh grid(const Lattice& lattice, Scheme scheme, std::int64_t origin, std::int64_t step,
                 std::uint32_t cells, const Layer& layer) {
  ControlMesh mesh;
  for (std::uint32_t j = 0; j <= cells; ++j) {
    for (std::uint32_t i = 0; i <= cells; ++i) {
      mesh.points.push_back(lattice.point(layer(i, j), origin + step * i, origin + step * j));
    }
  }
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t v = j * (cells + 1) + i;
      const VertexId a(v), b(v + 1), c(v + cells + 2), d(v + cells + 1);
      if (scheme != Scheme::loop && (i + j) % 3 != 0) {
        mesh.add_face(std::array{a, b, c, d});
      } else {  // polygons beside quads, too
        mesh.add_face(std::array{a, b, c});
        mesh.add_face(std::array{a, c, d});
      }
    }
  }
  return mesh;
}

struct Setting {
  SurfaceOptions options;
  Motion motion;  // of whole numbers
  Lattice lattice;
  std::string text;

  Setting(std::mt19937_64& random, std::size_t trial, const std::vector<Scheme>& schemes)
      : options{.scheme = schemes[random() % schemes.size()]},
        lattice(random, std::int64_t{1} << (2 + random() % 24)) {
    // Half of them so thin, and layers so near to each other, that they are a hair beside the rounding of
    // base triangles.
    for (int attempt = 0; trial % 2 == 0 && attempt < 40; ++attempt) {
      const std::int64_t most = std::int64_t{1} << (20 + random() % 7);
      lattice = Lattice(random, most);
      const double hair = 0x1p-53 * static_cast<double>(most);
      if (lattice.layer() < 64 * hair && lattice.layer() > hair / 64) break;
    }
    options.tight = random() % 3 == 0;
    if (random() % 3 != 0) options.bounds = BoundMethod::table;
    const auto whole = [&] {
      return static_cast<double>(static_cast<std::int64_t>(random() % 2'000'001) - 1'000'000);
    };
    if (random() % 2) {
      const std::array<Vector3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
      motion = Motion::rotation_degrees(axes[random() % 3], 90.0 * static_cast<double>(random() % 4));
      motion = motion.with_offset({whole(), whole(), whole()});
    }
    text = "trial " + std::to_string(trial) + ", " + name_of(*options.scheme) +
           (options.bounds == BoundMethod::table ? ", tables" : ", rows") + (options.tight ? ", tight" : "") +
           ", layer " + std::to_string(lattice.layer());
  }
};

// One surface lies in layers 0 and below, the other in 1 and above: they are at least a layer apart.
TEST(needles, in_layers_apart_are_never_called_intersecting) {
  std::mt19937_64 random(71);
  const Surface first(testing::six_sheets(1));  // keeps the bounds that all of them share
  std::size_t separated = 0;
  const std::size_t count = trial_count(180);
  for (std::size_t trial = 0; trial < count; ++trial) {
    const Setting here(random, trial,
                       {Scheme::loop, Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge});
    const std::int64_t deep = random() % 3 == 0 ? 0 : std::int64_t{1} << random() % 12;  // 0: flat
    const auto some = [&](std::uint32_t, std::uint32_t) {
      return deep == 0 || random() % 4 == 0
                 ? 0
                 : static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(deep));
    };
    const std::int64_t shift = static_cast<std::int64_t>(random() % 3);
    // Half of them small over the middle of the other one.
    const std::int64_t step = random() % 2 ? 1 : 16;
    const Surface a(grid(here.lattice, *here.options.scheme, step == 1 ? 0 : -2 * step, step, 4,
                         [&](auto i, auto j) { return -some(i, j); }),
                    here.options),
        b(grid(here.lattice, *here.options.scheme, shift, 1, 4,
               [&](auto i, auto j) { return 1 + some(i, j); }),
          here.options);
    const PlacedSurface at_a = a.at(here.motion), at_b = b.at(here.motion);
    const double layer = here.lattice.layer() * (1 - 1e-12);
    CollideOptions options = testing::verdict_only();
    options.prove_contact = true;
    if (random() % 2)
      options.tolerance = here.lattice.layer() * std::exp2(static_cast<double>(random() % 12) - 4);
    const Collision collision = collide(at_a, at_b, options, {.max_splits = 2000});
    ASSERT_NE(collision.verdict, Verdict::intersecting) << here.text;
    if (std::isfinite(collision.distance.upper)) {
      ASSERT_GE(collision.distance.upper, layer) << here.text;
    }
    if (collision.verdict == Verdict::within) {
      ASSERT_GE(options.tolerance, layer) << here.text;
    }
    separated += collision.verdict == Verdict::separated;
    DistanceOptions how;
    how.relative = 1e-3;
    const Distance found = distance(at_a, at_b, how, {.max_splits = 2000});
    ASSERT_LE(found.distance.lower, found.distance.upper) << here.text;
    ASSERT_GE(found.distance.upper, layer) << here.text;
    // From a vertex of A, which is no nearer than a layer to B.
    const ClosestPoint closest = closest_point(b, a.mesh().points[random() % 25],
                                               {.absolute = {}, .relative = 1e-3}, {.max_splits = 2000});
    ASSERT_GE(closest.distance.upper, layer) << here.text;
    ASSERT_LE(closest.distance.lower, closest.distance.upper) << here.text;
  }
  EXPECT_GT(separated, count / 3);
}

// A flat surface in layer 0 whose sharp border is wide around the other one, which goes from below layer 0 to
// above it.
TEST(needles, through_each_other_are_never_called_apart) {
  std::mt19937_64 random(72);
  const Surface first(testing::six_sheets(1));  // keeps the bounds that all of them share
  std::size_t intersecting = 0;
  const std::size_t count = trial_count(180);
  for (std::size_t trial = 0; trial < count; ++trial) {
    const Setting here(random, trial, {Scheme::loop, Scheme::catmark});
    const std::int64_t deep = std::int64_t{1} << random() % 12;
    const Surface a(grid(here.lattice, *here.options.scheme, -2, 2, 4, [](auto, auto) { return 0; }),
                    here.options);
    // Two of its corners belong to one face each: they are points of the limit surface.
    const Surface b(grid(here.lattice, *here.options.scheme, 0, 1, 4,
                         [&](std::uint32_t i, std::uint32_t j) {
                           return i == 4 && j == 0   ? -deep
                                  : i == 0 && j == 4 ? deep
                                                     : static_cast<std::int64_t>(random() % 3) - 1;
                         }),
                    here.options);
    const PlacedSurface at_a = a.at(here.motion), at_b = b.at(here.motion);
    CollideOptions options = testing::verdict_only();
    const Collision collision = collide(at_a, at_b, options, {.max_splits = 2000});
    ASSERT_NE(collision.verdict, Verdict::separated) << here.text;
    ASSERT_EQ(collision.distance.lower, 0) << here.text;
    intersecting += collision.verdict == Verdict::intersecting;
    DistanceOptions how;
    how.relative = 1e-3;
    ASSERT_EQ(distance(at_a, at_b, how, {.max_splits = 2000}).distance.lower, 0) << here.text;
    // Corners of B, which are limit points of it: their distance is 0.
    const std::size_t corner = random() % 2 ? 4 : 20;
    const ClosestPoint at_corner =
        closest_point(b, b.mesh().points[corner], {.absolute = {}, .relative = 1e-3}, {.max_splits = 2000});
    ASSERT_EQ(at_corner.distance.lower, 0) << here.text;
  }
  EXPECT_GE(intersecting, count / 25);
}

}  // namespace
}  // namespace snug::needles_test
