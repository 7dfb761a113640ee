#include <snug/search/pair_frames.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>
#include <testing/counts.h>
#include <testing/placed_points.h>

namespace snug::pair_frames_test {
namespace {

using Placed = std::array<long double, 3>;

// Two triangles with a pose, and where their corners come to stand.
struct Body {
  LimitSurface surface;
  SurfaceBvh model;
  PieceCache workspace;
  Motion pose;

  Body(const ControlMesh& mesh, const Motion& in_pose)
      : surface(mesh, {Scheme::flat}, std::make_shared<BoundsCache>()),
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
  for (int trial = 0; trial < static_cast<int>(testing::fewer(6000)) && !HasFailure(); ++trial) {
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
  EXPECT_GT(positive, testing::fewer(3000));
  EXPECT_GT(tight, testing::fewer(1000));
}

// A pose as far from rigid as is allowed, or turned by right angles so that axes are parallel, or any.
Motion any_pose(std::mt19937_64& random, double far) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Vector3 by{far * unit(random), far * unit(random), far * unit(random)};
  switch (random() % 4) {
    case 0:
      return Motion::translation(by);
    case 1:
      return Motion::rotation_degrees({0, 0, 1}, 90.0 * static_cast<double>(random() % 4)).with_offset(by);
    case 2:
      return Motion::from_quaternion({unit(random), unit(random), unit(random), 1.5}, by);
    default: {
      std::array<double, 12> numbers =
          Motion::from_quaternion({unit(random), unit(random), unit(random), 1.5}, by).numbers();
      const double grown = 1 + (random() % 2 == 0 ? 4.9e-10 : -4.9e-10);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) numbers[4 * i + j] *= grown;
      }
      return Motion::from_3x4(numbers);
    }
  }
}

// The corners of a cuboid, or points inside.
ControlMesh any_corners(std::mt19937_64& random, double scale) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double size = scale * std::ldexp(1.0, static_cast<int>(random() % 8) - 6);
  const std::array<double, 3> shape{size, size * (random() % 2 == 0 ? 1 : 1e-3),
                                    random() % 8 == 0 ? 0 : size};
  const bool cuboid = random() % 2 == 0, off = random() % 2 == 0;
  ControlMesh mesh;
  for (int v = 0; v < 9; ++v) {
    const auto along = [&](std::size_t k) {
      const double t = cuboid ? ((v >> k & 1) != 0 ? 1 : -1) : unit(random);
      return shape[k] * t + (off ? size : 0);
    };
    mesh.points.push_back({along(0), along(1), along(2)});
  }
  for (std::uint32_t v = 0; v < 9; v += 3) {
    mesh.add_face(std::array{VertexId(v), VertexId(v + 1), VertexId(v + 2)});
  }
  return mesh;
}

// Of the hulls of all corners, which lie in the balls and boxes; and how large numbers were for it.
std::pair<long double, long double> hull_distance(const Body& a, const Body& b, std::mt19937_64& random) {
  std::array<std::vector<Placed>, 2> placed;
  long double largest = 0;
  for (std::size_t v = 0; v < 9; ++v) {
    placed[0].push_back(a.corner(v));
    placed[1].push_back(b.corner(v));
    for (const auto& side : placed) {
      for (const long double x : side.back()) largest = std::max(largest, std::fabs(x));
    }
  }
  return {testing::distance_from_above(placed[0], placed[1], random), largest};
}

TEST(root_gap, is_at_most_the_distance_of_the_hulls_whatever_is_enough) {
  std::mt19937_64 random(22);
  std::size_t positive = 0, tight = 0, by_boxes = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(8000)) && !HasFailure(); ++trial) {
    const std::array exponents{0, 0, -400, 300, -498, 495, -950, 900, -30};
    const double scale = std::ldexp(1.0, exponents[random() % exponents.size()]);
    const double far = scale * std::array{0.0, 0.1, 1.0, 3.0, 100.0, 1e9}[random() % 6];
    const Vector3 common = random() % 4 == 0 ? Vector3{1e6 * scale, -3e5 * scale, 2e6 * scale} : Vector3{};
    const ControlMesh mesh = any_corners(random, scale);
    const auto pose = [&] {
      const Motion motion = any_pose(random, far);
      return motion.with_offset(motion.offset() + common);
    };
    // Equal boxes, or of other sizes.
    Body a(mesh, pose()), b(random() % 4 == 0 ? mesh : any_corners(random, scale), pose());
    const auto [least, largest] = hull_distance(a, b, random);
    const double apart = static_cast<double>(least);
    double best = -INFINITY;
    for (const double enough :
         std::array<double, 6>{-INFINITY, 0.0, 0.5 * apart, 0.999 * apart, 2 * apart, INFINITY}) {
      const double gap = root_gap(a.at(), b.at(), enough);
      EXPECT_LE(static_cast<long double>(gap), least + 1e-17L * largest) << trial << ", scale " << scale;
      best = std::max(best, gap);
    }
    positive += best > 0;
    tight += best > 0.95 * apart;
    by_boxes += best > 0 && !(root_gap(a.at(), b.at(), -INFINITY) > 0);
  }
  EXPECT_GT(positive, testing::fewer(3000));
  EXPECT_GT(tight, testing::fewer(1000));
  EXPECT_GT(by_boxes, testing::fewer(300));
}

