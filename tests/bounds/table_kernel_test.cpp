#include <gtest/gtest.h>
#include <snug/bounds/fit_kernels.h>
#include <snug/bounds/table_triangle.h>
#include <testing/counts.h>
#include <testing/instruction_sets.h>
#include <testing/kinds.h>
#include <testing/patches.h>
#include <testing/scheme_surfaces.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>

namespace snug::table_kernel_test {
namespace {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  [[nodiscard]] double unit() { return static_cast<double>(bits_() >> 11) * 0x1p-52 - 1; }
  [[nodiscard]] std::size_t below(std::size_t n) { return bits_() % n; }
  [[nodiscard]] Vector3 vector(double size = 1) { return {size * unit(), size * unit(), size * unit()}; }

 private:
  std::mt19937_64 bits_;
};

// Patches of one kind with control points of their own.
struct Batch {
  std::vector<Point3> points;
  std::vector<VertexId> control;
  std::vector<Patch> patches;
};

Batch batch(const Kind& kind, std::size_t count, Random& random, double size, const Vector3& at) {
  Batch result;
  // Places of a regular kind; further ones anywhere around.
  constexpr double places[12][2] = {{0, 0},  {1, 0},  {0, 1},  {1, -1}, {1, 1}, {-1, 1},
                                    {-1, 0}, {0, -1}, {2, -1}, {2, 0},  {0, 2}, {-1, 2}};
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<Point3> own;
    for (std::size_t k = 0; k < kind.control_count(); ++k) {
      const Vector3 place = k < 12 ? Vector3{places[k][0], places[k][1], 0} : random.vector(2);
      own.push_back(Point3{} + at + size * (place + random.vector(0.2)));
      result.control.push_back(VertexId(result.points.size()));
      result.points.push_back(own.back());
    }
    result.patches.push_back(testing::patch_of(kind, own));
  }
  return result;
}

void expect_the_tables_offset_triangle(const Kind& kind, const BoundTable& table, std::size_t count,
                                       Random& random) {
  Batch b = batch(kind, count, random, 0.5, {});
  const std::size_t broken = random.below(count + 1);
  const std::size_t which = std::min<std::size_t>(5, kind.control_count() - 1);
  if (broken < count) b.points[broken * kind.control_count() + which].x = count % 2 ? NAN : INFINITY;
  std::vector<OffsetTriangle> out(count);
  kernels::fit_table(table, kind, b.points, b.control, out);
  for (std::size_t i = 0; i < count; ++i) {
    if (i == broken) {
      EXPECT_EQ(out[i].radius, INFINITY);
      continue;
    }
    const OffsetTriangle expected = offset_triangle(table_triangle(table, b.patches[i]));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(max_abs(out[i].base[k] - expected.base[k]), 1e-12);
    EXPECT_NEAR(out[i].radius, expected.radius, 1e-12 * (1 + expected.radius));
    EXPECT_GT(out[i].rounding, 0);
    EXPECT_LT(out[i].rounding, 2e-11);
  }
}

TEST(fit_table, is_the_tables_offset_triangle) {
  BoundsCache library;
  Random random(6);
  for (const std::size_t valence : {6u, 5u, 9u, 40u}) {
    const CornerFan fan{0, static_cast<std::uint16_t>(valence - 1), true, false};
    const Kind& kind = library.kinds().find({Scheme::loop, {CornerFan{}, CornerFan{}, fan}});
    for (std::size_t count = 1; count < 10; ++count) {
      expect_the_tables_offset_triangle(kind, library.table(kind), count, random);
    }
  }
}

// Kinds of all schemes, of 4 to more control points than are gathered at once.
TEST(fit_table, is_the_tables_offset_triangle_where_all_functions_are_bounded) {
  Random random(8);
  std::set<const Kind*> seen;
  std::size_t most = 0;
  const auto check = [&](const LimitSurface& surface) {
    testing::for_each_patch(surface, [&](PatchId p) {
      const Kind& kind = surface.kind(p);
      if (laid_by_rings(kind.key()) || seen.size() > testing::fewer(500) || !seen.insert(&kind).second)
        return;
      const BoundTable& table = surface.library().table(kind);
      EXPECT_EQ(table.first_bounded(), 0u);
      expect_the_tables_offset_triangle(kind, table, 1 + random.below(10), random);
      most = std::max(most, kind.control_count());
    });
  };
  const LimitSurface many(testing::control_mesh(oracle::meshes::pole(20, false)), {Scheme::catmark},
                          std::make_shared<BoundsCache>());
  check(many);
  testing::for_each_surface(9, [&](const testing::NamedSurface& named) { check(named.surface); });
  EXPECT_GT(seen.size(), testing::fewer(100));
  EXPECT_GT(most, 32u);
}

TEST(fit_table, has_the_same_bits_on_every_instruction_set) {
  BoundsCache library;
  const KindKey keys[] = {
      {}, {Scheme::catmark, {CornerFan{0, 3, true}, CornerFan{0, 3, true}, CornerFan{0, 3, true}}}};
  Random random(7);
  std::vector<Batch> batches;
  for (const KindKey& key : keys) {
    batches.push_back(batch(library.kinds().find(key), 7, random, 1, {0.1, 0.2, 0.3}));
  }
  const auto everything = [&] {
    std::vector<double> all;
    std::vector<OffsetTriangle> out(7);
    for (std::size_t i = 0; i < 2; ++i) {
      const Kind& kind = library.kinds().find(keys[i]);
      kernels::fit_table(library.table(kind), kind, batches[i].points, batches[i].control, out);
      for (const OffsetTriangle& fit : out) {
        for (const Point3& p : fit.base) all.insert(all.end(), {p.x, p.y, p.z});
        all.insert(all.end(), {fit.radius, fit.rounding});
      }
    }
    return all;
  };
  const std::vector<double> expected = everything();
  std::set<std::string> names;
  testing::EachInstructionSet().run([&](const char* name) {
    const std::vector<double> found = everything();
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(found[i]), std::bit_cast<std::uint64_t>(expected[i]))
          << name << " " << i;
    }
    names.insert(kernels::instruction_set());
  });
#ifdef __x86_64__  // elsewhere they may be fixed when the library is compiled
  EXPECT_GE(names.size(), 2u);
#endif
}

}  // namespace
}  // namespace snug::table_kernel_test
