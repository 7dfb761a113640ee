#include <snug/search/piece.h>

#include <gtest/gtest.h>
#include <snug/bounds/table_triangle.h>
#include <snug/patch/evaluate.h>
#include <testing/containment.h>
#include <testing/patches.h>
#include <testing/scheme_surfaces.h>

namespace snug {
namespace {

TEST(refinement, by_tables_has_the_offset_triangles_of_the_tables) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  PieceCache refinement(surface, BoundMethod::table);
  const PieceId first = refinement.split(refinement.root(PatchId(0)));
  for (unsigned child = 0; child < 4; ++child) {
    const Piece& piece = refinement[PieceId(first.index() + child)];
    const BoundTable& table = surface.library().table(*piece.patch.kind);
    const OffsetTriangle expected = offset_triangle(table_triangle(table, piece.patch));
    EXPECT_EQ(piece.offset.base, expected.base);
    EXPECT_EQ(piece.offset.radius, expected.radius);
  }
}

TEST(refinement, does_not_depend_on_the_order_of_calls) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  PieceCache first(surface), second(surface);
  static_cast<void>(first.split(first.root(PatchId(3))));
  const PieceId a = first.split(first.root(PatchId(0)));
  const PieceId b = second.split(second.root(PatchId(0)));
  for (unsigned child = 0; child < 4; ++child) {
    const Piece& x = first[PieceId(a.index() + child)];
    const Piece& y = second[PieceId(b.index() + child)];
    EXPECT_EQ(x.patch.path, y.patch.path);
    EXPECT_EQ(x.offset.radius, y.offset.radius);
    EXPECT_EQ(x.offset.base[1], y.offset.base[1]);
  }
  EXPECT_EQ(first.split(first.root(PatchId(0))), a);  // made once
}

TEST(refinement, shrinks_radii_until_rounding_stops_it) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  PieceCache refinement(surface);
  PieceId id = refinement.root(PatchId(0));
  double before = refinement[id].offset.radius;
  unsigned levels = 0;
  while (refinement.can_split(id)) {
    id = PieceId(refinement.split(id).index() + 3);
    ASSERT_LE(refinement[id].offset.radius, before);
    before = refinement[id].offset.radius;
    ++levels;
  }
  EXPECT_GE(levels, 15u);
  EXPECT_LE(levels, PiecePath::max_level);
  EXPECT_LT(before, 1e-13);
}

// Limit points, corners and edges among them, against all that is fitted around pieces of any level.
TEST(refinement, boxes_and_extents_hold_the_pieces) {
  std::mt19937_64 random(63);
  std::size_t samples = 0;
  testing::for_each_surface(63, [&](const testing::NamedSurface& named) {
    const LimitSurface& surface = named.surface;
    PieceCache rows(surface), tables(surface, BoundMethod::table);
    testing::for_each_patch(surface, [&](PatchId p) {
      if (random() % 4 != 0) return;
      for (PieceCache* refinement : {&rows, &tables}) {
        PieceId id = refinement->root(p);
        for (std::size_t level = random() % 4; level > 0 && refinement->can_split(id); --level) {
          id = PieceId(refinement->split(id).index() + random() % 4);
        }
        const Obb& box = refinement->box(id);
        const Vector3 direction{testing::unit(random) - 0.5, testing::unit(random) - 0.5,
                                testing::unit(random) - 0.5};
        const HullPoints& hull = refinement->hull(id);
        const Piece& piece = (*refinement)[id];
        const std::array<Extent, 2> extents{extent_of(hull, direction), extent_of(piece.offset, direction)};
        for (int i = 0; i < 12; ++i) {
          TriangleParameter at = testing::random_parameter(random);
          if (i < 3)
            at = std::array<TriangleParameter, 3>{{{0, 0}, {1, 0}, {0, 1}}}[static_cast<std::size_t>(i)];
          if (i >= 3 && i < 6) at.v = i == 3 ? 0 : 1 - at.u;
          const LimitPoint point = limit_point(piece.patch, at);
          const Point3 x = piece.patch.origin + point.relative;
          const double error = 2 * point.error + 1e-15;
          ++samples;
          for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_LE(std::fabs(dot(box.axes[k], x - box.centre)), box.half[k] + error) << named.name;
          }
          for (const Extent& extent : extents) {
            ASSERT_LE(extent.lower, dot(direction, x - Point3{}) + error) << named.name;
            ASSERT_GE(extent.upper, dot(direction, x - Point3{}) - error) << named.name;
          }
        }
      }
    });
  });
  EXPECT_GT(samples, 10'000u);
}

// On needles the computed normal is far off, and the corners of the base triangle have heights of their own.
TEST(refinement, heights_hold_pieces_of_needles) {
  std::mt19937_64 random(65);
  double largest = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double width = std::exp2(-10 - 30 * testing::unit(random)), depth = width * testing::unit(random);
    std::array<Vector3, 3> axes;
    for (Vector3& axis : axes) {
      axis = {testing::unit(random) - 0.5, testing::unit(random) - 0.5, testing::unit(random) - 0.5};
    }
    oracle::TwinMesh mesh = oracle::meshes::disturbed(oracle::meshes::grid(3, 3), 2, 0.2, random);
    for (oracle::Point& p : mesh.points) {
      const Vector3 x = p[0] * axes[0] + width * p[1] * axes[1] + depth * p[2] * axes[2];
      p = {x.x, x.y, x.z};
    }
    const LimitSurface surface = testing::surface_of(mesh);
    PieceCache rows(surface), tables(surface, BoundMethod::table);
    for (PieceCache* const refinement : {&rows, &tables}) {
      for (std::size_t f = 0; f < surface.face_count(); ++f) {
        PieceId id = refinement->root(PatchId(f));
        for (std::size_t level = random() % 3; level > 0; --level) {
          id = PieceId(refinement->split(id).index() + random() % 4);
        }
        const Piece& piece = (*refinement)[id];
        const Vector3 normal = unit_normal(piece.offset.base);
        const Heights& heights = refinement->heights(id);
        for (int i = 0; i < 12; ++i) {
          const LimitPoint point = limit_point(piece.patch, testing::random_parameter(random));
          const auto extended = [&](std::size_t x) {
            return static_cast<long double>(piece.patch.origin[x]) + point.relative[x] -
                   piece.offset.base[0][x];
          };
          const long double height = normal.x * extended(0) + normal.y * extended(1) + normal.z * extended(2);
          const double error = 2 * point.error + 1e-18;
          ASSERT_LE(heights.lower, height + error) << trial;
          ASSERT_GE(heights.upper, height - error) << trial;
          largest = std::max(largest, std::fabs(static_cast<double>(height)) / piece.offset.radius);
        }
      }
    }
  }
  EXPECT_GT(largest, 2);  // or the trials miss what they are made for
}

}  // namespace
}  // namespace snug
