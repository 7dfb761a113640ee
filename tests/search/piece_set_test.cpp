#include <snug/search/piece_set.h>

#include <gtest/gtest.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/search/feet.h>
#include <testing/scheme_surfaces.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>

namespace snug::piece_set_test {
namespace {

// Each patch is all there, once: parts of level l count 4^-l.
void expect_whole(const LimitSurface& surface, const PieceSet& pieces) {
  std::map<std::uint32_t, double> shares;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    shares[pieces.name(i).patch.value()] += std::ldexp(1, -2 * static_cast<int>(pieces.name(i).path.level()));
  }
  std::size_t there = 0;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) there += surface.has_patch(PatchId(p));
  EXPECT_EQ(shares.size(), there);
  for (const auto& [root, share] : shares) EXPECT_NEAR(share, 1, 1e-12) << root;
}

void expect_near(const LimitSurface& surface, const PieceSet& pieces, double error, std::mt19937_64& random) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_LE(pieces[i].error, error);
    const PieceName& name = pieces.name(i);
    Patch patch = surface.patch(name.patch);
    for (unsigned l = 0; l < name.path.level(); ++l) patch = split(patch, name.path.digit(l));
    const TriangleParameter at = testing::random_parameter(random);
    const RelativePoint point = limit_point(patch, at);
    EXPECT_LE(distance(point.from(patch.origin).position, point_of(pieces[i], at)),
              pieces[i].error + spatial_error(point.error) + 1e-15);
    const Patch whole = surface.patch(name.patch);
    EXPECT_EQ(pieces.point(i, at).position,
              limit_point(whole, to_face(name.path, at)).from(whole.origin).position);
  }
}

TEST(piece_set, are_the_surface_up_to_their_errors) {
  std::mt19937_64 random(9);
  testing::for_each_surface(3, [&](const testing::NamedSurface& named) {
    SCOPED_TRACE(named.name);
    const LimitSurface& surface = named.surface;
    const PieceSet pieces(surface, 1e-2, 1);
    expect_whole(surface, pieces);
    expect_near(surface, pieces, 1e-2, random);
    std::vector<std::uint8_t> which(pieces.size());
    for (auto& mark : which) mark = random() % 2;
    PieceSet finer = pieces;
    const std::vector<std::uint32_t> origins = finer.refine(which, 1e-4, 2);
    expect_whole(surface, finer);
    ASSERT_EQ(origins.size(), finer.size());
    for (std::size_t i = 0; i < finer.size(); ++i) {
      const PieceName &part = finer.name(i), &of = pieces.name(origins[i]);
      EXPECT_EQ(part.patch, of.patch);
      EXPECT_EQ(part.path.ancestor(of.path.level()), of.path);
      if (which[origins[i]] != 0) {
        EXPECT_LE(finer[i].error, 1e-4);
      } else {
        EXPECT_EQ(part, of);
      }
    }
    expect_near(surface, finer, 1e-2, random);
    // Too many, and all stays.
    PieceSet same = finer;
    EXPECT_TRUE(same.refine(std::vector<std::uint8_t>(same.size(), 1), 1e-7, 2, {}, same.size()).empty());
    EXPECT_EQ(same.size(), finer.size());
    EXPECT_EQ(PieceSet(surface, 1e-2, 1, {}, 1).size(), 0u);
  });
}

// As refine() makes them, whatever order patches have.
TEST(piece_set, of_some_patches_are_made_finer_by_name) {
  std::mt19937_64 random(10);
  testing::for_each_surface(3, [&](const testing::NamedSurface& named) {
    SCOPED_TRACE(named.name);
    const LimitSurface& surface = named.surface;
    PieceSet all(surface, 1e-2, 1);
    if (all.size() == 0) return;
    std::vector<std::uint8_t> which(all.size());
    PieceSet::FinerPieces finer;
    for (std::size_t i = 0; i < all.size(); ++i) {
      which[i] = random() % 2;
      if (which[i] != 0) finer[all.name(i)] = 1e-4;
    }
    ASSERT_FALSE(all.refine(which, 1e-4, 1).empty());
    std::map<PieceName, QuadraticTriangle> known;
    for (std::size_t i = 0; i < all.size(); ++i) known[all.name(i)] = all[i];
    std::vector<PatchId> patches;
    for (std::size_t p = surface.patch_count(); p-- > 0;) {
      if (surface.has_patch(PatchId(p))) patches.push_back(PatchId(p));
    }
    std::size_t count = 0;
    const std::size_t half = (patches.size() + 1) / 2;
    for (std::size_t begin = 0; begin < patches.size(); begin += half) {
      const std::span some = std::span(patches).subspan(begin, std::min(half, patches.size() - begin));
      const PieceSet set(surface, some, 1e-2, finer, 2, {}, UINT64_MAX);
      count += set.size();
      const Box3 box = set.box();
      for (std::size_t i = 0; i < set.size(); ++i) {
        const QuadraticTriangle& same = known.at(set.name(i));
        EXPECT_EQ(points_of(set[i]), points_of(same));
        EXPECT_LE(std::fabs(set[i].error - same.error), 1e-300);
        const Point3 p = point_of(same, testing::random_parameter(random));
        for (std::size_t a = 0; a < 3; ++a) {
          EXPECT_LE(box.lower[a], p[a] - same.error);
          EXPECT_GE(box.upper[a], p[a] + same.error);
        }
      }
      EXPECT_EQ(PieceSet(surface, some, 1e-2, finer, 1, {}, set.size() - 1).size(), 0u);
    }
    EXPECT_EQ(count, all.size());
  });
}

