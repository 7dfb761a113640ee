#include <snug/bounds/bounding_points.h>

#include <gtest/gtest.h>
#include <testing/patches.h>
#include <testing/tagged.h>

namespace snug::bounding_points_test {
namespace {

// The box around the points, relative to their origin.
Box3 box_around(const BoundingPoints& points) {
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
double distance_behind(const std::array<Vector3, 3>& corners, const BoundingPoints& points) {
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 axis = corners[k] - 0.5 * (corners[(k + 1) % 3] + corners[(k + 2) % 3]);
    for (std::size_t i = 0; i < points.size(); ++i) {
      most = std::max(most, dot(points.at(i) - corners[k], axis) / dot(axis, axis));
    }
  }
  return most;
}

void expect_inside(const Patch& patch, const BoundingPoints& points, const Vector3& direction) {
  const Box3 box = box_around(points);
  const Slab slab = outer_slab(points, direction);
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; i + j <= 8; ++j) {
      const RelativePoint at = limit_point(patch, {i / 8.0, j / 8.0});
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

// Samples of a patch lie in the box of its bounding points and in its slab along any direction, for rows that end
// in nets and with tips.
TEST(bounding_points, and_their_slab_contain_the_limit_patch) {
  std::mt19937_64 random(18);
  std::normal_distribution<double> normal;
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(18)) {
    const LimitSurface surface = testing::surface_of(twin);
    BoundingPoints points;
    for (std::size_t f = 0; f < surface.face_count(); ++f) {
      if (!surface.has_patch(PatchId(f))) continue;
      const Patch patch = surface.patch(PatchId(f));
      for (const bool with_tips : {false, true}) {
        if (with_tips) {
          bounding_points(surface.library(), patch, points);
        } else {
          bounding_points(surface.library().rows(*patch.kind), patch, points);
        }
        expect_inside(patch, points, {normal(random), normal(random), normal(random)});
      }
    }
  }
}

// The boxes of a tip reach beyond its corner, less and less.
TEST(refine_tip, leaves_the_patch_inside_and_cuts_what_lies_behind_its_corner) {
  for (const std::uint32_t n : {3u, 5u, 7u, 9u, 30u}) {
    const LimitSurface surface = testing::surface_of(oracle::meshes::bipyramid(n));
    BoundsCache& library = surface.library();
    const Patch patch = surface.patch(PatchId(0));
    BoundingPoints points;
    bounding_points(library, patch, points);
    const std::size_t tips = points.tips().size();
    EXPECT_GT(tips, 0u);
    const std::array<Vector3, 3> corners = limit_corners(patch);
    for (std::size_t round = 0; round < 10 * tips; ++round) {
      points.refine_tip(library, round % tips);
      const Box3 box = box_around(points);
      for (int i = 0; i <= 16; ++i) {
        for (int j = 0; i + j <= 16; ++j) {
          const RelativePoint at = limit_point(patch, {i / 16.0, j / 16.0});
          for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_GE(at.relative[a], box.lower[a] - at.error) << n;
            EXPECT_LE(at.relative[a], box.upper[a] + at.error) << n;
          }
        }
      }
    }
    EXPECT_LT(distance_behind(corners, points), 1e-4) << n;
  }
}

// At a steep tip of a cone the net of the last piece alone reaches up to the corner.
TEST(bounding_points, of_crowded_patches_hold_their_corners) {
  for (const bool creased : {false, true}) {
    oracle::TaggedMesh mesh = oracle::meshes::pole(creased ? 36 : 70, false);
    if (creased) mesh.creases = {{0, 1, 10}, {0, 3, 10}, {0, 37, 10}};
    mesh.points[0] = {0, 0, 1};
    const LimitSurface surface(testing::control_mesh(mesh), {Scheme::catmark},
                               std::make_shared<BoundsCache>());
    std::size_t high_valence = 0;
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      if (!surface.has_patch(PatchId(p)) || !surface.kind(PatchId(p)).high_valence()) continue;
      ++high_valence;
      const Patch patch = surface.patch(PatchId(p));
      BoundingPoints points;
      bounding_points(surface.library(), patch, points);
      const Slab slab = outer_slab(points, {0, 0, 1});
      for (const Vector3& corner : limit_corners(patch)) {
        EXPECT_GE(corner.z, slab.lower) << p;
        EXPECT_LE(corner.z, slab.upper) << p;
      }
    }
    EXPECT_GT(high_valence, 30u);
  }
}

}  // namespace
}  // namespace snug::bounding_points_test
