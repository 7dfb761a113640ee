#include <snug/query/tessellate.h>

#include <gtest/gtest.h>
#include <snug/surface/evaluate.h>
#include <testing/counts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace snug::local_tessellation_test {
namespace {

// Each triangle is as near as is said of it alone, also where neighbours with other tolerances had it split: ridges along a
// semi-sharp crease, where a half may be farther from the surface than the whole was.
TEST(local_tessellation, holds_the_error_of_every_triangle_where_tolerances_differ) {
  constexpr std::uint32_t n = 6, middle = 3;
  std::mt19937_64 random(1);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  std::size_t triangles = 0, beyond = 0, smaller = 0;
  for (std::size_t trial = 0; trial < testing::fewer(16); ++trial) {
    const bool loop = trial % 2 == 1;
    ControlMesh mesh;
    std::array<double, n + 1> height{};
    const double bend = -0.8 * std::fabs(unit());
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) - middle;
      height[i] = 0.3 * (std::fabs(x) + 0.5 * bend * x * x + 0.05 * unit());
    }
    for (std::uint32_t j = 0; j <= n; ++j) {
      for (std::uint32_t i = 0; i <= n; ++i) mesh.points.push_back({1.0 * i, 1.0 * j, height[i]});
    }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return VertexId(j * (n + 1) + i); };
    for (std::uint32_t j = 0; j < n; ++j) {
      for (std::uint32_t i = 0; i < n; ++i) {
        const VertexId a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        if (loop) {
          mesh.add_face(std::array{a, b, c});
          mesh.add_face(std::array{a, c, d});
        } else {
          mesh.add_face(std::array{a, b, c, d});
        }
      }
    }
    const double sharpness = 1 + 0.25 * static_cast<double>(random() % 13);
    for (std::uint32_t k = 0; k < n; ++k)
      mesh.tags.creases.push_back({at(middle, k), at(middle, k + 1), sharpness});
    const Scheme scheme = loop ? Scheme::loop : Scheme::catmark;
    const LimitSurface surface(mesh, with_tags({scheme}, mesh.tags), std::make_shared<BoundsCache>());
    for (int round = 0; round < 6; ++round) {
      std::vector<double> tolerances(surface.owner_count());
      for (double& tolerance : tolerances) tolerance = 0.1 * std::pow(10, -1.5 * std::fabs(unit()));
      LocalTolerances local_tolerances(surface, tolerances);
      // In half of the rounds smaller ones around some places, by pieces of several sizes.
      for (std::size_t k = 0; k < (round % 2 == 0 ? 0u : 5u); ++k) {
        const PatchId patch(random() % surface.patch_count());
        if (!surface.has_patch(patch)) continue;
        const double size = std::ldexp(1.0, -static_cast<int>(random() % 5)),
                     u = size * std::floor(0.5 / size);
        local_tolerances.mark({patch, {{{u, 0}, {u + size, 0}, {u, size}}}}, 1e-3, 1);
        local_tolerances.refine();
      }
      TessellateOptions options;
      options.corners = true;
      // Every third time the budget ends it: errors beyond the tolerances are as true.
      const bool ended = round % 3 == 2;
      const LocalTessellation local =
          tessellate(surface, local_tolerances, options, {.max_splits = ended ? 100u : 1'000'000u});
      const Tessellation& t = local.mesh;
      const std::vector<double>& errors = local.errors;
      EXPECT_EQ(t.outcome, ended ? Outcome::budget_spent : Outcome::complete);
      triangles += t.triangles.size();
      beyond += static_cast<std::size_t>(
          std::count_if(errors.begin(), errors.end(), [](double error) { return error > 0.1; }));
      for (std::size_t i = 0; i < t.triangles.size(); ++i) {
        const double allowed = local_tolerances.of(local.parts[i]);
        EXPECT_LE(allowed, tolerances[t.owners[i]]);
        smaller += allowed < tolerances[t.owners[i]] ? 1 : 0;
        EXPECT_LE(errors[i], ended ? 10 : allowed * (1 + 1e-12));
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_EQ(place_of(surface, local.parts[i].patch, local.parts[i].at[k]), t.corners[i][k]);
        for (int k = 0; k <= 8; ++k) {
          for (int l = 0; k + l <= 8; ++l) {
            const double w = (8 - k - l) / 8.0, u = k / 8.0, v = l / 8.0;
            const auto& [a, b, c] = t.corners[i];
            Place place = a;
            place.u = w * a.u + u * b.u + v * c.u;
            place.v = w * a.v + u * b.v + v * c.v;
            const LimitPoint limit = evaluate(surface, place);
            const auto corner = [&](std::size_t m) { return t.positions[t.triangles[i][m]] - Point3{}; };
            const Point3 flat = Point3{} + (w * corner(0) + u * corner(1) + v * corner(2));
            ASSERT_LE(distance(flat, limit.point), errors[i] + 2 * limit.error + 1e-12)
                << trial << ", " << round << ", triangle " << i;
          }
        }
      }
    }
  }
  EXPECT_GT(triangles, testing::fewer(5'000));
  EXPECT_GT(beyond, testing::fewer(20));
  EXPECT_GT(smaller, testing::fewer(200));
}

}  // namespace
}  // namespace snug::local_tessellation_test
