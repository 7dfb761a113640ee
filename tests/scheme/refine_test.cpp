#include <snug/scheme/refine.h>
#include <snug/scheme/rules.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <testing/twins.h>

#include <map>

namespace snug::refine_test {
namespace {

TEST(refine, stencil_rows_sum_to_one) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(6)) {
    const RefinedTopology refined = refine(Topology(testing::control_mesh(twin)), testing::rules(twin));
    for (std::size_t r = 0; r < refined.stencils.row_count(); ++r) {
      double sum = 0;
      for (const double w : refined.stencils.row(r).weights) sum += w;
      EXPECT_NEAR(sum, 1, 1e-14);
    }
  }
}

// Limit positions of refined meshes are the limit surface: they equal the twin's samples at the same
// parameters.
TEST(refine, and_limit_stencils_reach_the_twin_s_limit_points) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(7)) {
    const SchemeOptions options = testing::rules(twin);
    for (const int level : {0, 1, 3}) {
      ControlMesh mesh = testing::control_mesh(twin);
      for (int step = 0; step < level; ++step) mesh = refine(mesh, options);
      const Topology topology(mesh);
      const Stencils limits = limit_stencils(topology, options);
      // Corner 0 of face f: its parameter follows from the digits of the path, which are those of f in
      // base 4.
      std::map<std::tuple<std::uint32_t, double, double>, oracle::LimitSample> samples;
      for (const oracle::LimitSample& s : oracle::sample_uniform(twin, level))
        samples[{s.face, s.u, s.v}] = s;
      for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        double u = 0, v = 0;  // of corner 0 in the finest face, then outwards
        std::size_t face = f;
        for (int step = 0; step < level; ++step, face /= 4) {
          switch (face % 4) {
            case 0:
              u /= 2, v /= 2;
              break;
            case 1:
              u = (1 + u) / 2, v /= 2;
              break;
            case 2:
              u /= 2, v = (1 + v) / 2;
              break;
            default:
              u = (1 - u) / 2, v = (1 - v) / 2;
              break;
          }
        }
        const auto it = samples.find({static_cast<std::uint32_t>(face), u, v});
        if (it == samples.end()) {
          EXPECT_EQ(twin.boundary, oracle::Boundary::none);
          continue;
        }
        const VertexId corner = topology.face(FaceId(f))[0];
        if (options.boundary == BoundaryRule::none && topology.on_boundary(corner)) continue;
        const Point3 p = limits.apply<Point3>(corner.index(), mesh.points);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(p[k], it->second.position[k], 1e-14) << f;
      }
    }
  }
}

TEST(refine, keeps_a_lone_triangle_s_corners_and_makes_it_smooth_with_edge_only) {
  oracle::TwinMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const ControlMesh sharp =
      refine(testing::control_mesh(triangle), {Scheme::loop, BoundaryRule::edge_and_corner});
  EXPECT_EQ(sharp.points[1], (Point3{1, 0, 0}));
  const ControlMesh smooth = refine(testing::control_mesh(triangle), {Scheme::loop, BoundaryRule::edge_only});
  EXPECT_EQ(smooth.points[1], (Point3{0.75, 0.125, 0}));
}

// Tangent rows kill constants and are kept by a step up to their eigenvalue: directions are limits.
TEST(corner_tangents, keep_their_direction_under_refinement) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(8)) {
    const SchemeOptions options = testing::rules(twin);
    if (options.boundary == BoundaryRule::none) continue;
    const ControlMesh coarse = testing::control_mesh(twin);
    const ControlMesh fine = refine(coarse, options);
    const Topology coarse_topology(coarse), fine_topology(fine);
    const SchemeRules& rules = rules_of(options.scheme);
    for (std::size_t v = 0; v < coarse.vertex_count(); ++v) {
      Stencils before, after;
      rules.add_corner_tangents({coarse_topology, options, {}}, coarse_topology.leaving(VertexId(v)), before);
      rules.add_corner_tangents({fine_topology, options, {}}, fine_topology.leaving(VertexId(v)), after);
      Vector3 normal[2];
      for (int side = 0; side < 2; ++side) {
        const Stencils& rows = side == 0 ? before : after;
        const ControlMesh& mesh = side == 0 ? coarse : fine;
        const Point3 a = rows.apply<Point3>(0, mesh.points), b = rows.apply<Point3>(1, mesh.points);
        const Vector3 n = cross(a - Point3{}, b - Point3{});
        normal[side] = (1 / length(n)) * n;
      }
      EXPECT_NEAR(dot(normal[0], normal[1]), 1, 1e-9) << v;
    }
  }
}

}  // namespace
}  // namespace snug::refine_test
