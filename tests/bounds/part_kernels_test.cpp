// What is left of a part at its extraordinary corner is as near the base and the quadratic as its bounds say, however few levels it
// is down: limit points there alone, level by level, since elsewhere others would hide what is wrong.

#include <snug/bounds/part_kernels.h>

#include <gtest/gtest.h>
#include <snug/patch/evaluate.h>
#include <testing/containment.h>
#include <testing/counts.h>
#include <testing/scheme_surfaces.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace snug::part_kernels_test {
namespace {

using testing::Extended;

struct Counts {
  std::size_t samples = 0, near_quadratic = 0, near_along = 0, near_base = 0;
};

Extended in_frame(const PatchFrame& frame, const Vector3& relative) {
  const Vector3 rows[3] = {frame.t1, frame.t2, frame.n};
  Extended result{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a)
      result[k] +=
          static_cast<long double>(rows[k][a]) * (static_cast<long double>(relative[a]) - frame.a[a]);
  }
  return result;
}

Extended point_of(const std::array<Vector3, 6>& q, TriangleParameter at) {
  const long double u = at.u, v = at.v, w = 1 - u - v;
  const std::array<long double, 6> weights{w * w, u * u, v * v, 2 * w * u, 2 * u * v, 2 * v * w};
  Extended sum{};
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t a = 0; a < 3; ++a) sum[a] += weights[k] * q[k][a];
  }
  return sum;
}

// The base in the frame.
Triangle base_of(const PatchFrame& frame) {
  return {Point3{0, 0, frame.middle}, Point3{frame.l0, 0, frame.middle},
          Point3{frame.xc, frame.yc, frame.middle}};
}

// The parameter of a point of the tip in the part's order of corners, `corner` being the extraordinary one in that order.
TriangleParameter in_tip(TriangleParameter within, std::size_t corner, unsigned levels) {
  const double share = std::ldexp(1.0, -static_cast<int>(levels));
  const std::array<double, 3> inside{share * (1 - within.u - within.v), share * within.u, share * within.v};
  std::array<double, 3> weights = inside;
  weights[corner] += 1 - share;
  return {weights[1], weights[2]};
}

void expect_tip_near(const Patch& part, const PatchFrame& frame, std::uint8_t child, const PartBounds& bounds,
                     unsigned levels, std::mt19937_64& random, const std::string& name, Counts& counts) {
  std::size_t corner = 0;
  while (part.kind->regular_corner(part.to_kind(corner))) ++corner;
  for (int i = 0; i < 8; ++i) {
    const TriangleParameter at = in_tip(i < 3 ? std::array<TriangleParameter, 3>{{{0, 0}, {1, 0}, {0, 1}}}[i]
                                              : testing::random_parameter(random),
                                        corner, levels);
    const RelativePoint point = limit_point(part, at);
    const Extended x = in_frame(frame, point.relative), q = point_of(frame.quadratic[child], at);
    const Extended off{x[0] - q[0], x[1] - q[1], x[2] - q[2]};
    const long double known = 2 * point.error + 1e-15L, distance = std::sqrt(testing::inner(off, off)),
                      along = std::fabs(off[0] * frame.direction.x + off[1] * frame.direction.y +
                                        off[2] * frame.direction.z);
    ++counts.samples;
    ASSERT_LE(distance, bounds.tip.quadratic + known) << name << ", " << levels;
    ASSERT_LE(along, bounds.tip.along + known) << name << ", " << levels;
    ASSERT_TRUE(testing::within_radius(x, base_of(frame), bounds.tip.base + known)) << name << ", " << levels;
    for (std::size_t a = 0; a < 3; ++a) {
      const long double height = a == 0   ? frame.axis_x * x[0] + frame.axis_y * x[1]
                                 : a == 1 ? frame.axis_x * x[1] - frame.axis_y * x[0]
                                          : x[2];
      ASSERT_GE(height, bounds.tip.lower[a] - known) << name;
      ASSERT_LE(height, bounds.tip.upper[a] + known) << name;
    }
    counts.near_quadratic += distance > 0.6L * bounds.tip.quadratic;
    counts.near_along += along > 0.6L * bounds.tip.along;
    counts.near_base += !testing::within_radius(x, base_of(frame), 0.8L * bounds.tip.base);
  }
}

TEST(part_kernels, tips_are_as_near_as_they_say) {
  std::mt19937_64 random(61);
  Counts counts;
  testing::for_each_surface(61, [&](const testing::NamedSurface& named) {
    BoundsCache& library = named.surface.library();
    for (std::size_t p = 0; p < named.surface.patch_count(); ++p) {
      if (!named.surface.has_patch(PatchId(p))) continue;
      const Patch patch = named.surface.patch(PatchId(p));
      if (patch.kind->polynomial() || !patch.kind->cacheable()) continue;
      std::array<Patch, 4> parts;
      std::array<PartShape, 4> shapes;
      bool known = true;
      for (unsigned child = 0; child < 4; ++child) {
        parts[child] = split(patch, child);
        const auto rows = PartRows::of(library, *parts[child].kind, false);
        known = known && rows;
        if (!known) break;
        const Patch* const part = &parts[child];
        PartShape* const shape = &shapes[child];
        kernels::shape_parts(*rows, {&part, 1}, {&shape, 1});
      }
      if (!known) continue;
      PatchFrame frame;
      kernels::make_frames(shapes, 4, {&frame, 1});
      if (!frame.good) continue;
      for (std::uint8_t child = 0; child < 3; ++child) {
        const auto rows = PartRows::of(library, *parts[child].kind, false);
        if (!rows->tip()) continue;
        PartBounds bounds;
        PartBounds* const out = &bounds;
        TipState tip;
        const kernels::PlacedPart placed{&parts[child], &frame, child, &tip};
        unsigned done = 0;
        for (const unsigned levels : {1u, 2u, 3u, 6u, 12u}) {
          kernels::bound_parts(*rows, {&placed, 1}, {done, levels}, {&out, 1});
          done = levels;
          expect_tip_near(parts[child], frame, child, bounds, levels, random, named.name, counts);
          if (::testing::Test::HasFatalFailure()) return;
        }
      }
    }
  });
  std::printf("  %zu samples; near the bound: %zu of the quadratic, %zu along, %zu of the base\n",
              counts.samples, counts.near_quadratic, counts.near_along, counts.near_base);
  EXPECT_GT(counts.samples, testing::fewer(20'000));
  EXPECT_GT(counts.near_quadratic, counts.samples / 50);
  EXPECT_GT(counts.near_along, counts.samples / 50);
  EXPECT_GT(counts.near_base, counts.samples / 20);
}

}  // namespace
}  // namespace snug::part_kernels_test
