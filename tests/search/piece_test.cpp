#include <snug/search/piece_cache.h>

#include <gtest/gtest.h>
#include <snug/bounds/table_triangle.h>
#include <snug/patch/evaluate.h>
#include <testing/containment.h>
#include <testing/counts.h>
#include <testing/patches.h>
#include <testing/pieces.h>
#include <testing/scheme_surfaces.h>

namespace snug::piece_test {
namespace {

TEST(piece, by_tables_has_the_offset_triangles_of_the_tables) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  testing::Pieces pieces(surface, BoundMethod::table);
  const testing::KnownPiece root = pieces.root(PatchId(0));
  for (unsigned child = 0; child < 4; ++child) {
    const Piece piece = pieces.child(root, child).piece;
    const BoundTable& table = surface.library().table(*piece.patch.kind);
    const OffsetTriangle expected = offset_triangle(table_triangle(table, piece.patch));
    EXPECT_EQ(piece.offset.base, expected.base);
    EXPECT_EQ(piece.offset.radius, expected.radius);
  }
}

// The box of a patch, from the root of the tree down.
Node node_of(PieceCache& workspace, PatchId patch) {
  std::vector<Node> nodes{workspace.root()};
  while (!nodes.empty()) {
    const Node node = nodes.back();
    nodes.pop_back();
    if (node.bounded() && workspace.name(node).patch == patch) return node;
    if (node.bounded()) continue;
    const PieceCache::Opened opened = workspace.open(node);
    for (std::size_t i = 0; i < opened.count(); ++i) nodes.push_back(opened.child(i));
  }
  throw std::logic_error("no such patch");
}

TEST(workspace, opens_to_the_same_pieces_in_any_order) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  const SurfaceBvh model(surface);
  PieceCache first(model), second(model);
  static_cast<void>(first.open(node_of(first, PatchId(3))));
  const Node root = node_of(first, PatchId(0));
  const auto a = first.open(root), b = second.open(node_of(second, PatchId(0)));
  ASSERT_EQ(a.count(), 4u);
  ASSERT_EQ(b.count(), 4u);
  for (unsigned child = 0; child < 4; ++child) {
    const Node x = a.child(child), y = b.child(child);
    EXPECT_EQ(first.patch(x).path, second.patch(y).path);
    EXPECT_EQ(x.boxes->origin(), y.boxes->origin());
    const PieceBounds &of_x = PieceCache::bounds_of(x), &of_y = PieceCache::bounds_of(y);
    EXPECT_EQ(of_x.radius(), of_y.radius());
    EXPECT_EQ(of_x.error(), of_y.error());
    EXPECT_EQ(of_x.base(x.boxes->origin()), of_y.base(y.boxes->origin()));
  }
  EXPECT_EQ(first.open(root).boxes, a.boxes);  // made once
}

TEST(piece, shrinks_until_rounding_stops_it) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  testing::Pieces pieces(surface);
  testing::KnownPiece known = pieces.root(PatchId(0));
  double before = known.piece.offset.radius;
  unsigned levels = 0;
  while (known.piece.can_split()) {
    known = pieces.child(known, 3);
    ASSERT_LE(known.piece.offset.radius, before);
    before = known.piece.offset.radius;
    ++levels;
  }
  EXPECT_GE(levels, 15u);
  EXPECT_LE(levels, PiecePath::max_level);
  EXPECT_LT(before, 1e-13);
}

// Limit points, corners and edges among them, against all that is fitted around pieces of any level.
TEST(piece, boxes_and_extents_hold_it) {
  std::mt19937_64 random(63);
  std::size_t samples = 0;
  testing::for_each_surface(63, [&](const testing::NamedSurface& named) {
    const LimitSurface& surface = named.surface;
    testing::Pieces rows(surface), tables(surface, BoundMethod::table);
    testing::for_each_patch(surface, [&](PatchId p) {
      if (random() % 4 != 0) return;
      for (testing::Pieces* const maker : {&rows, &tables}) {
        const testing::KnownPiece known = maker->below(p, random() % 4, random);
        const auto& [piece, heights, box] = known;
        const Vector3 direction{testing::unit(random) - 0.5, testing::unit(random) - 0.5,
                                testing::unit(random) - 0.5};
        const BoundingPoints& hull = maker->hull(known);
        const std::array<Extent, 2> extents{extent_of(hull, direction), extent_of(piece.offset, direction)};
        for (int i = 0; i < 12; ++i) {
          TriangleParameter at = testing::random_parameter(random);
          if (i < 3)
            at = std::array<TriangleParameter, 3>{{{0, 0}, {1, 0}, {0, 1}}}[static_cast<std::size_t>(i)];
          if (i >= 3 && i < 6) at.v = i == 3 ? 0 : 1 - at.u;
          const RelativePoint point = limit_point(piece.patch, at);
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
  EXPECT_GT(samples, testing::fewer(10'000));
}

// On needles the computed normal is far off, and the corners of the base triangle have heights of their own.
TEST(piece, heights_hold_those_of_needles) {
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
    testing::Pieces rows(surface), tables(surface, BoundMethod::table);
    for (testing::Pieces* const maker : {&rows, &tables}) {
      for (std::size_t f = 0; f < surface.face_count(); ++f) {
        const auto [piece, heights, box] = maker->below(PatchId(f), random() % 3, random);
        const Vector3 normal = unit_normal(piece.offset.base);
        for (int i = 0; i < 12; ++i) {
          const RelativePoint point = limit_point(piece.patch, testing::random_parameter(random));
          const auto extended = [&piece = piece, &point](std::size_t x) {
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
}  // namespace snug::piece_test
