#include <snug/bounds/hull_points.h>

#include <gtest/gtest.h>
#include <testing/patches.h>
#include <testing/tagged.h>

namespace snug {
namespace {

// The box around the points, relative to their origin.
Box3 box_around(const HullPoints& points) {
  Box3 box;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      box.lower[a] = std::min(box.lower[a], points.at(i)[a] - points.error);
      box.upper[a] = std::max(box.upper[a], points.at(i)[a] + points.error);
    }
  }
  return box;
}

// How far the hull reaches behind the corners of a patch, as a share of its size: beyond each corner along
// the line from the middle of the opposite edge.
double distance_behind(const std::array<Vector3, 3>& corners, const HullPoints& points) {
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 axis = corners[k] - 0.5 * (corners[(k + 1) % 3] + corners[(k + 2) % 3]);
    for (std::size_t i = 0; i < points.size(); ++i) {
      most = std::max(most, dot(points.at(i) - corners[k], axis) / dot(axis, axis));
    }
  }
  return most;
}

// Samples of a patch lie in the box of its hull points and in its slab along any direction, for rows.
TEST(hull_points, and_their_slab_contain_the_limit_patch) {
  std::mt19937_64 random(18);
  std::normal_distribution<double> normal;
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(18)) {
    const LimitSurface surface = testing::surface_of(twin);
    HullPoints points;
    for (std::size_t f = 0; f < surface.face_count(); ++f) {
      if (!surface.has_patch(PatchId(f))) continue;
      const Patch patch = surface.patch(PatchId(f));
      hull_points(surface.library().rows(*patch.kind), patch, points);
      const Box3 box = box_around(points);
      const Slab slab = outer_slab(points, {normal(random), normal(random), normal(random)});
      for (int i = 0; i <= 8; ++i) {
        for (int j = 0; i + j <= 8; ++j) {
          const LimitPoint at = limit_point(patch, {i / 8.0, j / 8.0});
          for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_GE(at.relative[k], box.lower[k] - at.error);
            EXPECT_LE(at.relative[k], box.upper[k] + at.error);
          }
          const double height = dot(slab.normal, at.relative), slack = 8 * at.error + 1e-15;
          EXPECT_GE(height, slab.lower - slack);
          EXPECT_LE(height, slab.upper + slack);
        }
      }
    }
  }
}

// Seen from the limit, a patch fills a sector at its extraordinary corner, but the net of the tip all around
// it.
TEST(refine_tips, leaves_the_patch_inside_and_cuts_what_lies_behind_its_corner) {
  for (const std::uint32_t n : {3u, 5u, 7u, 9u, 30u}) {
    const LimitSurface surface = testing::surface_of(oracle::meshes::bipyramid(n));
    BoundsCache& library = surface.library();
    const Patch patch = surface.patch(PatchId(0));
    HullPoints points;
    hull_points(library.rows(*patch.kind), patch, points);
    std::size_t tips = 0;
    while (tips < 3 && points.tips[tips].kind) ++tips;
    for (std::size_t i = 0; i < 2 * tips; ++i) {
      const Box3 before = box_around(points);
      refine_tips(library, {i % tips == 0, i % tips == 1, i % tips == 2}, points);
      const Box3 after = box_around(points);
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_GE(after.lower[a], before.lower[a] - 2 * points.error);
        EXPECT_LE(after.upper[a], before.upper[a] + 2 * points.error);
      }
    }
    const Box3 box = box_around(points);
    for (int i = 0; i <= 16; ++i) {
      for (int j = 0; i + j <= 16; ++j) {
        const LimitPoint at = limit_point(patch, {i / 16.0, j / 16.0});
        for (std::size_t a = 0; a < 3; ++a) {
          EXPECT_GE(at.relative[a], box.lower[a] - at.error) << n;
          EXPECT_LE(at.relative[a], box.upper[a] + at.error) << n;
        }
      }
    }
    const std::array<Vector3, 3> corners = limit_corners(patch);
    const double left = distance_behind(corners, points);
    EXPECT_LT(left, 1e-4) << n;
  }
}

// At a steep tip of a cone the net of the last piece alone reaches up to the corner.
TEST(hull_points, of_crowded_patches_hold_their_corners) {
  oracle::TaggedMesh mesh = oracle::meshes::pole(36, false);
  mesh.creases = {{0, 1, 10}, {0, 3, 10}, {0, 37, 10}};
  mesh.points[0] = {0, 0, 1};
  const LimitSurface surface(testing::control_mesh(mesh), {Scheme::catmark}, std::make_shared<BoundsCache>(),
                             1);
  std::size_t crowded = 0;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (!surface.has_patch(PatchId(p)) || !surface.kind(PatchId(p)).crowded()) continue;
    ++crowded;
    const Patch patch = surface.patch(PatchId(p));
    HullPoints points;
    hull_points(surface.library(), patch, points);
    const Slab slab = outer_slab(points, {0, 0, 1});
    for (const Vector3& corner : limit_corners(patch)) {
      EXPECT_GE(corner.z, slab.lower) << p;
      EXPECT_LE(corner.z, slab.upper) << p;
    }
  }
  EXPECT_GT(crowded, 30u);
}

}  // namespace
}  // namespace snug
