#include <snug/bounds/rows_kernel.h>

#include <gtest/gtest.h>
#include <snug/bounds/fit_kernels.h>
#include <snug/patch/evaluate.h>
#include <testing/containment.h>
#include <testing/counts.h>
#include <testing/instruction_sets.h>
#include <testing/kinds.h>
#include <testing/scheme_surfaces.h>

#include <bit>
#include <cmath>
#include <random>
#include <set>

namespace snug::rows_kernel_test {
namespace {

// Patches of one kind with control points of their own, around the places where a layout has them: bent,
// noisy, in a plane, flat, far from the origin, tiny.
struct Batch {
  std::vector<Point3> points;
  std::vector<VertexId> control;
  template <class T>
  [[nodiscard]] std::vector<OffsetTriangle> fits(const kernels::RowsWithTips<T>& rows, std::size_t begin,
                                                 std::size_t end, unsigned levels = 3) const {
    std::vector<OffsetTriangle> out(end - begin);
    const std::size_t n = rows.kind().control_count();
    kernels::fit_rows(rows, levels, points, std::span(control).subspan(begin * n, out.size() * n), out);
    return out;
  }
};

Batch batch(const Kind& kind, std::size_t count, std::mt19937_64& random) {
  const auto unit = [&] { return 2 * testing::unit(random) - 1; };
  const std::vector<LayoutPoint> layout = make_layout(kind);
  Batch result;
  for (std::size_t i = 0; i < count; ++i) {
    const double size = random() % 2 ? 0.3 : std::pow(10.0, 4 * unit() - 4);
    const double noise = random() % 4 == 0 ? 0 : std::pow(10.0, 2 * unit() - 2);
    const double bend = random() % 2 ? unit() : 0;
    // In its plane a patch sticks out of its triangle aside.
    const bool in_plane = bend == 0 && random() % 2 == 0;
    const Vector3 at{unit(), unit(), unit()}, x{1, unit(), unit()}, y{unit(), 1, unit()};
    const Vector3 up = cross(x, y);
    for (const LayoutPoint& p : layout) {
      const double z = bend * (p[0] * p[0] + 0.5 * p[1] * p[1] - 0.3 * p[0] * p[1]);
      const Vector3 by{unit(), unit(), unit()};
      const Vector3 shaken = noise * (in_plane ? by.x * x + by.y * y : by);
      result.control.push_back(VertexId(result.points.size()));
      result.points.push_back(Point3{} + 0.2 * at + (0.2 * size) * (p[0] * x + p[1] * y + z * up + shaken));
    }
  }
  return result;
}

std::vector<const Kind*> kinds(BoundsCache& library) {
  std::vector<const Kind*> all;
  for (const KindKey& key : testing::assorted_kinds()) {
    const Kind& kind = library.kinds().find(key);
    if (kernels::has_rows_with_tips(library, kind)) all.push_back(&kind);
  }
  return all;
}

void expect_limits_inside(const Kind& kind, const Batch& b, std::span<const OffsetTriangle> fits) {
  const std::size_t n = kind.control_count();
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].radius < 0) continue;
    const Patch patch = make_patch(kind, 0, b.points, std::span(b.control).subspan(i * n, n));
    for (int u = 0; u <= 16; ++u) {
      for (int v = 0; u + v <= 16; ++v) {
        // Denser where tips are.
        const TriangleParameter at{u / 16.0, v / 16.0};
        for (const double shrink : {1.0, 0.1, 0.01}) {
          for (std::size_t corner = 0; corner < 3; ++corner) {
            TriangleParameter near{shrink * at.u, shrink * at.v};
            if (corner == 1) near = {1 - near.u - near.v, near.u};
            if (corner == 2) near = {near.v, 1 - near.u - near.v};
            if (!(near.u >= 0 && near.v >= 0 && near.u + near.v <= 1)) continue;
            const RelativePoint limit = limit_point(patch, near);
            testing::Extended p;
            for (std::size_t a = 0; a < 3; ++a) {
              p[a] = static_cast<long double>(patch.origin[a]) + limit.relative[a];
            }
            ASSERT_TRUE(testing::within_radius(p, fits[i].base, fits[i].radius + 2 * limit.error)) << i;
          }
        }
      }
    }
  }
}

using Numbers = ::testing::Types<float, double>;
template <class T>
class fit_rows : public ::testing::Test {};
TYPED_TEST_SUITE(fit_rows, Numbers);

TYPED_TEST(fit_rows, holds_the_limit_patch) {
  std::mt19937_64 random(81);
  BoundsCache library;
  std::size_t answered = 0, asked = 0;
  for (const Kind* kind : kinds(library)) {
    const Batch b = batch(*kind, 21, random);
    const kernels::RowsWithTips<TypeParam> rows(library, *kind, kernels::TipsBy::tables);
    for (const unsigned levels : {3u, 4u, 6u}) {
      const auto fits = b.fits(rows, 0, 21, levels);
      for (const OffsetTriangle& fit : fits) answered += fit.radius >= 0;
      asked += fits.size();
      expect_limits_inside(*kind, b, fits);
    }
  }
  EXPECT_GT(answered, asked / 6);
}

