#include <snug/query/triangle_complex.h>

#include <gtest/gtest.h>
#include <testing/scheme_surfaces.h>

#include <map>
#include <random>
#include <set>

namespace snug::triangle_complex_test {
namespace {

using Index = TriangleComplex::Index;

// Each cut covers the triangle once: areas at places of corners and middles, oriented as the whole.
TEST(triangle_complex, cuts_cover_the_triangle) {
  constexpr std::array<std::array<int, 2>, 6> place{{{0, 0}, {2, 0}, {0, 2}, {1, 0}, {1, 1}, {0, 1}}};
  for (unsigned marks = 1; marks < 8; ++marks) {
    std::set<std::set<std::array<std::uint8_t, 3>>> different;
    for (std::size_t choice = 0; choice < split_count(marks); ++choice) {
      const TriangleSplit split = split_of(marks, choice);
      int area = 0;
      std::map<std::pair<int, int>, int> lines;
      std::set<std::array<std::uint8_t, 3>> triangles;
      for (std::size_t i = 0; i < split.count; ++i) {
        const auto& [a, b, c] = split.triangles[i];
        const int twice = (place[b][0] - place[a][0]) * (place[c][1] - place[a][1]) -
                          (place[c][0] - place[a][0]) * (place[b][1] - place[a][1]);
        EXPECT_GT(twice, 0) << marks << ' ' << choice;
        area += twice;
        for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
          EXPECT_TRUE(p < 3 || (marks >> (p - 3)) % 2 == 1) << "a middle that is not there";
          ++lines[std::minmax<int>(p, q)];
        }
        triangles.insert(split.triangles[i]);
      }
      EXPECT_EQ(area, 4);
      for (unsigned k = 0; k < 3; ++k) {
        const int next = static_cast<int>((k + 1) % 3), from = static_cast<int>(k), middle = from + 3;
        const bool cut = (marks >> k) % 2 == 1;
        EXPECT_EQ(lines.contains(std::minmax(from, next)), !cut);
        EXPECT_EQ(lines.contains(std::minmax(from, middle)), cut);
      }
      EXPECT_TRUE(different.insert(triangles).second);
    }
  }
}

// Edges as pairs of ends, with what each triangle on them does.
std::map<std::pair<Index, Index>, std::set<Index>> edges_by_ends(const TriangleComplex& complex) {
  std::map<std::pair<Index, Index>, std::set<Index>> result;
  for (std::size_t t = 0; t < complex.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = complex.corners(t)[k], b = complex.corners(t)[(k + 1) % 3], e = complex.edge_of(t, k);
      EXPECT_TRUE((complex.edge(e).from == a && complex.edge(e).to == b) ||
                  (complex.edge(e).from == b && complex.edge(e).to == a));
      EXPECT_EQ(complex.edge(e).halves, TriangleComplex::none) << "an edge that is split is still used";
      result[std::minmax(a, b)].insert(e);
    }
  }
  return result;
}

void split_marked(TriangleComplex& complex, std::mt19937_64& random) {
  complex.number_middles([](std::size_t, std::size_t) {});
  const std::size_t old = complex.triangle_count();
  std::vector<std::pair<std::size_t, TriangleSplit>> cuts;
  std::size_t triangles = 0, edges = 0;
  for (std::size_t t = 0; t < old; ++t) {
    if (complex.marks(t) == 0) continue;
    cuts.emplace_back(t, split_of(complex.marks(t), random() % split_count(complex.marks(t))));
    triangles += cuts.back().second.count - 1u;
    edges += TriangleComplex::inner_edges(cuts.back().second);
  }
  std::size_t next = old;
  auto edge = static_cast<Index>(complex.edge_count());
  complex.extend(triangles, edges);
  for (const auto& [t, split] : cuts) {
    complex.cut(t, split, next, edge);
    next += split.count - 1u;
    edge += static_cast<Index>(TriangleComplex::inner_edges(split));
  }
  complex.clear_marks();
}

// Whatever is marked, in every scheme, with polygons beside quads and whatever is not manifold: edges stay whole,
// and once the complex is simple it stays so.
TEST(triangle_complex, stays_conforming_and_simple) {
  std::mt19937_64 random(51);
  testing::for_each_surface(52, [&](const testing::NamedSurface& named) {
    TriangleComplex complex(named.surface);
    int steps = 0;
    for (bool first = true; complex.mark_what_is_not_simple() || first; first = false) {
      split_marked(complex, random);
      ASSERT_LT(++steps, 8) << named.name;
    }
    for (int step = 0; step < 3; ++step) {
      for (const auto& [ends, edges] : edges_by_ends(complex)) {
        ASSERT_NE(ends.first, ends.second) << named.name;
        ASSERT_EQ(edges.size(), 1u) << named.name << ": two edges with the same ends";
      }
      if (::testing::Test::HasFailure()) return;
      for (std::size_t t = 0; t < complex.triangle_count(); ++t) {
        if (random() % 4 == 0) complex.mark(complex.edge_of(t, random() % 3));
      }
      split_marked(complex, random);
      EXPECT_FALSE(complex.mark_what_is_not_simple()) << named.name;
      complex.clear_marks();
    }
  });
}

}  // namespace
}  // namespace snug::triangle_complex_test
