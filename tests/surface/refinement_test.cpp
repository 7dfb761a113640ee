#include <snug/surface/refinement.h>

#include <gtest/gtest.h>
#include <snug/enclose/table_triangle.h>
#include <testing/containment.h>
#include <testing/patches.h>

namespace snug {
namespace {

TEST(refinement, by_tables_has_the_offset_triangles_of_the_tables) {
  const Surface surface = testing::surface_of(oracle::meshes::icosahedron());
  for (const TableLayout layout : {TableLayout::ngon, TableLayout::characteristic}) {
    Refinement refinement(surface, layout);
    const PieceId first = refinement.split(refinement.root(PatchId(0)));
    for (unsigned child = 0; child < 4; ++child) {
      const Piece& piece = refinement[PieceId(first.index() + child)];
      const BoundTable& table = surface.library().table(*piece.patch.kind, layout);
      const OffsetTriangle expected = offset_triangle(table_triangle(table, piece.patch));
      EXPECT_EQ(piece.offset.base, expected.base);
      EXPECT_EQ(piece.offset.radius, expected.radius);
    }
  }
}

TEST(refinement, does_not_depend_on_the_order_of_calls) {
  const Surface surface = testing::surface_of(oracle::meshes::icosahedron());
  Refinement first(surface), second(surface);
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
  const Surface surface = testing::surface_of(oracle::meshes::icosahedron());
  Refinement refinement(surface);
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

}  // namespace
}  // namespace snug
