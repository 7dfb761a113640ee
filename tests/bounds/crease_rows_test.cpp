#include <snug/bounds/crease_rows.h>

#include <gtest/gtest.h>
#include <snug/bounds/bounding_points.h>
#include <snug/bounds/layout.h>
#include <testing/patches.h>
#include <testing/tagged.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace snug::crease_rows_test {
namespace {

// A grid of 5 x 5 quads with a crease along one of the four lines of the middle one, face 12.
ControlMesh creased_grid(double sharpness, bool along_x, bool far, std::size_t edges = 5) {
  oracle::TaggedMesh mesh = oracle::meshes::quad_grid(5, 5);
  for (std::uint32_t i = 0; i < edges; ++i) {
    const std::uint32_t line = far ? 3 : 2;
    const auto at = [&](std::uint32_t k) { return along_x ? k + 6 * line : line + 6 * k; };
    mesh.creases.push_back({at(i), at(i + 1), sharpness});
  }
  return testing::control_mesh(mesh);
}

LimitSurface surface_of(ControlMesh mesh, CreaseMethod method = CreaseMethod::uniform) {
  mesh.tags.crease_method = method;
  return LimitSurface(std::move(mesh), {Scheme::catmark}, std::make_shared<BoundsCache>());
}

// Three nets of numbers at once: where nothing is zero, and where one control point alone is not.
Patch numbers_on(const Kind& kind, std::mt19937_64& random) {
  Patch patch;
  patch.kind = &kind;
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < kind.control_count(); ++i) {
    patch.points.push_back({normal(random), normal(random), i == random() % 16 ? 1.0 : 0.0});
    patch.largest = std::max(patch.largest, max_abs(patch.points.back()));
  }
  return patch;
}

struct Extent {
  Vector3 lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};
  void add(const Vector3& p) {
    for (std::size_t a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], p[a]);
      upper[a] = std::max(upper[a], p[a]);
    }
  }
};

Vector3 point_of(const BoundingRows& rows, std::size_t r, const Patch& patch) {
  Vector3 point;
  for (std::size_t c = 0; c < patch.points.size(); ++c) point = point + rows.weight(r, c) * patch.points[c];
  return point;
}

Extent extent_of(const BoundingRows& rows, const Patch& patch) {
  Extent extent;
  for (std::size_t r = 0; r < rows.count(); ++r) extent.add(point_of(rows, r, patch));
  return extent;
}

// Dense beside the crease and at its ends.
std::vector<TriangleParameter> parameters(std::mt19937_64& random) {
  std::vector<TriangleParameter> all;
  const auto add = [&](double w, double u, double v) {
    const double sum = w + u + v;
    if (u / sum + v / sum <= 1) all.push_back({u / sum, v / sum});
  };
  for (std::size_t i = 0; i < 400; ++i) {
    std::array<double, 3> weight;
    for (double& w : weight) {
      const double unit = static_cast<double>(random() >> 11) * 0x1p-53;
      w = random() % 3 == 0 ? std::ldexp(unit, -static_cast<int>(random() % 11)) : unit;
    }
    add(weight[0], weight[1], weight[2]);
  }
  for (const TriangleParameter corner : {TriangleParameter{0, 0}, {1, 0}, {0, 1}}) all.push_back(corner);
  for (int i = 1; i < 32; ++i) {
    all.push_back({i / 32.0, 0});
    all.push_back({0, i / 32.0});
    all.push_back({i / 32.0, 1 - i / 32.0});
  }
  return all;
}

std::vector<const Kind*> kinds_of_middle(const LimitSurface& surface) {
  const auto [begin, end] = surface.patches_of(12);
  std::vector<const Kind*> kinds;
  for (std::size_t p = begin; p < end; ++p) kinds.push_back(&surface.kind(PatchId(p)));
  return kinds;
}