// Rods and plates side by side, whose balls lie in each other: boxes tell at once, whatever is enough.
TEST(root_gap, of_rods_and_plates_side_by_side_is_that_of_their_boxes) {
  for (const double width : {0.1, 0.9}) {
    ControlMesh mesh;
    const Vector3 half{1, width, 0.1};
    for (int v = 0; v < 24; ++v) {
      const auto along = [&](std::size_t k) { return (v >> k & 1) != 0 ? half[k] : -half[k]; };
      mesh.points.push_back({along(0), along(1), along(2)});
    }
    for (std::uint32_t v = 0; v < 24; v += 3) {
      mesh.add_face(std::array{VertexId(v), VertexId(v + 1), VertexId(v + 2)});
    }
    Body a(mesh, Motion()), b(mesh, Motion().with_offset({0, 0, 0.25}));
    EXPECT_GT(root_gap(a.at(), b.at(), 0), 0.049) << width;
  }
}

// Boxes face to face and balls corner to corner, so near that roundings and what motions lack of rigidity decide.
TEST(root_gap, of_cuboids_that_nearly_touch_is_at_most_their_distance) {
  std::mt19937_64 random(24);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t positive = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(8000)) && !HasFailure(); ++trial) {
    const double size = std::ldexp(1.0, std::array{0, -400, 300, -30}[random() % 4]);
    ControlMesh mesh;
    const double own = random() % 2 == 0 ? 0 : 100 * size * unit(random);
    const Vector3 half{size, size / 2, size / 4};
    for (int v = 0; v < 24; ++v) {
      const auto along = [&](std::size_t k) { return own + ((v >> k & 1) != 0 ? half[k] : -half[k]); };
      mesh.points.push_back({along(0), along(1), along(2)});
    }
    for (std::uint32_t v = 0; v < 24; v += 3) {
      mesh.add_face(std::array{VertexId(v), VertexId(v + 1), VertexId(v + 2)});
    }
    const double step = 2 * (1 + std::pow(10.0, -3 - 12 * std::fabs(unit(random))));
    const double common = random() % 2 == 0 ? 0 : size * 1e6 * unit(random);
    const auto pose = [&](const Vector3& by) {
      std::array<double, 12> numbers{};
      const double grown = 1 + std::array{0.0, 4.9e-10, -4.9e-10}[random() % 3];
      for (std::size_t i = 0; i < 3; ++i) {
        numbers[5 * i] = grown;
        numbers[4 * i + 3] = by[i] + common - own;
      }
      return Motion::from_3x4(numbers);
    };
    const Vector3 by = random() % 2 == 0 ? Vector3{step * half.x, 0, 0}
                                         : Vector3{step * half.x, -step * half.y, step * half.z};
    Body a(mesh, pose({})), b(mesh, pose(random() % 2 == 0 ? by : -by));
    long double min_sq = 0, largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<std::pair<long double, long double>, 2> sides{
          {{INFINITY, -INFINITY}, {INFINITY, -INFINITY}}};
      for (std::size_t v = 0; v < 8; ++v) {
        for (const std::size_t s : {0u, 1u}) {
          const long double x = (s == 0 ? a : b).corner(v)[k];
          sides[s] = {std::min(sides[s].first, x), std::max(sides[s].second, x)};
          largest = std::max(largest, std::fabs(x));
        }
      }
      const long double gap =
          std::max({0.0L, sides[0].first - sides[1].second, sides[1].first - sides[0].second});
      min_sq += gap * gap;
    }
    double best = -INFINITY;
    for (const double enough : std::array<double, 3>{-INFINITY, 0.0, INFINITY}) {
      const double gap = root_gap(a.at(), b.at(), enough);
      EXPECT_LE(static_cast<long double>(gap), std::sqrt(min_sq) + 1e-18L * largest)
          << trial << ", size " << size;
      best = std::max(best, gap);
    }
    positive += best > 0;
  }
  EXPECT_GT(positive, testing::fewer(2000));
}

// Nothing but points, apart by so little that squares are among the last numbers, or none.
TEST(root_gap, of_points_is_at_most_their_distance) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> unit(-1, 1);
  ControlMesh mesh;
  for (int v = 0; v < 9; ++v) mesh.points.emplace_back();
  mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
  for (int exponent = -1070; exponent<1000; exponent += exponent> - 560 && exponent < -480 ? 1 : 10) {
    for (int trial = 0; trial < 4; ++trial) {
      const double far = std::ldexp(1.0, exponent);
      Body a(mesh, Motion::translation({far * unit(random), far * unit(random), far * unit(random)})),
          b(mesh, {});
      const auto [least, largest] = hull_distance(a, b, random);
      for (const double enough :
           std::array<double, 4>{-INFINITY, 0.0, static_cast<double>(least), INFINITY}) {
        EXPECT_LE(static_cast<long double>(root_gap(a.at(), b.at(), enough)), least + 1e-17L * largest)
            << exponent;
      }
    }
  }
}

}  // namespace
}  // namespace snug::pair_frames_test
