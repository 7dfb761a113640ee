#include <snug/search/piece_cache.h>

#include <gtest/gtest.h>
#include <testing/scheme_surfaces.h>

#include <random>

namespace snug::piece_cache_test {
namespace {

// A patch, or a piece some levels below one.
Node some_node(PieceCache& cache, std::mt19937_64& random) {
  Node node = cache.root();
  for (std::size_t level = random() % 4; !node.bounded() || level > 0; level -= node.bounded()) {
    if (!PieceCache::can_open(node)) break;
    const PieceCache::Opened opened = cache.open(node);
    node = opened.child(random() % opened.count());
  }
  return node;
}

void expect_same(const Patch& patch, const OffsetTriangle& offset, const Piece& made) {
  EXPECT_EQ(patch.path, made.patch.path);
  EXPECT_EQ(patch.points, made.patch.points);
  EXPECT_EQ(offset.base, made.offset.base);
  EXPECT_EQ(offset.radius, made.offset.radius);
}

// By node, by name, and split by split: the same bits, whatever came before.
TEST(piece_cache, knows_a_piece_by_its_name_too) {
  std::mt19937_64 random(3);
  testing::for_each_surface(5, [&](const testing::NamedSurface& named) {
    SCOPED_TRACE(named.name);
    bool any = false;
    for (std::size_t p = 0; p < named.surface.patch_count(); ++p)
      any = any || named.surface.has_patch(PatchId(p));
    if (!any) return;
    // By rows, by tables, and by rows whatever the model has.
    const bool table = random() % 2 == 0, always_rows = random() % 2 == 0;
    const SurfaceBvh model(named.surface, {.method = table ? BoundMethod::table : BoundMethod::rows});
    const BoundMethod method = table && !always_rows ? BoundMethod::table : BoundMethod::rows;
    PieceCache cache(model, 50'000, always_rows);
    BoundingPoints scratch;
    for (int trial = 0; trial < 30; ++trial) {
      if (trial % 10 == 9) cache.begin(0);
      if (trial % 10 == 5) cache.renew(model);
      const Node node = some_node(cache, random);
      const PieceName name = cache.name(node);
      Patch patch = named.surface.patch(name.patch);
      for (unsigned k = 0; k < name.path.level(); ++k) patch = split(patch, name.path.digit(k));
      const Piece made = make_piece(named.surface.library(), name.patch, patch, scratch, method);
      expect_same(cache.patch(node), cache.offset(node), made);
      PieceCache other(model, 50'000, always_rows);
      expect_same(other.patch(name), other.offset(name), made);
      EXPECT_EQ(&cache.offset(name), &cache.offset(node));
      EXPECT_EQ(&cache.patch(name), &cache.patch(node));
    }
    // What was open is counted, and dropped with the pieces.
    cache.open_pairs().start(Order::last_first);
    for (int i = 0; i < 10'000; ++i) cache.open_pairs().add({});
    EXPECT_GT(cache.bytes(), 10'000 * sizeof(NodePair));
    cache.begin(0);
    EXPECT_LT(cache.bytes(), 100'000u);
  });
}

}  // namespace
}  // namespace snug::piece_cache_test