// Catmull-Clark, Doo-Sabin, Midedge, creases and boundaries.
TYPED_TEST(fit_rows, holds_patches_of_all_schemes) {
  std::mt19937_64 random(82);
  std::set<std::string> schemes;
  std::size_t answered = 0;
  testing::for_each_surface(83, [&](const testing::NamedSurface& named) {
    std::set<const Kind*> seen;
    testing::for_each_patch(named.surface, [&](PatchId p) {
      const Kind& kind = named.surface.kind(p);
      if (answered > testing::fewer(3000) || !kernels::has_rows_with_tips(named.surface.library(), kind) ||
          !seen.insert(&kind).second)
        return;
      const Batch b = batch(kind, 5, random);
      const auto fits = b.fits(
          kernels::RowsWithTips<TypeParam>(named.surface.library(), kind, kernels::TipsBy::tables), 0, 5);
      expect_limits_inside(kind, b, fits);
      for (const OffsetTriangle& fit : fits) answered += fit.radius >= 0;
    });
  });
  EXPECT_GT(answered, testing::fewer(300));
}

TYPED_TEST(fit_rows, does_not_depend_on_the_patches_beside_it) {
  std::mt19937_64 random(84);
  BoundsCache library;
  const Kind& kind = *kinds(library)[3];
  const kernels::RowsWithTips<TypeParam> rows(library, kind, kernels::TipsBy::tables);
  Batch b = batch(kind, 19, random);
  b.points[7].x = NAN;
  const auto together = b.fits(rows, 0, 19);
  EXPECT_LT(together[0].radius, 0);
  for (std::size_t begin = 0; begin < 19; ++begin) {
    for (std::size_t end = begin; end <= 19; ++end) {
      const auto part = b.fits(rows, begin, end);
      for (std::size_t i = 0; i < part.size(); ++i) {
        if (begin + i == 0) continue;
        EXPECT_EQ(part[i].base, together[begin + i].base);
        EXPECT_EQ(part[i].radius, together[begin + i].radius);
      }
    }
  }
}

TYPED_TEST(fit_rows, marks_what_is_not_finite) {
  std::mt19937_64 random(85);
  BoundsCache library;
  for (const Kind* kind : kinds(library)) {
    const std::size_t n = kind->control_count();
    const kernels::RowsWithTips<TypeParam> rows(library, *kind, kernels::TipsBy::tables);
    Batch b = batch(*kind, n, random);
    for (std::size_t i = 0; i < n; ++i) b.points[i * n + i].y = i % 2 ? NAN : INFINITY;
    for (const OffsetTriangle& fit : b.fits(rows, 0, n)) EXPECT_LT(fit.radius, 0);
  }
}

TYPED_TEST(fit_rows, has_the_same_bits_on_every_instruction_set) {
  BoundsCache library;
  const auto everything = [&] {
    std::mt19937_64 random(86);
    std::vector<std::uint64_t> bits;
    for (const Kind* kind : kinds(library)) {
      const Batch b = batch(*kind, 13, random);
      for (const OffsetTriangle& fit :
           b.fits(kernels::RowsWithTips<TypeParam>(library, *kind, kernels::TipsBy::tables), 0, 13)) {
        bits.push_back(std::bit_cast<std::uint64_t>(fit.radius));
        if (fit.radius < 0) continue;
        for (const Point3& p : fit.base) {
          for (const double x : {p.x, p.y, p.z}) bits.push_back(std::bit_cast<std::uint64_t>(x));
        }
        bits.push_back(std::bit_cast<std::uint64_t>(fit.rounding));
      }
    }
    return bits;
  };
  const auto here = everything();
  testing::EachInstructionSet().run([&](const char* name) { EXPECT_TRUE(everything() == here) << name; });
}

// The hull of the same points, about a base that is shifted by roundings: what single precision says may be larger only.
TEST(fit_rows_in_single_precision, is_as_near_as_is_said_and_not_below_doubles) {
  std::mt19937_64 random(87);
  BoundsCache library;
  std::size_t both = 0, exact = 0;
  double most = 1;
  for (const Kind* kind : kinds(library)) {
    const Batch b = batch(*kind, 101, random);
    const auto single = b.fits(kernels::RowsWithTips<float>(library, *kind, kernels::TipsBy::tables), 0, 101),
               twice = b.fits(kernels::RowsWithTips<double>(library, *kind, kernels::TipsBy::tables), 0, 101);
    for (std::size_t i = 0; i < 101; ++i) {
      exact += single[i].radius == kernels::needs_digits;
      if (single[i].radius < 0 || twice[i].radius < 0) continue;
      double shift = 0;
      for (std::size_t k = 0; k < 3; ++k)
        shift = std::max(shift, length(single[i].base[k] - twice[i].base[k]));
      EXPECT_GE(single[i].radius + shift, twice[i].radius - 4 * twice[i].rounding) << i;
      EXPECT_LE(single[i].radius - shift, twice[i].radius + 3 * single[i].rounding) << i;
      most = std::max(most, single[i].radius / twice[i].radius);
      ++both;
    }
  }
  EXPECT_LT(most, 1.035);
  EXPECT_GT(both, 100u);
  EXPECT_GT(exact, 20u);
}

}  // namespace
}  // namespace snug::rows_kernel_test
