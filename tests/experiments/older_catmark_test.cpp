#include <experiments/older_catmark.h>

#include <gtest/gtest.h>
#include <oracle/polygon_net.h>
#include <oracle/polygon_twin.h>
#include <oracle/tagged_shapes.h>
#include <support/error.h>
#include <testing/tagged.h>

namespace snug::older_catmark_test {
namespace {

TEST(older_catmark_rule, is_that_of_the_twin) {
  std::mt19937_64 random(7);
  oracle::Rules rules;
  rules.old_vertex_rule = true;
  for (const oracle::TaggedMesh& plain : {oracle::meshes::cube(), oracle::meshes::prism(5),
                                          oracle::meshes::pyramid(7), oracle::meshes::quad_grid(4, 3)}) {
    const oracle::TaggedMesh mesh = oracle::meshes::shaken(plain, 0.2, random);
    for (const unsigned level : {0u, 1u, 3u}) {
      const ControlMesh fine = subdivide_by_older_rule(testing::control_mesh(mesh), level);
      const oracle::TaggedMesh twin = oracle::refine(mesh, rules, static_cast<int>(level));
      ASSERT_EQ(fine.vertex_count(), twin.points.size());
      // The twin puts the vertices of the mesh behind all others.
      const std::size_t before = twin.points.size() - mesh.points.size();
      for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        const oracle::Point& q = twin.points[before + v];
        EXPECT_LT(distance(fine.points[v], Point3{q[0], q[1], q[2]}), 1e-14);
      }
    }
  }
}

TEST(older_catmark_rule, knows_no_creases) {
  ControlMesh mesh = testing::control_mesh(oracle::meshes::cube());
  mesh.tags.corners.push_back({VertexId(0), 1.0});
  EXPECT_THROW(static_cast<void>(subdivide_by_older_rule(mesh, 1)), InputError);
}

}  // namespace
}  // namespace snug::older_catmark_test
