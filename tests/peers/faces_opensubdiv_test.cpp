// B-spline faces against OpenSubdiv's Bfr at equal parameters: never farther than the bound. Bfr is exact on regular faces; on others it
// ends at level 6.

#include <snug/spline/face_spline.h>
#include <snug/spline/hermite_face.h>
#include <snug/spline/quad_pieces.h>
#include <snug/surface/limit_surface.h>

#include <gtest/gtest.h>
#include <oracle/spline_twin.h>
#include <peers/opensubdiv_comparison.h>
#include <testing/counts.h>
#include <testing/tagged.h>

#include <cmath>
#include <iostream>
#include <random>

namespace snug::faces_opensubdiv_test {
namespace {

constexpr double end_of_bfr = 1e-6;  // of its approximations

struct Seen {
  std::size_t regular = 0, others = 0;
  double regular_excess = 0, excess = 0;
};

void compare(const SplineSurface& spline, double bound, const oracle::BfrSurfaces::Face& theirs,
             const std::vector<std::array<double, 2>>& of_spline, double scale, Seen& seen) {
  for (std::size_t k = 0; k < of_spline.size(); ++k) {
    const auto p = oracle::spline_point(spline.degree, spline.u_knots, spline.v_knots, spline.points,
                                        of_spline[k][0], of_spline[k][1]);
    double square = 0;
    for (std::size_t x = 0; x < 3; ++x) {
      const double off = static_cast<double>(p[x]) - scale * theirs.points[k][x];
      square += off * off;
    }
    const double apart = std::sqrt(square);
    EXPECT_LE(apart, bound + (theirs.regular ? 1e-13 : end_of_bfr));
    double& excess = theirs.regular ? seen.regular_excess : seen.excess;
    excess = std::max(excess, apart - bound);
  }
  ++(theirs.regular ? seen.regular : seen.others);
}

// Bfr 3.5 ends the process on two quads with the same corners, and has other rules than its own refinement where a mesh is not manifold.
bool is_plain(const std::string& name) {
  for (const char* other :
       {"back to back", "book", "moebius", "cubes at a vertex", "cells at edges", "same ways"}) {
    if (name.starts_with(other)) return false;
  }
  return true;
}

std::vector<std::array<double, 2>> parameters(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<std::array<double, 2>> uv;
  for (int k = 0; k < 20; ++k) uv.push_back({unit(random), unit(random)});
  return uv;
}

TEST(faces_and_opensubdiv, quads_are_within_their_bounds) {
  std::mt19937_64 random(15);
  Seen seen;
  for (const testing::TaggedCase& c : testing::tagged_cases(oracle::PrimalScheme::catmull_clark, 45)) {
    SCOPED_TRACE(c.name + ", " + testing::text_of(c.rules));
    if (!is_plain(c.name)) continue;
    const LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules),
                               std::make_shared<BoundsCache>());
    const oracle::BfrSurfaces bfr(c.mesh, c.rules);
    for (std::size_t p = 0; p < surface.patch_count(); p += 2) {
      if (!surface.has_patch(PatchId(p))) continue;
      const std::size_t owner = surface.place(PatchId(p)).owner;
      if (c.mesh.polygons[owner].size() != 4 || random() % 2 != 0) continue;
      const auto uv = parameters(random);
      const auto theirs = bfr.at(owner, uv);
      if (!theirs) continue;
      const Patch patch = surface.patch(PatchId(p));
      QuadDepths depths;
      depths.corners.fill(3);
      depths.sides.fill(3);
      QuadPieces quad(patch, depths, 0.01);
      std::vector<FacePart> parts;
      for (QuadPiece& piece : quad.take())
        parts.push_back({piece.box(), piece.piece, patch.origin, piece.tip, piece.distance});
      const SplineSurface spline = spline_of(parts, 3);
      compare(spline, distance_bound(parts, spline), *theirs, uv, surface.scale().apply(1.0), seen);
      if (::testing::Test::HasFailure()) break;
    }
  }
  std::cout << "  " << seen.regular << " regular faces beyond the bound by " << seen.regular_excess << ", "
            << seen.others << " others by " << seen.excess << '\n';
  EXPECT_GT(seen.regular, 20u);
  EXPECT_GT(seen.others, 100u);
}

TEST(faces_and_opensubdiv, triangles_are_within_their_bounds) {
  std::mt19937_64 random(16);
  Seen seen;
  for (const testing::TaggedCase& c : testing::tagged_cases(oracle::PrimalScheme::loop, 46)) {
    SCOPED_TRACE(c.name + ", " + testing::text_of(c.rules));
    if (!is_plain(c.name)) continue;
    const LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules),
                               std::make_shared<BoundsCache>());
    const oracle::BfrSurfaces bfr(c.mesh, c.rules);
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      if (!surface.has_patch(PatchId(p)) || random() % 4 != 0) continue;
      std::vector<std::array<double, 2>> of_spline, uv;
      for (auto [u, v] : parameters(random)) {
        if (v > u) std::swap(u, v);
        of_spline.push_back({u, v});
        uv.push_back({u - v, v});  // weights of corners 1 and 2
      }
      const auto theirs = bfr.at(surface.place(PatchId(p)).owner, uv);
      if (!theirs) continue;
      const Patch patch = surface.patch(PatchId(p));
      std::vector<FaceSquare> squares;
      squares.push_back({{patch, 0, SquareHalf::lower}, {}});
      std::vector<HermiteCurve> border;
      for (unsigned k = 0; k < 3; ++k) {
        TriangleTree tree(patch, k, SquareHalf::lower);
        border.push_back(curve_near(tree, 0.01));
      }
      HermiteFace face(1, 1, std::move(squares), border);
      static_cast<void>(face.refine(0.01, 400));
      const std::vector<FacePart> parts = face.parts();
      const SplineSurface spline = spline_of(parts, 3);
      compare(spline, distance_bound(parts, spline), *theirs, of_spline, surface.scale().apply(1.0), seen);
      if (::testing::Test::HasFailure()) break;
    }
  }
  std::cout << "  " << seen.regular << " regular faces beyond the bound by " << seen.regular_excess << ", "
            << seen.others << " others by " << seen.excess << '\n';
  EXPECT_GT(seen.regular, 10u);
  EXPECT_GT(seen.others, 100u);
}

}  // namespace
}  // namespace snug::faces_opensubdiv_test
