#include <snug/search/pair_frames.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

namespace snug {
namespace {

using Placed = std::array<long double, 3>;

// Two triangles with a pose, and where their corners come to stand.
struct Body {
  LimitSurface surface;
  SurfaceBvh model;
  SurfaceWorkspace workspace;
  Motion pose;

  Body(const ControlMesh& mesh, const Motion& in_pose)
      : surface(mesh, {Scheme::flat}, std::make_shared<BoundsCache>(), 1),
        model(surface),
        workspace(model),
        pose(in_pose) {}
  [[nodiscard]] PlacedBvh at() { return {model, workspace, pose}; }
  [[nodiscard]] Placed corner(std::size_t v) const {
    const Point3& p = surface.mesh().points[v];
    Placed result;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 row = pose.row(i);
      result[i] = static_cast<long double>(row.x) * p.x + static_cast<long double>(row.y) * p.y +
                  static_cast<long double>(row.z) * p.z + pose.offset()[i];
    }
    return result;
  }
};

// No pair of corners is nearer than the outlines say, and those along the line of the middles are no farther.
TEST(outer_gap, is_at_most_the_distance_of_any_two_corners) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t positive = 0, tight = 0;
  for (int trial = 0; trial < 6000 && !HasFailure(); ++trial) {
    const std::array exponents{0, -400, 300, -950, 900, -30};
    const double scale = std::ldexp(1.0, exponents[random() % exponents.size()]);
    const auto body = [&](double far) {
      const double size = scale * std::ldexp(1.0, static_cast<int>(random() % 12) - 6);
      // Needles point at something; of few points many are the farthest along a direction.
      const std::array<double, 3> shape{size, size * (random() % 2 == 0 ? 1 : 1e-3), size};
      ControlMesh mesh;
      for (int v = 0; v < 6; ++v) {
        mesh.points.push_back({shape[0] * unit(random), shape[1] * unit(random), shape[2] * unit(random)});
      }
      mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
      mesh.add_face(std::array{VertexId(3), VertexId(4), VertexId(5)});
      const std::array<double, 4> turn{unit(random), unit(random), unit(random), 1.5};
      const Vector3 by{far * unit(random), far * unit(random), far * unit(random)};
      return Body(mesh, random() % 4 == 0 ? Motion::translation(by) : Motion::from_quaternion(turn, by));
    };
    const double far = scale * std::array{0.1, 3.0, 100.0, 1e9}[random() % 4];
    Body a = body(far), b = body(far);
    long double least = INFINITY, largest = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        const Placed p = a.corner(i), q = b.corner(j);
        least = std::min(least, std::hypot(std::hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]));
        for (std::size_t x = 0; x < 3; ++x) {
          largest = std::max({largest, std::fabs(p[x]), std::fabs(q[x])});
        }
      }
    }
    const double gap = outer_gap(a.at(), b.at());
    EXPECT_LE(static_cast<long double>(gap), least + 1e-17L * largest) << trial << ", scale " << scale;
    positive += gap > 0;
    tight += static_cast<long double>(gap) > 0.95L * least;
  }
  EXPECT_GT(positive, 3000u);
  EXPECT_GT(tight, 1000u);
}

}  // namespace
}  // namespace snug