TEST(crease_rows, hold_the_limit_patch_and_little_more) {
  std::mt19937_64 random(71);
  std::size_t checked = 0, edges = 0;
  for (const double sharpness : {2.0, 2.3, 3.0, 4.75, 6.0, 8.5, 9.0}) {
    for (const bool along_x : {true, false}) {
      for (const bool far : {true, false}) {
        const LimitSurface surface = surface_of(creased_grid(sharpness, along_x, far));
        for (const Kind* kind : kinds_of_middle(surface)) {
          const CreaseRows made = make_crease_rows(*kind);
          ASSERT_TRUE(made.rows) << sharpness;
          edges += made.rows->count() < 80;
          for (int trial = 0; trial < 20; ++trial) {
            const Patch patch = numbers_on(*kind, random);
            const Extent hull = extent_of(*made.rows, patch);
            const double error = made.rows->result_error(patch.largest, 0);
            EXPECT_LT(error, 1e-13);
            Extent limit;
            for (const TriangleParameter& at : parameters(random)) {
              const RelativePoint point = limit_point(patch, at);
              limit.add(point.relative);
              for (std::size_t a = 0; a < 3; ++a) {
                ASSERT_GE(point.relative[a], hull.lower[a] - error - point.error) << sharpness;
                ASSERT_LE(point.relative[a], hull.upper[a] + error + point.error) << sharpness;
              }
            }
            // Bezier points of bicubics as triangles: about 1/3 of what a random net varies by.
            for (std::size_t a = 0; a < 2; ++a) {
              const double size = limit.upper[a] - limit.lower[a];
              EXPECT_LT(hull.upper[a] - hull.lower[a], 2 * size + 0.5) << sharpness;
            }
            ++checked;
          }
        }
      }
    }
  }
  EXPECT_EQ(checked, 7u * 4 * 2 * 20);
  EXPECT_GT(edges, 0u);
}

using Quadratic = std::array<Vector3, 6>;

Vector3 value_at(const Quadratic& q, const TriangleParameter& at) {
  const std::array<double, 3> w{1 - at.u - at.v, at.u, at.v};
  Vector3 value;
  for (std::size_t k = 0; k < 3; ++k) {
    value = value + (w[k] * w[k]) * q[k] + (2 * w[k] * w[(k + 1) % 3]) * q[3 + k];
  }
  return value;
}

Vector3 difference(const BoundingRows& rows, std::size_t r, const Patch& patch, const Quadratic& q) {
  Vector3 rest = point_of(rows, r, patch);
  for (std::size_t k = 0; k < 6; ++k) rest = rest - rows.quadratic(k)[r] * q[k];
  return rest;
}

// Whatever the net and the quadratic, the patch less the quadratic lies in the hull of what rows have of both.
TEST(crease_rows, hold_the_patch_less_a_quadratic) {
  std::mt19937_64 random(72);
  std::normal_distribution<double> normal;
  std::size_t checked = 0;
  for (const double sharpness : {2.0, 3.4, 7.0}) {
    for (const bool along_x : {true, false}) {
      for (const bool far : {true, false}) {
        const LimitSurface surface = surface_of(creased_grid(sharpness, along_x, far));
        for (const Kind* kind : kinds_of_middle(surface)) {
          const CreaseRows made = make_crease_rows(*kind);
          ASSERT_TRUE(made.rows && made.rows->nets().empty());
          ASSERT_EQ(made.rows->bezier_count(), made.rows->count());
          for (int trial = 0; trial < 20; ++trial) {
            const Patch patch = numbers_on(*kind, random);
            Quadratic q;
            for (Vector3& p : q) p = {10 * normal(random), normal(random), normal(random)};
            Extent hull;
            for (std::size_t r = 0; r < made.rows->count(); ++r)
              hull.add(difference(*made.rows, r, patch, q));
            for (const TriangleParameter& at : parameters(random)) {
              const RelativePoint point = limit_point(patch, at);
              const Vector3 rest = point.relative - value_at(q, at);
              for (std::size_t a = 0; a < 3; ++a) {
                ASSERT_GE(rest[a], hull.lower[a] - 1e-12 - point.error) << sharpness;
                ASSERT_LE(rest[a], hull.upper[a] + 1e-12 + point.error) << sharpness;
              }
            }
            ++checked;
          }
        }
      }
    }
  }
  EXPECT_EQ(checked, 3u * 4 * 2 * 20);
}

