#include <snug/scheme/refine.h>
#include <snug/scheme/rules.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <oracle/quad.h>
#include <snug/scheme/creases.h>
#include <testing/tagged.h>
#include <testing/twins.h>

#include <map>
#include <random>

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

using oracle::Quad;

// Where two sharpnesses end at once their exact mean is meant, which no double is.
TEST(refine, weighs_what_ends_by_the_exact_mean) {
  std::mt19937_64 random(7);
  const ControlMesh cube = testing::control_mesh(oracle::meshes::cube());
  const Topology topology(cube);
  const VertexId v(0u);
  Star star;
  gather_star({topology, {.scheme = Scheme::catmark}, {}}, v, star);
  for (int trial = 0; trial < 2000; ++trial) {
    Sharpness sharpness;
    std::array<double, 2> s{};
    for (std::size_t i = 0; i < 2; ++i) {
      s[i] = std::ldexp(static_cast<double>(random() >> 11), -53 - static_cast<int>(random() % 4));
      set_sharpness(sharpness.edges, topology.edge_count(), star.spokes[i].edge.index(), s[i]);
    }
    const RefinedTopology refined = refine(topology, {.scheme = Scheme::catmark}, sharpness);
    const Stencils::Row row = refined.stencils.row(v.index());
    const auto mean = (static_cast<Quad>(s[0]) + static_cast<Quad>(s[1])) / 2, rest = 1 - mean;
    Quad error = 0;
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      const VertexId source(row.sources[i]);
      Quad exact = rest / 36;  // across a face
      if (source == v) exact = mean * 3 / 4 + rest * 5 / 12;
      for (std::size_t k = 0; k < 3; ++k) {
        if (source == star.spokes[k].end) exact = rest / 6 + (k < 2 ? mean / 8 : 0);
      }
      const Quad off = static_cast<Quad>(row.weights[i]) - exact;
      error += off < 0 ? -off : off;
    }
    ASSERT_LE(static_cast<double>(error), row.error * (1 + 0x1p-50)) << s[0] << " and " << s[1];
  }
}

// Chaikin's mean does not depend on which face comes first.
TEST(refine, lowers_sharpness_alike_whatever_the_order_of_faces) {
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 200; ++trial) {
    ControlMesh mesh = testing::control_mesh(oracle::meshes::pyramid(7));
    for (std::uint32_t k = 0; k < 7; ++k) {
      mesh.tags.creases.push_back(
          {VertexId(0u), VertexId(k + 1), 1 + 3 * std::ldexp(static_cast<double>(random() >> 11), -53)});
    }
    ControlMesh turned = mesh;
    const std::size_t faces = mesh.face_count();
    turned.face_offsets = {0};
    turned.face_vertices.clear();
    for (std::size_t f = 0; f < faces; ++f) turned.add_face(mesh.face(FaceId((f + 3) % faces)));
    std::array<std::vector<double>, 2> left;
    for (std::size_t side = 0; side < 2; ++side) {
      const ControlMesh& one = side == 0 ? mesh : turned;
      const Topology topology(one);
      Star star;
      const SchemeOptions options{.scheme = Scheme::catmark, .creases = CreaseMethod::chaikin};
      const Sharpness sharpness = sharpness_of(one, topology);
      gather_star({topology, options, sharpness}, VertexId(0u), star);
      for (const Spoke& spoke : star.spokes)
        left[side].push_back(decayed(star, spoke, CreaseMethod::chaikin));
      std::sort(left[side].begin(), left[side].end());
    }
    ASSERT_EQ(left[0].size(), 7U);
    ASSERT_EQ(left[0], left[1]);
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
