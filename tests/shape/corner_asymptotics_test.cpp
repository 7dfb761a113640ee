// Upper bounds of the areas of patches hold for control points anywhere.

#include <snug/shape/corner_asymptotics.h>

#include <gtest/gtest.h>
#include <snug/patch/limit_evaluator.h>
#include <testing/scheme_surfaces.h>

#include <cmath>
#include <iostream>
#include <random>
#include <set>

namespace snug::corner_asymptotics_test {
namespace {

// Area of triangles between limit points of a patch, or of a quad that it is half of: near the true one.
double sampled_area(const Patch& patch) {
  constexpr std::size_t n = 24;
  const bool triangular = patch.kind->rules().triangular();
  LimitEvaluator evaluator(patch);
  std::vector<Point3> grid((n + 1) * (n + 1));
  for (std::size_t j = 0; j <= n; ++j) {
    for (std::size_t i = 0; i <= (triangular ? n - j : n); ++i) {
      const Place at{0, 0, static_cast<double>(i) / n, static_cast<double>(j) / n};
      grid[i + (n + 1) * j] = evaluator.frame(at).point.from({}).position;
    }
  }
  double area = 0;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    area += 0.5 * length(cross(grid[b] - grid[a], grid[c] - grid[a]));
  };
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < (triangular ? n - j : n); ++i) {
      const std::size_t a = i + (n + 1) * j;
      add(a, a + 1, a + n + 1);
      if (!triangular || i + j + 1 < n) add(a + 1, a + n + 2, a + n + 1);
    }
  }
  return area;
}

TEST(corner_asymptotics, bound_the_areas_of_patches) {
  std::mt19937_64 random(11);
  std::size_t kinds = 0;
  double largest = 0;
  testing::for_each_surface(7, [&](const testing::NamedSurface& named) {
    SCOPED_TRACE(named.name);
    std::set<const Kind*> seen;
    testing::for_each_patch(named.surface, [&](PatchId p) {
      Patch patch = named.surface.patch(p);
      if (!seen.insert(patch.kind).second) return;
      ++kinds;
      const double factor = asymptotics_of(*patch.kind).area_factor();
      ASSERT_LT(factor, 1e4) << patch.kind->key().polygon;
      for (int trial = 0; trial < 2; ++trial) {
        // Corners of a cube, at random: no point is in the middle of others.
        for (Vector3& point : patch.points) {
          for (std::size_t a = 0; a < 3; ++a) point[a] = random() % 2 == 0 ? 0 : 1;
        }
        patch.error = 0;
        patch.largest = 1;
        const double area = sampled_area(patch);
        EXPECT_LE(area, factor * 3);
        largest = std::max(largest, area / (3 * factor));
      }
    });
  });
  std::cout << kinds << " kinds, at most " << largest << " of the bound\n";
}

}  // namespace
}  // namespace snug::corner_asymptotics_test
