#include <snug/surface/control_hull.h>

#include <snug/patch/evaluate.h>
#include <testing/counts.h>
#include <testing/pieces.h>
#include <testing/scheme_surfaces.h>

namespace snug::control_hull_test {
namespace {

using testing::NamedSurface;

Vector3 random_direction(std::mt19937_64& random) {
  return {testing::unit(random) - 0.5, testing::unit(random) - 0.5, testing::unit(random) - 0.5};
}

TEST(control_hull, contains_limit_points_of_its_patches) {
  std::mt19937_64 random(61);
  std::size_t samples = 0;
  testing::for_each_surface(61, [&](const NamedSurface& named) {
    const LimitSurface& surface = named.surface;
    std::vector<PatchId> patches;
    testing::for_each_patch(surface, [&](PatchId p) { patches.push_back(p); });
    ControlHull hull;
    for (std::size_t begin = 0; begin < patches.size(); begin += 8) {
      const std::span<const PatchId> here =
          std::span(patches).subspan(begin, std::min<std::size_t>(8, patches.size() - begin));
      hull.assign(surface, here);
      for (int trial = 0; trial < 4; ++trial) {
        const Vector3 direction = random_direction(random);
        const Extent extent = hull.extent(direction);
        for (const PatchId p : here) {
          const Patch patch = surface.patch(p);
          for (int i = 0; i < 6; ++i) {
            const TriangleParameter at =
                i < 3
                    ? std::array<TriangleParameter, 3>{{{0, 0}, {1, 0}, {0, 1}}}[static_cast<std::size_t>(i)]
                    : testing::random_parameter(random);
            const RelativePoint point = limit_point(patch, at);
            const double height = dot(direction, patch.origin + point.relative - Point3{});
            ++samples;
            ASSERT_LE(extent.lower, height + 2 * point.error + 1e-15) << named.name;
            ASSERT_GE(extent.upper, height - 2 * point.error - 1e-15) << named.name;
          }
        }
      }
    }
  });
  EXPECT_GT(samples, testing::fewer(20'000));
}

TEST(control_balls, contain_limit_points_of_their_patches) {
  std::mt19937_64 random(64);
  std::size_t samples = 0;
  const auto check = [&](const LimitSurface& surface, const std::string& name) {
    std::vector<PatchId> patches;
    testing::for_each_patch(surface, [&](PatchId p) { patches.push_back(p); });
    const std::vector<Ball> balls = control_balls(surface, patches);
    ASSERT_EQ(balls.size(), patches.size());
    std::vector<VertexId> control;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      // Chaikin's rule makes the sharpness of edges depend on vertices farther away, but not their positions.
      if (!surface.rules().local && surface.options().creases == CreaseMethod::uniform) {
        surface.control_vertices(patches[i], control);
        for (const VertexId v : control) {
          ASSERT_LE(distance(surface.scaled_point(v), balls[i].centre), balls[i].radius) << name;
        }
      }
      const Patch patch = surface.patch(patches[i]);
      for (int k = 0; k < 6; ++k) {
        const RelativePoint point = limit_point(patch, testing::random_parameter(random));
        ++samples;
        ASSERT_LE(distance(patch.origin + point.relative, balls[i].centre),
                  balls[i].radius + 2 * point.error + 1e-15)
            << name;
      }
    }
  };
  testing::for_each_surface(64, [&](const NamedSurface& named) { check(named.surface, named.name); });
  // Faces of many corners, whose sizes are not measured pair by pair.
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge, Scheme::bilinear}) {
    check({testing::control_mesh(oracle::meshes::shaken(oracle::meshes::prism(40), 0.3, random)),
           {scheme},
           std::make_shared<BoundsCache>()},
          name_of(scheme));
  }
  EXPECT_GT(samples, testing::fewer(10'000));
}

TEST(kind, outer_weight_is_that_of_the_ring_at_a_corner) {
  std::mt19937_64 random(62);
  testing::for_each_surface(62, [&](const NamedSurface& named) {
    const LimitSurface& surface = named.surface;
    testing::for_each_patch(surface, [&](PatchId p) {
      const Kind& kind = surface.kind(p);
      const double w = kind.outer_weight();
      EXPECT_GE(w, 0) << named.name;
      EXPECT_LE(w, 1) << named.name;
      if (!kind.polynomial() || !kind.key().plain() || !kind.corner(0).closed) return;
      // Where the rings of all corners are closed and regular: 4 of 12 twelfths, 11 of 36.
      bool inside = true;
      for (std::size_t k = 0; k < (kind.scheme() == Scheme::loop ? 3u : 4u); ++k) {
        inside = inside && kind.corner(k).closed && !kind.corner(k).sharp;
      }
      if (!inside) return;
      if (kind.scheme() == Scheme::loop) {
        EXPECT_NEAR(w, 1.0 / 3, 0.02);
      } else if (kind.scheme() == Scheme::catmark) {
        EXPECT_NEAR(w, 11.0 / 36, 0.02);
      }
    });
  });
}

TEST(piece, heights_hold_the_piece) {
  std::mt19937_64 random(63);
  testing::for_each_surface(63, [&](const NamedSurface& named) {
    testing::Pieces pieces(named.surface);
    testing::for_each_patch(named.surface, [&](PatchId p) {
      testing::KnownPiece known = pieces.root(p);
      for (int level = 0; level < 2; ++level) {
        const Piece& piece = known.piece;
        const Vector3 normal = unit_normal(piece.offset.base);
        for (int i = 0; i < 10; ++i) {
          const RelativePoint point = limit_point(piece.patch, testing::random_parameter(random));
          const double height = dot(normal, piece.patch.origin + point.relative - piece.offset.base[0]);
          ASSERT_LE(known.heights.lower, height + 2 * point.error + 1e-15) << named.name;
          ASSERT_GE(known.heights.upper, height - 2 * point.error - 1e-15) << named.name;
        }
        if (!piece.can_split()) break;
        known = pieces.child(known, static_cast<unsigned>(random() % 4));
      }
    });
  });
}

}  // namespace
}  // namespace snug::control_hull_test
