#include <snug/query/local_tolerances.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace snug::local_tolerances_test {
namespace {

// A tolerance is the least of the lattice's triangles that a part overlaps, each with its own, in a list that is searched.
TEST(local_tolerances, are_those_of_pieces_that_were_marked) {
  ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.3}};
  mesh.add_face(std::array{VertexId(0u), VertexId(1u), VertexId(2u), VertexId(3u)});
  const LimitSurface surface(mesh, {Scheme::bilinear}, std::make_shared<BoundsCache>());
  std::mt19937_64 random(2);
  constexpr unsigned level = 4, n = 1u << level;
  struct Fine {
    PatchPart part;
    double tolerance;
  };
  const auto lattice_triangle = [](PatchId patch, unsigned i, unsigned j, unsigned count, bool turned) {
    const double a = 1.0 / count, x = i * a, y = j * a;
    if (turned) return PatchPart{patch, {{{x + a, y + a}, {x, y + a}, {x + a, y}}}};
    return PatchPart{patch, {{{x, y}, {x + a, y}, {x, y + a}}}};
  };
  const auto centre = [](const PatchPart& part) {
    TriangleParameter sum{0, 0};
    for (const TriangleParameter& p : part.at) sum = {sum.u + p.u / 3, sum.v + p.v / 3};
    return sum;
  };
  const auto inside = [](const PatchPart& part, const TriangleParameter& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      const TriangleParameter &a = part.at[k], &b = part.at[(k + 1) % 3];
      if ((b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u) <= 0) return false;
    }
    return true;
  };
  for (int trial = 0; trial < 50; ++trial) {
    LocalTolerances tolerances(surface, {1.0});
    std::vector<Fine> all;
    for (unsigned patch = 0; patch < 2; ++patch) {
      for (unsigned i = 0; i < n; ++i) {
        for (unsigned j = 0; i + j < n; ++j) {
          all.push_back({lattice_triangle(PatchId(patch), i, j, n, false), 1});
          if (i + j + 2 <= n) all.push_back({lattice_triangle(PatchId(patch), i, j, n, true), 1});
        }
      }
    }
    for (int round = 0; round < 6; ++round) {
      std::vector<bool> marked(all.size(), false);
      for (int k = 0; k < 3; ++k) {
        const unsigned of = static_cast<unsigned>(random() % (level + 1)), count = 1u << of;
        const auto i = static_cast<unsigned>(random() % count),
                   j = static_cast<unsigned>(random() % (count - i));
        const bool turned = i + j + 2 <= count && random() % 2 == 0;
        const PatchPart part = lattice_triangle(PatchId(random() % 2), i, j, count, turned);
        tolerances.mark(part, 0.125, 1);
        for (std::size_t f = 0; f < all.size(); ++f) {
          if (all[f].part.patch == part.patch && inside(part, centre(all[f].part)) &&
              all[f].tolerance > 0.125)
            marked[f] = true;
        }
      }
      double least = INFINITY;
      for (std::size_t f = 0; f < all.size(); ++f) {
        if (!marked[f]) continue;
        all[f].tolerance /= 2;
        least = std::min(least, all[f].tolerance);
      }
      EXPECT_EQ(tolerances.refine(), least);
      for (const Fine& fine : all) ASSERT_EQ(tolerances.of(fine.part), fine.tolerance) << trial;
      double least_of_whole = 1;
      for (const Fine& fine : all) {
        if (fine.part.patch == PatchId(0u)) least_of_whole = std::min(least_of_whole, fine.tolerance);
      }
      EXPECT_EQ(tolerances.of(lattice_triangle(PatchId(0u), 0, 0, 1, false)), least_of_whole);
    }
  }
  // Of the owner while it is large; and how often something was as small as it gets.
  LocalTolerances tolerances(surface, {1.0});
  const PatchPart part = lattice_triangle(PatchId(1u), 0, 0, 4, false);
  tolerances.mark(part, 0.25, 0.5);
  EXPECT_EQ(tolerances.refine(), 0.5);
  EXPECT_EQ(tolerances.of(lattice_triangle(PatchId(0u), 1, 1, 8, true)), 0.5);
  for (const int times : {0, 1, 2}) {
    tolerances.mark(part, 0.25, 0.5);
    EXPECT_EQ(tolerances.refine(), times == 0 ? 0.25 : INFINITY);
    EXPECT_EQ(tolerances.times_at_least(part), times);
  }
  EXPECT_EQ(tolerances.of(lattice_triangle(PatchId(1u), 2, 0, 4, false)), 0.5);
  EXPECT_EQ(tolerances.least(), 0.25);
  EXPECT_EQ(tolerances.refine(), INFINITY);
  EXPECT_EQ(tolerances.times_at_least(part), 0);
}

}  // namespace
}  // namespace snug::local_tolerances_test
