#include <snug/search/placed_box.h>

#include <gtest/gtest.h>
#include <oracle/quad.h>
#include <snug/surface/evaluate.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>

#include <cmath>
#include <random>

namespace snug::placed_box_test {
namespace {

// The image of a point, in 113 bits.
std::array<oracle::Quad, 3> placed(const Motion& pose, const Point3& p) {
  std::array<oracle::Quad, 3> image;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    image[axis] = pose.offset()[axis];
    for (std::size_t k = 0; k < 3; ++k) image[axis] += static_cast<oracle::Quad>(pose.row(axis)[k]) * p[k];
  }
  return image;
}

std::vector<Motion> some_poses(std::mt19937_64& random, double size) {
  std::vector<Motion> poses{{}, Motion::translation({1e12, -1e12, 3e12})};
  for (const double spread : {0.0, 1.0, 1e5, 1e12}) {
    const Vector3 t = testing::random_vector(random, spread * size);
    poses.push_back(testing::random_placement(random, t));
    poses.push_back(Motion::rotation_degrees({0, 0, 1}, 90).with_offset(t));
    // Entries far smaller than others, and barely rigid ones.
    poses.push_back(Motion::from_3x4({1, 1e-200, 0, t.x, -1e-200, 1, 1e-30, t.y, 0, -1e-30, 1, t.z}));
    poses.push_back(Motion::from_3x4({1 + 4e-10, 0, 0, t.x, 0, 1 - 4e-10, 0, t.y, 0, 0, 1, t.z}));
  }
  return poses;
}

TEST(placed_box, contains_limit_points_of_every_scheme_wherever_it_is_placed) {
  std::mt19937_64 random(73);
  testing::for_each_surface(73, [&](const testing::NamedSurface& named) {
    const LimitSurface& surface = named.surface;
    std::optional<SurfaceBvh> model;
    try {
      model.emplace(surface, SurfaceBvhOptions{.threads = 1});
    } catch (const InputError&) {
      return;  // all holes
    }
    for (const Motion& pose : some_poses(random, surface.size())) {
      const Box3 box = placed_box(*model, pose);
      for (int sample = 0; sample < 40; ++sample) {
        Place at{.owner = static_cast<std::uint32_t>(random() % surface.owner_count())};
        const int corner = static_cast<int>(random() % 4);  // corners reach farthest
        const TriangleParameter inside = testing::random_parameter(random);
        at.u = corner == 0 ? 0 : corner == 1 ? 1 : inside.u;
        at.v = corner < 2 ? 0 : inside.v;
        const auto patch = patch_at(surface, at);
        if (!patch) continue;
        const SurfacePoint point = evaluate(surface, at);
        const auto image = placed(pose, point.point);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          // The point's own error is not the box's.
          ASSERT_GE(image[axis] + 1.8 * point.error, box.lower[axis]) << named.name;
          ASSERT_LE(image[axis] - 1.8 * point.error, box.upper[axis]) << named.name;
        }
      }
    }
  });
}

ControlMesh tetrahedron(std::mt19937_64& random, double size) {
  ControlMesh mesh;
  for (int i = 0; i < 4; ++i) mesh.points.push_back(Point3{} + testing::random_vector(random, size));
  for (const auto& face : {std::array{0u, 1u, 2u}, {0u, 2u, 3u}, {0u, 3u, 1u}, {1u, 3u, 2u}}) {
    mesh.add_face(std::array{VertexId(face[0]), VertexId(face[1]), VertexId(face[2])});
  }
  return mesh;
}

// Triangles as they are: the vertices are the farthest points, and known exactly.
TEST(placed_box, contains_the_exact_images_of_vertices_and_is_tight) {
  std::mt19937_64 random(74);
  double widest = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const double size = std::ldexp(1.3, static_cast<int>(random() % 200) - 100);
    const ControlMesh mesh = tetrahedron(random, size);
    const LimitSurface surface(mesh, {.scheme = Scheme::flat}, std::make_shared<BoundsCache>());
    const SurfaceBvh model(surface, {.threads = 1});
    for (const Motion& pose : some_poses(random, size)) {
      const Box3 box = placed_box(model, pose);
      Box3 image_box;
      for (const Point3& p : mesh.points) {
        const auto image = placed(pose, p);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          ASSERT_GE(image[axis], box.lower[axis]) << trial;
          ASSERT_LE(image[axis], box.upper[axis]) << trial;
        }
        image_box.add(Point3{static_cast<double>(image[0]), static_cast<double>(image[1]),
                             static_cast<double>(image[2])});
      }
      if (max_abs(pose.offset()) < 1e3 * size) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          widest = std::max(
              widest, (box.upper[axis] - box.lower[axis]) / (image_box.upper[axis] - image_box.lower[axis]));
        }
      }
    }
  }
  EXPECT_LT(widest, 12);
}

TEST(placed_box, is_infinite_where_doubles_do_not_reach) {
  std::mt19937_64 random(75);
  for (const double size : {1e305, 1e-305}) {
    const ControlMesh mesh = tetrahedron(random, size);
    const LimitSurface surface(mesh, {.scheme = Scheme::flat}, std::make_shared<BoundsCache>());
    const SurfaceBvh model(surface, {.threads = 1});
    const Box3 box = placed_box(model, Motion::translation({1e308, 0, 0}));
    EXPECT_EQ(box.lower.x, -INFINITY);
    EXPECT_EQ(box.upper.z, INFINITY);
  }
}

// Boxes of leaves stick out of a thin plate by more than it is thick; a vertex that no face uses is not part of it.
TEST(placed_box, of_a_thin_wavy_plate_is_no_thicker_than_its_control_points) {
  ControlMesh mesh;
  constexpr std::uint32_t side = 12;
  Extent thickness;
  mesh.points.push_back({0, 0, 100});
  for (std::uint32_t j = 0; j <= side; ++j) {
    for (std::uint32_t i = 0; i <= side; ++i) {
      const double x = 0.1 * i, y = 0.1 * j;
      mesh.points.push_back({x, y, 0.03 * std::sin(9 * x + 3 * std::sin(5 * y)) + 0.02 * std::sin(11 * y)});
      thickness.add(mesh.points.back().z);
    }
  }
  const auto at = [](std::uint32_t i, std::uint32_t j) { return VertexId(1 + j * (side + 1) + i); };
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      mesh.add_face(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  const LimitSurface surface(mesh, {.scheme = Scheme::catmark}, std::make_shared<BoundsCache>());
  const SurfaceBvh model(surface, SurfaceBvhOptions{.threads = 1});
  const Box3 box = placed_box(model, Motion::rotation_degrees({0, 0, 1}, 90));
  EXPECT_GE(box.lower.z, thickness.lower - 1e-12);
  EXPECT_LE(box.upper.z, thickness.upper + 1e-12);
  EXPECT_LE(box.upper.y - box.lower.y, 1.2 + 1e-12);
}

}  // namespace
}  // namespace snug::placed_box_test
