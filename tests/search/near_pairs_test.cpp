#include <snug/search/near_pairs.h>

#include <gtest/gtest.h>
#include <oracle/test_meshes.h>
#include <snug/patch/evaluate.h>
#include <testing/counts.h>
#include <testing/patches.h>
#include <testing/placements.h>

#include <array>
#include <cstdio>
#include <random>
#include <set>
#include <vector>

namespace snug::near_pairs_test {
namespace {

using Placed = std::array<long double, 3>;

// A surface of some size and place of its own, with a tree of one sort, and limit points of its patches.
struct Body {
  Body(std::mt19937_64& random, double size, const Vector3& by)
      : surface(testing::surface_of(made(random, size, by))),
        model(surface,
              {.tight = random() % 2 == 0, .threads = 1, .min_lazy = random() % 2 == 0 ? 1u : 8192u}),
        workspace(model) {
    const PowerOfTwo back = surface.scale().inverse();
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      const Patch patch = surface.patch(PatchId(p));
      auto& own = points.emplace_back();
      for (const TriangleParameter at :
           {TriangleParameter{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0, 0.5}, {0.5, 0.5}}) {
        own.push_back(back.apply(limit_point(patch, at).from(patch.origin).position));
      }
    }
  }
  static oracle::TwinMesh made(std::mt19937_64& random, double size, const Vector3& by) {
    auto mesh =
        oracle::meshes::disturbed(oracle::meshes::quartered(oracle::meshes::icosahedron()), 3, 0.2, random);
    for (auto& p : mesh.points)
      for (std::size_t k = 0; k < 3; ++k) p[k] = size * p[k] + by[k];
    return mesh;
  }
  [[nodiscard]] std::vector<std::vector<Placed>> placed(const Motion& pose) const {
    std::vector<std::vector<Placed>> all;
    for (const auto& own : points) {
      auto& out = all.emplace_back();
      for (const Point3& p : own) {
        Placed q;
        for (std::size_t k = 0; k < 3; ++k) {
          const Vector3 row = pose.row(k);
          q[k] = static_cast<long double>(row.x) * p.x + static_cast<long double>(row.y) * p.y +
                 static_cast<long double>(row.z) * p.z + pose.offset()[k];
        }
        out.push_back(q);
      }
    }
    return all;
  }

  LimitSurface surface;
  SurfaceBvh model;
  PieceCache workspace;
  std::vector<std::vector<Point3>> points;
};

long double apart(const std::vector<Placed>& a, const std::vector<Placed>& b) {
  long double least = INFINITY;
  for (const Placed& p : a) {
    for (const Placed& q : b) {
      const long double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
      least = std::min(least, x * x + y * y + z * z);
    }
  }
  return std::sqrt(least);
}

// Against all pairs of limit points: trees of three sorts, sizes of 1 to 2^-12 and away from their origins, distances of
// nothing to half a size.
TEST(near_pairs, pass_over_no_pair_of_patches_that_is_near) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t handed_out = 0, near_ones = 0, all = 0, used = 0;
  const std::size_t trials = testing::number_of("SNUG_PLACEMENTS", 120);
  for (std::size_t trial = 0; trial < trials; ++trial) {
    const double size = std::ldexp(1.0, -static_cast<int>(random() % 3 * 6)),
                 away = random() % 3 == 0 ? 3 : 0;
    Body a(random, 1, {away, 0, 0}), b(random, size, {0, away * size, 0});
    const Motion pose_a = testing::random_placement(random, {unit(random), unit(random), unit(random)});
    const Motion pose_b =
        testing::random_placement(random, {1.5 * unit(random), 1.5 * unit(random), unit(random)});
    const double distance = std::array{0.0, 1e-3, 0.1, 0.5}[random() % 4] * size;
    PairFrames frames({a.model, a.workspace, pose_a}, {b.model, b.workspace, pose_b});
    SearchStats stats;
    NearPairs near(frames, stats, frames.length_up(distance));
    if (!near.usable()) continue;
    ++used;
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (NodePair pair; near.next(pair);) {
      ASSERT_TRUE(pair.bounded());
      ASSERT_TRUE(found
                      .insert({a.workspace.name(pair.nodes[0]).patch.value(),
                               b.workspace.name(pair.nodes[1]).patch.value()})
                      .second)
          << "twice";
    }
    const auto in_a = a.placed(pose_a), in_b = b.placed(pose_b);
    const double others = frames.to_mesh_units().apply(near.others());
    for (std::uint32_t i = 0; i < in_a.size(); ++i) {
      for (std::uint32_t j = 0; j < in_b.size(); ++j) {
        const long double between = apart(in_a[i], in_b[j]);
        const bool is_found = found.contains({i, j});
        ++all;
        near_ones += between <= distance;
        handed_out += is_found;
        ASSERT_TRUE(is_found || between > distance) << trial << ": " << i << " and " << j;
        ASSERT_TRUE(is_found || others <= between + 1e-15L) << trial << ": " << i << " and " << j;
      }
    }
  }
  std::printf("  %zu of %zu walks; of %zu pairs %zu handed out, %zu near\n", used, trials, all, handed_out,
              near_ones);
  EXPECT_GT(used, trials / 2);
  EXPECT_GT(near_ones, 100u);
  EXPECT_LT(handed_out, all / 4);
}

// More wait than the walk has room for at first: every pair comes, and once.
TEST(near_pairs, come_once_each_where_many_wait) {
  const auto mesh = [] {
    oracle::TwinMesh made = oracle::meshes::icosahedron();
    for (int level = 0; level < 4; ++level) made = oracle::meshes::quartered(made);
    return made;
  }();
  const LimitSurface surface = testing::surface_of(mesh);
  const SurfaceBvh a(surface, {.threads = 1}), b(surface, {.threads = 1});
  PieceCache cache_a(a), cache_b(b);
  PairFrames frames({a, cache_a, Motion()}, {b, cache_b, Motion()});
  SearchStats stats;
  NearPairs near(frames, stats, frames.length_up(3));
  ASSERT_TRUE(near.usable());
  const std::size_t count = surface.patch_count();
  std::vector<bool> found(count * count);
  std::size_t pairs = 0;
  for (NodePair pair; near.next(pair); ++pairs) {
    const std::size_t i = a.patch(pair.nodes[0].owner, pair.nodes[0].place).index(),
                      j = b.patch(pair.nodes[1].owner, pair.nodes[1].place).index();
    ASSERT_FALSE(found[i * count + j]) << i << ' ' << j;
    found[i * count + j] = true;
  }
  EXPECT_EQ(pairs, count * count);
}

}  // namespace
}  // namespace snug::near_pairs_test