// Squares along the crease, and products, are quadratics of the lattice that every crease keeps: nothing is left of them.
TEST(crease_rows, leave_nothing_of_quadratics_that_are_met_exactly) {
  for (const double sharpness : {2.0, 2.5, 6.0}) {
    for (const bool along_x : {true, false}) {
      for (const bool far : {true, false}) {
        const LimitSurface surface = surface_of(creased_grid(sharpness, along_x, far));
        for (const Kind* kind : kinds_of_middle(surface)) {
          const CreaseRows made = make_crease_rows(*kind);
          ASSERT_TRUE(made.rows);
          Patch patch;
          patch.kind = kind;
          for (const auto& [u, v] : lattice_layout(*kind)) {
            const double x = u + v, y = v;
            patch.points.push_back({x * x - 1.0 / 3, y * y - 1.0 / 3, x * y});
          }
          constexpr std::array<std::array<double, 2>, 3> corner{{{0, 0}, {1, 0}, {1, 1}}};  // x and y
          Quadratic q;
          for (std::size_t k = 0; k < 6; ++k) {
            const auto [ax, ay] = corner[k % 3];
            const auto [bx, by] = k < 3 ? corner[k] : corner[(k + 1) % 3];
            q[k] = {ax * bx, ay * by, (ax * by + bx * ay) / 2};
          }
          Vector3 most;
          for (std::size_t r = 0; r < made.rows->count(); ++r) {
            const Vector3 rest = difference(*made.rows, r, patch, q);
            for (std::size_t a = 0; a < 3; ++a) most[a] = std::max(most[a], std::fabs(rest[a]));
          }
          EXPECT_LT(std::min(most.x, most.y), 1e-13) << sharpness;
          EXPECT_GT(std::max(most.x, most.y), 1e-2) << "the crease is there";
          EXPECT_LT(most.z, 1e-13) << sharpness;
        }
      }
    }
  }
}

// A ridge seen from the side: the crease, and not much behind it, bounds the height.
TEST(crease_rows, see_how_round_the_crease_is) {
  for (const double sharpness : {2.0, 3.5, 6.0, 9.0}) {
    ControlMesh mesh = creased_grid(sharpness, true, false);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      mesh.points[v].z = -std::fabs(static_cast<double>(v / 6) - 2);
    }
    const LimitSurface surface = surface_of(mesh);
    const auto [begin, end] = surface.patches_of(12);
    for (std::size_t p = begin; p < end; ++p) {
      const Patch patch = surface.patch(PatchId(p));
      const CreaseRows made = make_crease_rows(*patch.kind);
      double highest = -INFINITY, seen = -INFINITY;
      for (std::size_t r = 0; r < made.rows->count(); ++r) {
        highest = std::max(highest, point_of(*made.rows, r, patch).z);
      }
      for (int i = 0; i <= 64; ++i) {
        for (const TriangleParameter at : {TriangleParameter{i / 64.0, 0}, {0, i / 64.0}}) {
          seen = std::max(seen, limit_point(patch, at).relative.z);
        }
      }
      EXPECT_GT(highest, seen - 1e-12);
      EXPECT_LT(highest, seen + 1e-12);
    }
  }
}

TEST(crease_rows, are_none_where_anything_else_is_about) {
  const auto none = [](const LimitSurface& surface) {
    for (const Kind* kind : kinds_of_middle(surface)) {
      if (make_crease_rows(*kind).rows) return false;
    }
    return true;
  };
  EXPECT_TRUE(none(surface_of(creased_grid(1.5, true, false))));
  EXPECT_TRUE(none(surface_of(creased_grid(infinite_sharpness, true, false))));
  EXPECT_TRUE(none(surface_of(creased_grid(6, true, false, 3))));  // ends at the quad
  EXPECT_FALSE(none(surface_of(creased_grid(6, true, false, 4))));
  ControlMesh mesh = creased_grid(6, true, false);
  mesh.tags.creases[2].sharpness = 5;
  EXPECT_TRUE(none(surface_of(mesh)));
  mesh = creased_grid(6, true, false);
  mesh.tags.creases[4].sharpness = 5;  // beyond
  EXPECT_FALSE(none(surface_of(mesh)));
  EXPECT_TRUE(none(surface_of(mesh, CreaseMethod::chaikin)));
  mesh = creased_grid(6, true, false);
  mesh.tags.creases.push_back({VertexId(20), VertexId(26), 6});  // across
  EXPECT_TRUE(none(surface_of(mesh)));
  mesh = creased_grid(6, true, false);
  mesh.tags.corners.push_back({VertexId(21), 3});
  EXPECT_TRUE(none(surface_of(mesh)));
  mesh = creased_grid(6, true, false);
  for (const CreaseTag& crease : creased_grid(6, true, true).tags.creases)
    mesh.tags.creases.push_back(crease);
  EXPECT_TRUE(none(surface_of(mesh)));  // on both sides
}

}  // namespace
}  // namespace snug::crease_rows_test
