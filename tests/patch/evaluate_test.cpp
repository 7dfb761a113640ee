#include <snug/patch/evaluate.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <snug/patch/limit_evaluator.h>
#include <testing/twins.h>

#include <cmath>

namespace snug::evaluate_test {
namespace {

class Patches {
 public:
  explicit Patches(const oracle::TwinMesh& twin)
      : mesh_(testing::control_mesh(twin)), topology_(mesh_), options_(testing::rules(twin)) {}
  [[nodiscard]] Patch operator[](std::size_t face) {
    const TurnedKey key = kind_key(topology_, FaceId(face), options_);
    std::vector<VertexId> control;
    const Kind& kind = library_.find(key.key);
    kind.control_vertices(topology_, topology_.first_of(FaceId(face)) + key.first, control);
    return make_patch(kind, key.first, mesh_.points, control);
  }

 private:
  KindCache library_;
  ControlMesh mesh_;
  Topology topology_;
  SchemeOptions options_;
};

BoundedPoint evaluated(LimitEvaluator& evaluator, double u, double v) {
  std::array<BoundedPoint, 1> point;
  evaluator.points(std::array{Place{0, 0, u, v}}, point);
  return point[0];
}

void expect_sample(const Patch& patch, const oracle::LimitSample& s) {
  const double coordinate_rounding = 1.2e-16 * (max_abs(patch.origin - Point3{}) + patch.largest);
  const std::string where =
      "face " + std::to_string(s.face) + " at " + std::to_string(s.u) + ", " + std::to_string(s.v);
  const RelativePoint point = limit_point(patch, {s.u, s.v});
  LimitEvaluator evaluator(patch);
  const BoundedPoint kept = evaluated(evaluator, s.u, s.v);
  const LimitFrame frame = evaluator.frame({0, 0, s.u, s.v});
  for (std::size_t k = 0; k < 3; ++k) {
    for (const RelativePoint& relative : {point, frame.point}) {
      EXPECT_NEAR(patch.origin[k] + relative.relative[k], s.position[k],
                  relative.error + s.error + coordinate_rounding)
          << where;
    }
    EXPECT_LE(std::fabs(kept.position[k] - s.position[k]), kept.error + s.error) << where;
  }
  for (const double error : {point.error, frame.point.error})
    EXPECT_LT(error, 1e-11 * patch.largest) << where;
}

TEST(limit_point, agrees_with_the_twin_within_its_own_error) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(12)) {
    Patches patches(twin);
    for (const oracle::LimitSample& s : oracle::sample_uniform(twin, 3)) expect_sample(patches[s.face], s);
  }
}

TEST(limit_point, agrees_with_the_twin_as_close_to_a_corner_as_doubles_go) {
  for (const std::uint32_t n : {3u, 4u, 5u, 6u, 7u, 8u, 20u, 100u}) {
    std::mt19937_64 random(n);
    const oracle::TwinMesh twin = oracle::meshes::disturbed(oracle::meshes::bipyramid(n), 0, 0.2, random);
    Patches patches(twin);
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      for (const oracle::LimitSample& s : oracle::sample_near_corner(twin, 0, corner, 40))
        expect_sample(patches[0], s);
    }
  }
}

TEST(limit_point, agrees_with_the_twin_at_odd_parameters) {
  std::mt19937_64 random(13);
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(13)) {
    Patches patches(twin);
    for (int trial = 0; trial < 40; ++trial) {
      // Multiples of 2^-52, so that the turned parameters are not exact.
      const double u = std::ldexp(static_cast<double>(random() >> 12), -52);
      const double v = std::ldexp(static_cast<double>(random() >> 12), -52) * (1 - u);
      const double snapped = std::floor(v * 0x1p52) * 0x1p-52;
      if (u + snapped > 1) continue;
      const auto face = static_cast<std::uint32_t>(random() % twin.triangles.size());
      for (const oracle::LimitSample& s : oracle::sample_at(twin, face, u, snapped))
        expect_sample(patches[face], s);
    }
  }
}

