#include <snug/surface/quadratic_pieces.h>

#include <gtest/gtest.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/search/quadratic_bvh.h>
#include <testing/scheme_surfaces.h>

#include <cmath>
#include <map>
#include <random>
#include <string>

namespace snug::quadratic_pieces_test {
namespace {

// Each patch is all there, once: parts of level l count 4^-l.
void expect_whole(const LimitSurface& surface, const std::vector<QuadraticPiece>& pieces) {
  std::map<std::uint32_t, double> shares;
  for (const QuadraticPiece& piece : pieces) {
    shares[piece.root.value()] += std::ldexp(1, -2 * static_cast<int>(piece.path.level()));
  }
  std::size_t there = 0;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) there += surface.has_patch(PatchId(p));
  EXPECT_EQ(shares.size(), there);
  for (const auto& [root, share] : shares) EXPECT_NEAR(share, 1, 1e-12) << root;
}

void expect_near(const LimitSurface& surface, const std::vector<QuadraticPiece>& pieces, double error,
                 std::mt19937_64& random) {
  for (const QuadraticPiece& piece : pieces) {
    EXPECT_LE(piece.quadratic.error, error);
    Patch patch = surface.patch(piece.root);
    for (unsigned l = 0; l < piece.path.level(); ++l) patch = split(patch, piece.path.digit(l));
    const TriangleParameter at = testing::random_parameter(random);
    const RelativePoint point = limit_point(patch, at);
    EXPECT_LE(distance(point.from(patch.origin).position, point_of(piece.quadratic, at)),
              piece.quadratic.error + spatial_error(point.error) + 1e-15);
  }
}

TEST(quadratic_pieces, are_the_surface_up_to_their_errors) {
  std::mt19937_64 random(9);
  testing::for_each_surface(3, [&](const testing::NamedSurface& named) {
    SCOPED_TRACE(named.name);
    const LimitSurface& surface = named.surface;
    std::vector<QuadraticPiece> pieces = quadratic_pieces(surface, 1e-2, 1);
    expect_whole(surface, pieces);
    expect_near(surface, pieces, 1e-2, random);
    std::vector<std::uint8_t> which(pieces.size());
    for (auto& mark : which) mark = random() % 2;
    const RefinedPieces finer = refined(surface, pieces, which, 1e-4, 2);
    expect_whole(surface, finer.pieces);
    ASSERT_EQ(finer.origins.size(), finer.pieces.size());
    for (std::size_t i = 0; i < finer.pieces.size(); ++i) {
      const QuadraticPiece &part = finer.pieces[i], &of = pieces[finer.origins[i]];
      EXPECT_EQ(part.root, of.root);
      EXPECT_EQ(part.path.text().substr(0, of.path.level()), of.path.text());
      if (which[finer.origins[i]] != 0) {
        EXPECT_LE(part.quadratic.error, 1e-4);
      } else {
        EXPECT_EQ(part.path, of.path);
      }
    }
    expect_near(surface, finer.pieces, 1e-2, random);
  });
}

}  // namespace
}  // namespace snug::quadratic_pieces_test
