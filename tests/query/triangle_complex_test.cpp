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
  std::map<Index, std::pair<Index, Index>> ends;
  for (std::size_t t = 0; t < complex.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = complex.corner(t, k), b = complex.corner(t, (k + 1) % 3), e = complex.edge_of(t, k);
      EXPECT_EQ(ends.emplace(e, std::minmax(a, b)).first->second,
                (std::pair<Index, Index>(std::minmax(a, b))))
          << "an edge with different ends";
      result[std::minmax(a, b)].insert(e);
    }
  }
  return result;
}

// What is known of sites and triangles, as a user keeps it.
struct OnPatches {
  explicit OnPatches(const TriangleComplex& complex) {
    constexpr std::array<std::array<double, 2>, 3> places{{{0, 0}, {1, 0}, {0, 1}}};
    for (std::size_t t = 0; t < complex.triangle_count(); ++t) {
      patch.push_back(complex.root_patches()[t].value());
      for (std::size_t k = 0; k < 3; ++k) at.push_back(places[k]);
    }
  }
  std::vector<std::uint32_t> patch;       // of triangles
  std::vector<std::array<double, 2>> at;  // of sites
};

void split_marked(TriangleComplex& complex, std::mt19937_64& random, OnPatches& known) {
  const std::vector<TriangleComplex::Cut> cuts = complex.split_edges([&](std::size_t t, std::size_t k) {
    const auto a = known.at[complex.sites(t)[k]], b = known.at[complex.sites(t)[(k + 1) % 3]];
    known.at.push_back({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2});
  });
  ASSERT_EQ(known.at.size(), complex.site_count());
  for (const TriangleComplex::Cut& cut : cuts) {
    const unsigned marks = complex.marks(cut.triangle);
    const TriangleSplit split = split_of(marks, random() % split_count(marks));
    known.patch.resize(complex.triangle_count());
    for (unsigned i = 1; i < split.count; ++i) known.patch[cut.first_new + i - 1] = known.patch[cut.triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      if ((marks >> k) % 2 == 0) continue;
      EXPECT_EQ(complex.middle(cut.triangle, k), complex.vertex_at(cut.middles[k]));
    }
    complex.cut(cut, split);
  }
  complex.clear_marks();
}

// Triangles cover the parameters of each root patch, oriented alike; vertices at the same place of a patch are one site unless
// they lie on its sides.
void expect_covered(const TriangleComplex& complex, const OnPatches& known) {
  std::map<std::uint32_t, double> areas;
  std::map<std::pair<std::uint32_t, std::array<double, 2>>, Index> sites;
  for (std::size_t t = 0; t < complex.triangle_count(); ++t) {
    std::array<std::array<double, 2>, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index site = complex.sites(t)[k];
      p[k] = known.at[site];
      const Index first = sites.emplace(std::pair(known.patch[t], p[k]), site).first->second;
      EXPECT_EQ(complex.vertex_at(first), complex.vertex_at(site)) << "two vertices at one place";
      const bool inside = p[k][0] > 0 && p[k][1] > 0 && p[k][0] + p[k][1] < 1;
      EXPECT_TRUE(!inside || first == site);
    }
    const double twice =
        (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
    EXPECT_GT(twice, 0);
    areas[known.patch[t]] += twice;
  }
  EXPECT_EQ(areas.size(), complex.root_patches().size());
  for (const auto& [patch, area] : areas) EXPECT_EQ(area, 1);
}

// Whatever is marked, in every scheme, with polygons beside quads and whatever is not manifold: edges stay whole,
// and once the complex is simple it stays so.
TEST(triangle_complex, stays_conforming_and_simple) {
  std::mt19937_64 random(51);
  testing::for_each_surface(52, [&](const testing::NamedSurface& named) {
    TriangleComplex complex(named.surface);
    OnPatches known(complex);
    int steps = 0;
    for (bool first = true; complex.mark_what_is_not_simple() || first; first = false) {
      split_marked(complex, random, known);
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
      split_marked(complex, random, known);
      expect_covered(complex, known);
      EXPECT_FALSE(complex.mark_what_is_not_simple()) << named.name;
      complex.clear_marks();
    }
  });
}

}  // namespace
}  // namespace snug::triangle_complex_test
