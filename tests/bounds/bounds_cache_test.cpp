#include <snug/bounds/bounds_cache.h>

#include <gtest/gtest.h>
#include <snug/bounds/bounding_points.h>
#include <support/parallel.h>
#include <testing/patches.h>
#include <testing/tagged.h>

#include <string>
#include <vector>

namespace snug::bounds_cache_test {
namespace {

TEST(bound_library, prepares_all_that_patches_of_a_kind_ask_for) {
  std::size_t refined = 0;
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    oracle::TaggedMesh creased = oracle::meshes::quad_grid(5, 5);
    if (scheme == Scheme::loop) creased = oracle::meshes::triangulated(creased);
    for (std::uint32_t k = 0; k < 5; ++k) creased.creases.push_back({12 + k, 13 + k, k < 2 ? 3.5 : 10});
    for (const ControlMesh& mesh :
         {testing::control_mesh(oracle::meshes::bipyramid(7)), testing::control_mesh(creased, {})}) {
      const LimitSurface surface(mesh, {scheme}, std::make_shared<BoundsCache>());
      BoundsCache& library = surface.library();
      for (std::size_t p = 0; p < surface.patch_count(); ++p)
        prepare_bounding_points(library, surface.kind(PatchId(p)));
      const std::size_t bytes = library.bytes(), kinds = library.kinds().size();
      BoundingPoints points;
      for (std::size_t p = 0; p < surface.patch_count(); ++p) {
        bounding_points(library, surface.patch(PatchId(p)), points);
        for (std::size_t round = 0; round < max_tip_refinements; ++round) {
          for (std::size_t tip = 0; tip < points.tips().size(); ++tip, ++refined)
            points.refine_tip(library, tip);
        }
      }
      EXPECT_EQ(library.bytes(), bytes);
      EXPECT_EQ(library.kinds().size(), kinds);
    }
  }
  EXPECT_GT(refined, 500u);
}

TEST(bound_library, hands_every_thread_the_same_rows_and_tables) {
  BoundsCache library;
  std::vector<const BoundingRows*> seen(400);
  std::vector<const BoundTable*> tables(400);
  parallel_for(seen.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto n = static_cast<std::uint16_t>(2 + i % 10);  // faces besides its own
      const Kind& kind =
          library.kinds().find({Scheme::loop, {CornerFan{0, 5}, CornerFan{0, 5}, CornerFan{0, n}}});
      seen[i] = &library.rows(kind);
      tables[i] = &library.table(kind);
    }
  });
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(tables[i], tables[i % 10]);
  EXPECT_NE(tables[0], tables[1]);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], seen[i % 10]);
  EXPECT_EQ(library.size(), 10u);
  EXPECT_GT(library.bytes(), 0u);
}

// Everything that bounding all patches of some surfaces makes of rows: with no tips, one and several, transient
// and high-valence.
std::vector<std::vector<double>> numbers_with(const std::shared_ptr<BoundsCache>& library) {
  std::vector<std::vector<double>> all;
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    for (const oracle::TwinMesh& twin :
         {oracle::meshes::icosahedron(), oracle::meshes::bipyramid(7), oracle::meshes::bipyramid(40)}) {
      const LimitSurface surface(testing::control_mesh(twin), {scheme}, library);
      BoundingPoints points;
      for (std::size_t p = 0; p < surface.patch_count(); ++p) {
        prepare_bounding_points(*library, surface.kind(PatchId(p)));
        bounding_points(*library, surface.patch(PatchId(p)), points);
        std::vector<double>& numbers = all.emplace_back(std::vector{points.error, points.largest});
        for (std::size_t i = 0; i < points.size(); ++i) {
          const Vector3 at = points.at(i);
          numbers.insert(numbers.end(), {at.x, at.y, at.z});
        }
      }
    }
  }
  // Quadratics beside a crease: rows of pieces are made while those of what they are pieces of are asked for.
  for (const auto scheme : {oracle::PrimalScheme::loop, oracle::PrimalScheme::catmull_clark}) {
    oracle::TaggedMesh mesh = oracle::meshes::quad_grid(4, 4);
    if (scheme == oracle::PrimalScheme::loop) mesh = oracle::meshes::triangulated(mesh);
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      mesh.points[v][2] = 0.1 * static_cast<double>(v * v % 7);
    for (std::uint32_t k = 0; k < 4; ++k) mesh.creases.push_back({10 + k, 11 + k, 4.5 + 0.3 * k});
    const oracle::Rules rules{.scheme = scheme};
    const LimitSurface surface(testing::control_mesh(mesh, rules), testing::options_of(rules), library);
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      const QuadraticTriangle q = quadratic_triangle(*library, surface.patch(PatchId(p)));
      all.push_back({q.error, q.normal_error, q.corners[1].x, q.middles[2].z});
    }
  }
  return all;
}

TEST(bound_library, keeps_no_more_rows_than_its_limit_and_bounds_are_the_same) {
  const auto whole = std::make_shared<BoundsCache>();
  const std::vector<std::vector<double>> expected = numbers_with(whole);
  std::size_t largest = 0;
  for (std::size_t most : {std::size_t{0}, std::size_t{1}, whole->bytes() / 3, whole->bytes()}) {
    const auto bounded = std::make_shared<BoundsCache>(most);
    EXPECT_EQ(numbers_with(bounded), expected) << most;
    EXPECT_LE(bounded->size(), whole->size());
    if (most == 0) {
      EXPECT_EQ(bounded->bytes(), 0u);
    }
    if (most == 1) largest = bounded->bytes();
    EXPECT_LT(bounded->bytes(), 2 * most + whole->bytes() / 2) << most;
    EXPECT_EQ(bounded->bytes() == whole->bytes(), most == whole->bytes());
  }
  EXPECT_GT(largest, 0u);
}

TEST(bound_library, beyond_its_limit_serves_all_threads) {
  const auto whole = std::make_shared<BoundsCache>(), bounded = std::make_shared<BoundsCache>(0);
  const auto expected = numbers_with(whole);
  std::vector<char> same(8);
  parallel_for(same.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) same[i] = numbers_with(bounded) == expected;
  });
  EXPECT_EQ(same, std::vector<char>(8, true));
}

}  // namespace
}  // namespace snug::bounds_cache_test
