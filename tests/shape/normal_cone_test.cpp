// Cones of normals of single patches: what has none, what rounding does, and the orientation.

#include <snug/shape/normal_cone.h>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <snug/patch/evaluate.h>
#include <testing/scheme_surfaces.h>

#include <cmath>
#include <numbers>
#include <random>

namespace snug::normal_cone_test {
namespace {

LimitSurface surface_of(const oracle::TaggedMesh& mesh, Scheme scheme) {
  return LimitSurface(testing::control_mesh(mesh), {scheme}, std::make_shared<BoundsCache>());
}

oracle::TaggedMesh moved(oracle::TaggedMesh mesh, double scale, const oracle::Point& by) {
  for (oracle::Point& p : mesh.points) {
    for (std::size_t k = 0; k < 3; ++k) p[k] = scale * p[k] + by[k];
  }
  return mesh;
}

TEST(normal_cone, of_a_plane_is_its_normal) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::bilinear, Scheme::doo_sabin, Scheme::midedge}) {
    const LimitSurface surface = surface_of(oracle::meshes::quad_grid(5, 4), scheme);
    std::size_t cones = 0;
    testing::for_each_patch(surface, [&](PatchId p) {
      const auto cone = normal_cone(surface.patch(p));
      ASSERT_TRUE(cone);
      ++cones;
      EXPECT_LT(cone->angle, 1e-12);
      EXPECT_GT(std::fabs(cone->axis.z), 1 - 1e-12);
    });
    EXPECT_GE(cones, 24U);
  }
}

TEST(normal_cone, points_outward_where_faces_do) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::loop, Scheme::doo_sabin}) {
    const oracle::TaggedMesh cube = scheme == Scheme::loop
                                        ? oracle::meshes::triangulated(oracle::meshes::cube())
                                        : oracle::meshes::cube();
    const LimitSurface surface = surface_of(moved(cube, 2, {-1, -1, -1}), scheme);
    testing::for_each_patch(surface, [&](PatchId p) {
      const Patch patch = surface.patch(p);
      const auto cone = normal_cone(patch);
      ASSERT_TRUE(cone) << name_of(scheme) << " " << p.index();
      EXPECT_LT(cone->angle, std::numbers::pi / 2);
      EXPECT_GT(dot(cone->axis, patch.origin + limit_corners(patch)[0] - Point3{}), 0);
    });
  }
}

TEST(normal_cone, is_the_same_at_any_size_and_wider_far_away) {
  std::mt19937_64 random(1);
  const oracle::TaggedMesh mesh = oracle::meshes::shaken(oracle::meshes::prism(5), 0.1, random);
  const LimitSurface here = surface_of(mesh, Scheme::catmark);
  for (const double scale : {0x1p-900, 0x1p-30, 0x1p900}) {
    const LimitSurface there = surface_of(moved(mesh, scale, {}), Scheme::catmark);
    testing::for_each_patch(here, [&](PatchId p) {
      const auto a = normal_cone(here.patch(p)), b = normal_cone(there.patch(p));
      ASSERT_EQ(a.has_value(), b.has_value());
      if (a) {
        EXPECT_EQ(a->angle, b->angle);
      }
    });
  }
  const LimitSurface far = surface_of(moved(mesh, 1, {0x1p40, 0, 0}), Scheme::catmark);
  testing::for_each_patch(here, [&](PatchId p) {
    const auto a = normal_cone(here.patch(p)), b = normal_cone(far.patch(p));
    if (a && b) {
      EXPECT_NEAR(a->angle, b->angle, 0.1);
    }
  });
}

TEST(normal_cone, is_none_where_the_surface_may_have_no_normal) {
  const auto none = [&](const oracle::TaggedMesh& mesh, Scheme scheme) {
    const LimitSurface surface = surface_of(mesh, scheme);
    testing::for_each_patch(surface,
                            [&](PatchId p) { EXPECT_FALSE(normal_cone(surface.patch(p))) << p.index(); });
  };
  // A point, a line, a quad that is folded onto itself.
  oracle::TaggedMesh flat = oracle::meshes::quad_grid(1, 1);
  for (oracle::Point& p : flat.points) p = {1, 2, 3};
  none(flat, Scheme::bilinear);
  flat = oracle::meshes::quad_grid(1, 1);
  for (oracle::Point& p : flat.points) p = {p[0], 2 * p[0], 0};
  none(flat, Scheme::bilinear);
  // Beside a dart, and beside a vertex that is a corner without creases, there are none.
  for (const bool dart : {true, false}) {
    oracle::TaggedMesh mesh = oracle::meshes::pole(5, false);
    if (dart) {
      mesh.creases.push_back({0, mesh.polygons[0][1], 10});
    } else {
      mesh.corners.push_back({0, 10});
    }
    const LimitSurface surface = surface_of(mesh, Scheme::catmark);
    testing::for_each_patch(surface, [&](PatchId p) {
      const std::size_t part = surface.place(p).part;
      if (part == 0 && mesh.polygons[surface.place(p).owner][0] == 0) {
        EXPECT_FALSE(normal_cone(surface.patch(p))) << p.index();
      }
    });
  }
}

}  // namespace
}  // namespace snug::normal_cone_test