TEST(limit_evaluator, answers_alike_whatever_it_met_before) {
  std::mt19937_64 random(17);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  LimitEvaluator reused;
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(17)) {
    Patches patches(twin);
    const Patch patch = patches[random() % twin.triangles.size()];
    reused.reset(patch);
    std::vector<Place> at;
    const auto add = [&](double u, double v) { at.push_back({0, 0, u, v}); };
    for (const auto& [u, v] :
         {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.5, 0.5}, {0x1p-70, 0.0}, {0.0, 0x1p-30}}) {
      add(u, v);
    }
    for (int i = 0; i < 150; ++i) {
      const double u = std::ldexp(unit(), -static_cast<int>(random() % 8));
      add(u, unit() * (1 - u));
    }
    std::vector<BoundedPoint> points(at.size());
    reused.points(at, points);
    for (std::size_t i = at.size(); i-- > 0;) {
      LimitEvaluator other(patch);
      const LimitFrame frame = reused.frame(at[i]), fresh_frame = LimitEvaluator(patch).frame(at[i]);
      for (const BoundedPoint& same :
           {evaluated(reused, at[i].u, at[i].v), evaluated(other, at[i].u, at[i].v)}) {
        EXPECT_EQ(points[i].position, same.position);
        EXPECT_EQ(points[i].error, same.error);
      }
      EXPECT_EQ(points[i].position, patch.origin + frame.point.relative);
      EXPECT_EQ(frame.tangents, fresh_frame.tangents);
      EXPECT_EQ(frame.tangent_error, fresh_frame.tangent_error);
      EXPECT_EQ(frame.normal, fresh_frame.normal);
    }
    EXPECT_LT(reused.bytes(), 2'000'000u);
  }
}

// u + v = 1 in doubles, but a little above it exactly: what is meant is the nearest point of the far edge.
TEST(limit_point, does_not_leave_the_triangle_where_a_sum_rounds_to_one) {
  for (const std::uint32_t n : {8u, 20u, 60u}) {
    const oracle::TwinMesh twin = oracle::meshes::wheel(n, oracle::Boundary::edge_only);
    Patches patches(twin);
    for (std::size_t f = 0; f < 3; ++f) {
      const Patch patch = patches[f];
      for (const TriangleParameter at : {TriangleParameter{9e-17, 1}, {1, 9e-17}, {0.75, 0.25 + 0x1p-54}}) {
        const RelativePoint point = limit_point(patch, at);
        const RelativePoint meant = limit_point(
            patch, at.u >= 0.5 ? TriangleParameter{at.u, 1 - at.u} : TriangleParameter{1 - at.v, at.v});
        EXPECT_EQ(point.relative, meant.relative) << n << " face " << f << " at " << at.u << ", " << at.v;
      }
    }
  }
}

TEST(limit_frame, has_derivatives_that_differences_confirm) {
  std::mt19937_64 random(14);
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(14)) {
    if (twin.boundary == oracle::Boundary::none) continue;
    Patches patches(twin);
    for (std::size_t f = 0; f < twin.triangles.size(); ++f) {
      const Patch patch = patches[f];
      const double u = 0.1 + 0.3 * static_cast<double>(random() >> 11) * 0x1p-53;
      const double v = 0.1 + 0.3 * static_cast<double>(random() >> 11) * 0x1p-53;
      const LimitFrame frame = limit_frame(patch, TriangleParameter{u, v});
      ASSERT_TRUE(frame.differentiable);
      const double h = 1e-6;
      const Vector3 du =
          (0.5 / h) * (limit_point(patch, {u + h, v}).relative - limit_point(patch, {u - h, v}).relative);
      const Vector3 dv =
          (0.5 / h) * (limit_point(patch, {u, v + h}).relative - limit_point(patch, {u, v - h}).relative);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(frame.tangents[0][k], du[k], 1e-5) << f;
        EXPECT_NEAR(frame.tangents[1][k], dv[k], 1e-5) << f;
      }
    }
  }
}

TEST(limit_frame, at_a_corner_is_the_limit_of_the_normals_around_it) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(15)) {
    if (twin.boundary == oracle::Boundary::none) continue;
    Patches patches(twin);
    for (std::size_t f = 0; f < twin.triangles.size(); ++f) {
      const Patch patch = patches[f];
      const double near = 0x1p-22;
      const TriangleParameter at[3] = {{0, 0}, {1, 0}, {0, 1}};
      const TriangleParameter by[3] = {{near, near}, {1 - 2 * near, near}, {near, 1 - 2 * near}};
      for (std::size_t c = 0; c < 3; ++c) {
        // Convergence goes with the ratio of two eigenvalues, which nears 1 at high valences.
        const CornerFan& fan = patch.kind->corner(patch.to_kind(c));
        if (fan.closed ? fan.faces() > 8 : fan.faces() < 3 || fan.faces() > 4) continue;
        const auto corner = limit_frame(patch, at[c]).normal, close = limit_frame(patch, by[c]).normal;
        ASSERT_TRUE(corner && close);
        EXPECT_GT(dot(*corner, *close), 0.99) << "face " << f << " corner " << c;
      }
    }
  }
}

TEST(limit_frame, has_no_normal_where_everything_is_flat_to_a_line) {
  oracle::TwinMesh line = oracle::meshes::icosahedron();
  for (oracle::Point& p : line.points) p = {p[0], 0, 0};
  Patches patches(line);
  EXPECT_FALSE(limit_frame(patches[0], TriangleParameter{0.25, 0.25}).normal);
  EXPECT_FALSE(limit_frame(patches[0], TriangleParameter{0, 0}).normal);
}

}  // namespace
}  // namespace snug::evaluate_test