// By names, or three points in a row: the same as quadratics without bends.
TEST(piece_set, of_triangles_are_where_their_points_are) {
  std::mt19937_64 random(12);
  const auto unit = [&] { return testing::unit(random); };
  std::vector<Point3> points;
  for (int i = 0; i < 90; ++i) points.push_back({unit(), unit(), unit()});
  std::vector<std::array<std::uint32_t, 3>> names;
  for (std::uint32_t i = 0; i < 30; ++i) names.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  const PowerOfTwo half(-1);
  PieceSet named(points, names, half), in_a_row(points, {}, half);
  std::vector<QuadraticTriangle> flat;
  for (const auto& [a, b, c] : names)
    flat.push_back(flat_quadratic({half.apply(points[a]), half.apply(points[b]), half.apply(points[c])}));
  PieceSet given(flat);
  for (PieceSet* const set : {&named, &in_a_row, &given}) set->prepare(1);
  ASSERT_EQ(named.size(), 30u);
  ASSERT_EQ(in_a_row.size(), 30u);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_EQ(points_of(named[i]), points_of(flat[i]));
    EXPECT_EQ(points_of(in_a_row[i]), points_of(flat[i]));
    EXPECT_EQ(named.error(i), 0);
  }
  for (int trial = 0; trial < 100; ++trial) {
    const Point3 p{unit(), unit(), unit()};
    const QuadraticFoot foot = nearest_foot(given, p);
    for (const PieceSet* const set : {&named, &in_a_row}) {
      const QuadraticFoot same = nearest_foot(*set, p);
      EXPECT_EQ(same.piece, foot.piece);
      EXPECT_EQ(same.point, foot.point);
    }
  }
}

TEST(piece_set, of_triangles_stays_as_it_is) {
  PieceSet set(std::vector{flat_quadratic({Point3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})});
  const std::vector<std::uint8_t> which{1};
  EXPECT_TRUE(set.refine(which, 0, 1).empty());
  EXPECT_EQ(set.size(), 1u);
  EXPECT_FALSE(set.is_surface());
  EXPECT_FALSE(set.place(0, {0.25, 0.25}).has_value());
  EXPECT_EQ(set.point(0, {0.25, 0.25}).position, (Point3{0.25, 0.25, 0}));
}

// Each is visited, about the nearest first; one that is beyond the reach, which may shrink, is not.
TEST(piece_set, visits_what_is_near) {
  std::mt19937_64 random(11);
  const auto unit = [&] { return testing::unit(random); };
  for (const std::size_t count : {1, 7, 8, 9, 64, 65, 700}) {
    std::vector<QuadraticTriangle> flat;
    for (std::size_t i = 0; i < count; ++i) {
      const Point3 o{unit(), unit(), unit()};
      flat.push_back(flat_quadratic({o, o + Vector3{0.01, 0, 0}, o + Vector3{0, 0.01, 0}}));
    }
    PieceSet set(flat);
    set.prepare(2);
    for (int trial = 0; trial < 20; ++trial) {
      const Point3 p{unit(), unit(), unit()};
      double reach = unit();
      std::vector<bool> visited(count, false);
      EXPECT_FALSE(set.visit_near(p, reach, [&](std::uint32_t piece) {
        EXPECT_FALSE(visited[piece]);
        visited[piece] = true;
        return false;
      }));
      for (std::size_t i = 0; i < count; ++i) {
        if (visited[i]) continue;
        EXPECT_GT(distance(flat[i].corners[0], p), reach);
      }
      double nearest = INFINITY;
      set.visit_near(p, nearest, [&](std::uint32_t piece) {
        nearest = std::min(nearest, distance(flat[piece].corners[0], p));
        return false;
      });
      double least = INFINITY;
      for (const QuadraticTriangle& q : flat) least = std::min(least, distance(q.corners[0], p));
      EXPECT_LE(least, nearest);
      EXPECT_LE(nearest, least + 0.02);
    }
  }
}

}  // namespace
}  // namespace snug::piece_set_test
