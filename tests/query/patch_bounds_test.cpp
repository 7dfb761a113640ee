#include <snug/bound.h>

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <snug/evaluate.h>
#include <testing/journeys.h>
#include <testing/places.h>

namespace snug::enclosures_test {
namespace {

Surface model(const char* name) { return load(testing::models_dir() + "/" + name); }

TEST(enclosures, name_their_patches_and_hold_their_corners) {
  for (const char* name : {"star.obj", "bracket.obj"}) {
    const Surface surface = model(name);
    BoundOptions options;
    options.level = 1;
    std::size_t count = 0;
    const BoundSummary summary = bound(surface, options, [&](const PatchEnclosure& piece) {
      ++count;
      EXPECT_LT(piece.patch.owner, surface.mesh().face_count());
      EXPECT_EQ(piece.piece.size() <= piece.level, true);
      Box3 box;
      for (const Box3& corner : piece.interval.corner) box.add(corner);
      for (const Point3& p : piece.corners) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_GE(p[axis], box.lower[axis] - 1e-12 * surface.size());
          EXPECT_LE(p[axis], box.upper[axis] + 1e-12 * surface.size());
        }
      }
    });
    EXPECT_EQ(summary.count, count);
    EXPECT_EQ(summary.outcome, Outcome::complete);
  }
}

TEST(enclosures, have_cones_of_normals_where_asked) {
  const Surface surface = model("star.obj");
  std::size_t cones = 0;
  static_cast<void>(bound(surface, {.normals = true}, [&](const PatchEnclosure& piece) {
    ASSERT_TRUE(piece.normals);
    ++cones;
    for (const auto& [u, v] : {std::pair{0.25, 0.25}, std::pair{0.5, 0.125}, std::pair{0.0, 1.0}}) {
      const SurfacePoint point = evaluate(surface, {piece.patch.owner, 0, u, v});
      const Vector3 &a = piece.normals->axis, &n = *point.normal;
      EXPECT_GE(a.x * n.x + a.y * n.y + a.z * n.z, std::cos(piece.normals->angle) - 1e-12);
    }
  }));
  EXPECT_EQ(cones, 24U);
  static_cast<void>(bound(surface, {}, [](const PatchEnclosure& piece) { EXPECT_FALSE(piece.normals); }));
}

// Tables of a cage make other sets than rows do, and PatchBounds makes those of bound().
TEST(enclosures, are_made_as_the_surface_says) {
  const ControlMesh mesh = model("star.obj").mesh();
  std::vector<double> radii;
  for (const BoundMethod method : {BoundMethod::rows, BoundMethod::table}) {
    const Surface surface(mesh, {.bounds = method});
    std::vector<OffsetTriangle> offsets;
    const BoundSummary summary =
        bound(surface, {}, [&](const PatchEnclosure& piece) { offsets.push_back(piece.offset); });
    radii.push_back(summary.max_radius);
    PatchBounds bounds(surface);
    std::vector<OffsetTriangle> whole(offsets.size());
    bounds.update(mesh.points, whole);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      // Rows of many patches are in single precision.
      const double near = method == BoundMethod::rows ? 1e-3 * offsets[i].radius : 1e-9 * surface.size();
      EXPECT_NEAR(whole[i].radius, offsets[i].radius, near);
    }
  }
  EXPECT_LT(radii[0], 0.9 * radii[1]);
}

TEST(enclosures, follow_a_mesh_that_moves) {
  const Surface surface = model("star.obj");
  PatchBounds bounds(surface);
  std::vector<OffsetTriangle> triangles(bounds.patches().size());
  std::vector<Point3> points = surface.mesh().points;
  for (Point3& p : points) p.z += 0.1 * p.x * p.x;
  bounds.update(points, triangles);
  ControlMesh moved = surface.mesh();
  moved.points = points;
  const Surface there(std::move(moved));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const SurfacePoint middle = evaluate(there, {bounds.patches()[i].owner, 0, 0.25, 0.25});
    ASSERT_GT(triangles[i].radius, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double low = triangles[i].base[0][axis], high = low;
      for (const Point3& p : triangles[i].base) low = std::min(low, p[axis]), high = std::max(high, p[axis]);
      EXPECT_GE(middle.point[axis], low - triangles[i].radius - middle.error);
      EXPECT_LE(middle.point[axis], high + triangles[i].radius + middle.error);
    }
  }
  PatchBounds taken = std::move(bounds);
  EXPECT_EQ(taken.patches().size(), triangles.size());
  EXPECT_THROW(taken.update(std::vector<Point3>(3), triangles), InputError);
}

// Limit points of meshes in between, of every kind of motion between the ends.
TEST(enclosures, boxes_in_motion_hold_every_time_in_between) {
  std::mt19937_64 random(9);
  for (const char* name : {"star.obj", "bracket.obj"}) {
    const ControlMesh mesh = model(name).mesh();
    const Surface surface(mesh);
    PatchBounds bounds(surface);
    std::vector<Box3> boxes(bounds.patches().size());
    for (std::size_t j = 0; j < testing::journey_count; ++j) {
      const auto journey = static_cast<testing::Journey>(j);
      const std::vector<Point3> begin = testing::start_of(journey, mesh.points, random);
      bounds.update(begin, mesh.points, boxes);
      for (const double t : {0.0, 0.25, 0.5, 0.875, 1.0}) {
        ControlMesh between = mesh;
        for (std::size_t v = 0; v < begin.size(); ++v) {
          for (std::size_t k = 0; k < 3; ++k) {
            between.points[v][k] = (1 - t) * begin[v][k] + t * mesh.points[v][k];
          }
        }
        const Surface then(between);
        const double rounding = 1e-14 * then.size();
        for (std::size_t i = 0; i < boxes.size(); i += 7) {
          const auto [owner, part] = bounds.patches()[i];
          const bool triangle = mesh.face(FaceId(owner)).size() == 3;
          const std::uint32_t corner = mesh.face(FaceId(owner)).size() > 4 ? part / 2 : 0;
          const bool second = part % 2 != 0;
          if (triangle && surface.scheme() != Scheme::loop) continue;
          const SurfacePoint at = evaluate(then, {owner, corner, second ? 0.1 : 0.6,
                                                  triangle ? 0.3
                                                  : second ? 0.7
                                                           : 0.2});
          for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_LE(boxes[i].lower[k], at.point[k] + at.error + rounding) << testing::name_of(journey);
            EXPECT_GE(boxes[i].upper[k], at.point[k] - at.error - rounding) << testing::name_of(journey);
          }
        }
      }
    }
    boxes.pop_back();
    EXPECT_THROW(bounds.update(mesh.points, mesh.points, boxes), InputError);
  }
}

}  // namespace
}  // namespace snug::enclosures_test
