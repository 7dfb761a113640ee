// Stars of pieces: smooth ones are injective, folded and doubled ones are never said to be.

#include <snug/patch/star.h>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <snug/surface/level_complex.h>
#include <testing/tagged.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace snug {
namespace {

// A disc of triangles around vertex 0, two rings of them, lifted by `height(x, y)`; the inner ring's angles
// are multiplied by `turns`.
oracle::TaggedMesh disc(std::uint32_t n, double turns, const std::function<double(double, double)>& height) {
  oracle::TaggedMesh mesh;
  mesh.points.push_back({0, 0, height(0, 0)});
  for (std::uint32_t ring = 1; ring <= 3; ++ring) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = turns * 2 * std::numbers::pi * i / n;
      const double x = ring * std::cos(angle), y = ring * std::sin(angle);
      mesh.points.push_back({x, y, height(x, y)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t k = (i + 1) % n;
    mesh.polygons.push_back({0, 1 + i, 1 + k});
    for (std::uint32_t ring = 0; ring < 2; ++ring) {
      const std::uint32_t a = 1 + ring * n;
      mesh.polygons.push_back({a + i, a + n + i, a + n + k});
      mesh.polygons.push_back({a + i, a + n + k, a + k});
    }
  }
  return mesh;
}

// Is the star of vertex 0 proved to be injective, after some levels?
bool injective_at_centre(const oracle::TaggedMesh& mesh, unsigned level) {
  const LimitSurface surface(testing::control_mesh(mesh), {Scheme::loop}, std::make_shared<BoundsCache>());
  const LevelComplex complex(surface);
  PieceName piece{0};
  for (unsigned k = 0; k < level; ++k) piece = piece.child(0);
  const LevelStar star = complex.star(complex.vertices(piece)[0], level);
  EXPECT_TRUE(star.fan && star.closed);
  std::vector<Patch> patches;
  for (const auto& sector : star.sectors) {
    patches.push_back(surface.patch(PatchId(sector.piece.patch)));
    const PiecePath path = sector.piece.path();
    for (unsigned k = 0; k < path.level(); ++k) patches.back() = split(patches.back(), path.digit(k));
  }
  std::vector<StarSector> sectors;
  for (std::size_t s = 0; s < patches.size(); ++s) sectors.push_back({&patches[s], star.sectors[s].centre});
  TipLimits tips;
  return certainly_injective(sectors, star.closed, tips);
}

TEST(star, of_any_common_valence_is_injective_where_it_is_smooth) {
  for (std::uint32_t n = 3; n <= 10; ++n) {
    const auto bowl = disc(n, 1, [](double x, double y) { return 0.1 * (x * x + y * y) + 0.05 * x * y; });
    EXPECT_TRUE(injective_at_centre(bowl, 3)) << n;
  }
}

TEST(star, that_winds_twice_is_never_injective) {
  for (std::uint32_t n = 5; n <= 16; ++n) {
    const auto twice = disc(n, 2, [](double x, double y) { return 0.02 * x * y; });
    for (unsigned level = 1; level <= 4; ++level) EXPECT_FALSE(injective_at_centre(twice, level)) << n;
  }
}

TEST(star, that_is_folded_flat_is_never_injective) {
  for (std::uint32_t n = 3; n <= 12; ++n) {
    auto folded = disc(n, 1, [](double, double) { return 0.0; });
    for (auto& p : folded.points) p[1] = std::fabs(p[1]);
    for (unsigned level = 1; level <= 5; ++level) EXPECT_FALSE(injective_at_centre(folded, level)) << n;
  }
}

TEST(star, that_is_a_point_or_a_line_is_never_injective) {
  auto point = disc(7, 1, [](double, double) { return 0.0; });
  auto line = point;
  for (auto& p : point.points) p = {1, 2, 3};
  for (auto& p : line.points) p = {p[0], 0, 0};
  for (unsigned level = 1; level <= 3; ++level) {
    EXPECT_FALSE(injective_at_centre(point, level));
    EXPECT_FALSE(injective_at_centre(line, level));
  }
}

}  // namespace
}  // namespace snug
