#include <snug/bounds/table_triangle.h>

#include <gtest/gtest.h>
#include <snug/surface/limit_surface.h>
#include <testing/containment.h>
#include <testing/kinds.h>
#include <testing/patches.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace snug::table_triangle_test {
namespace {

using testing::Quad;

// The formula again, in quadruple precision from the patch's own doubles.
struct Exact {
  std::array<std::array<Quad, 3>, 3> lower, upper;  // corner of the table's triangle, axis
  Exact(const BoundTable& table, const Patch& patch) {
    for (std::size_t a = 0; a < 3; ++a) {
      const Quad c0 = patch.points[0][a], c1 = patch.points[1][a], c2 = patch.points[2][a];
      const auto l = [&](const LayoutPoint& u) {
        return (1 - Quad(u[0]) - Quad(u[1])) * c0 + Quad(u[0]) * c1 + Quad(u[1]) * c2;
      };
      for (std::size_t k = 0; k < 3; ++k) {
        lower[k][a] = upper[k][a] = l(table.triangle[k]) + Quad(patch.origin[a]);
        for (std::size_t i = 3; i < table.control_count(); ++i) {
          const Quad d = Quad(patch.points[i][a]) - l(table.layout[i]);
          const Quad up = table.upper[i - 3][k], low = table.lower[i - 3][k];
          lower[k][a] += d > 0 ? d * low : d * up;
          upper[k][a] += d > 0 ? d * up : d * low;
        }
      }
    }
  }
};

TEST(table_triangle, is_the_formula_rounded_outwards_by_little) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(41)) {
    const LimitSurface surface = testing::surface_of(twin);
    for (std::size_t f = 0; f < surface.face_count(); ++f) {
      if (!surface.has_patch(PatchId(f))) continue;
      const Patch patch = surface.patch(PatchId(f));
      const BoundTable& table = surface.library().table(*patch.kind);
      const Exact exact(table, patch);
      const TableTriangle found = table_triangle(table, patch);
      EXPECT_LT(found.rounding, 1e-11);
      for (std::size_t k = 0; k < 3; ++k) {
        const Box3& box = found.interval.corner[(k + patch.first) % 3];
        for (std::size_t a = 0; a < 3; ++a) {
          EXPECT_LE(Quad(box.lower[a]), exact.lower[k][a]);
          EXPECT_GE(Quad(box.upper[a]), exact.upper[k][a]);
          EXPECT_GE(Quad(box.lower[a]), exact.lower[k][a] - Quad(2 * found.rounding));
          EXPECT_LE(Quad(box.upper[a]), exact.upper[k][a] + Quad(2 * found.rounding));
        }
      }
    }
  }
}

// Linear precision: a flat patch laid out as the table has no thickness but rounding's.
TEST(table_triangle, of_an_affine_image_of_the_layout_is_a_triangle) {
  BoundsCache library;
  for (const KindKey& key : testing::assorted_kinds()) {
    const Kind& kind = library.kinds().find(key);
    const BoundTable& table = library.table(kind);
    std::vector<Point3> points;
    for (const LayoutPoint& u : table.layout)
      points.push_back({1 + 0.05 * u[0], 0.5 + 0.05 * u[1], 0.1 * u[0] - 0.07 * u[1]});
    const TableTriangle found = table_triangle(table, testing::patch_of(kind, points));
    for (const Box3& box : found.interval.corner) {
      EXPECT_LT(longest_side(box), 1e-11);
      EXPECT_LE(longest_side(box), 8 * found.rounding);
    }
  }
}

TEST(table_triangle, has_the_corners_of_the_patch_whatever_corner_its_kind_begins_with) {
  std::mt19937_64 random(42);
  const LimitSurface surface =
      testing::surface_of(oracle::meshes::disturbed(oracle::meshes::grid(5, 5), 6, 0.1, random));
  for (std::size_t f = 0; f < surface.face_count(); ++f) {
    const Patch patch = surface.patch(PatchId(f));
    const TableTriangle found = table_triangle(surface.library().table(*patch.kind), patch);
    const OffsetTriangle offset = offset_triangle(found);
    const auto corners = limit_corners(patch);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto distance_to = [&](std::size_t other) {
        return distance(offset.base[k], patch.origin + corners[other]);
      };
      EXPECT_LT(distance_to(k), distance_to((k + 1) % 3)) << f;
      EXPECT_LT(distance_to(k), distance_to((k + 2) % 3)) << f;
    }
  }
}

TEST(offset_of_a_table_triangle, contains_the_boxes_and_is_no_larger) {
  std::mt19937_64 random(43);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    TableTriangle triangle{{}, 1e-15};
    double largest = 0;
    for (Box3& box : triangle.interval.corner) {
      double sum = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const double side = unit(random) * std::pow(10.0, -trial % 20);
        box.lower[a] = 2 * unit(random) - 1;
        box.upper[a] = box.lower[a] + side;
        sum += 0.25 * (box.upper[a] - box.lower[a]) * (box.upper[a] - box.lower[a]);
      }
      largest = std::max(largest, std::sqrt(sum));
    }
    const OffsetTriangle offset = offset_triangle(triangle);
    EXPECT_LE(offset.radius, largest * (1 + 1e-12) + 1e-15);
    for (std::size_t k = 0; k < 3; ++k) {
      const Box3& box = triangle.interval.corner[k];
      for (int corner = 0; corner < 8; ++corner) {
        Quad distance_sq = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          const Quad d = Quad((corner >> a & 1) != 0 ? box.upper[a] : box.lower[a]) - Quad(offset.base[k][a]);
          distance_sq += d * d;
        }
        EXPECT_LE(distance_sq, Quad(offset.radius) * Quad(offset.radius));
      }
    }
  }
}

}  // namespace
}  // namespace snug::table_triangle_test
