// Masks of Loop's scheme at interior vertices, as rows of a step and of limits have them.

#include <snug/scheme/rules.h>

#include <gtest/gtest.h>
#include <testing/counts.h>

#include <cmath>
#include <numbers>

namespace snug::loop_test {
namespace {

// n triangles around vertex 0.
Topology wheel(std::size_t n) {
  std::vector<std::uint32_t> offsets{0};
  std::vector<VertexId> corners;
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::size_t v : {std::size_t{0}, 1 + i, 1 + (i + 1) % n}) corners.emplace_back(v);
    offsets.push_back(static_cast<std::uint32_t>(corners.size()));
  }
  return {std::move(offsets), std::move(corners), n + 1};
}

// The weight of the vertex, those of its ring, which are one, and the error of all together.
struct Mask {
  double centre, each, error;
};

Mask mask_of(const Stencils& rows, std::size_t n) {
  const Stencils::Row row = rows.row(0);
  EXPECT_EQ(row.sources.size(), n + 1);
  EXPECT_EQ(row.sources[0], 0u);
  for (std::size_t i = 1; i <= n; ++i) EXPECT_EQ(row.weights[i], row.weights[1]);
  return {row.weights[0], row.weights[1], row.error};
}
Mask vertex_mask(std::size_t n) { return mask_of(refine(wheel(n), {Scheme::loop}).stencils, n); }
Mask limit_mask(std::size_t n) {
  Stencils rows;
  rules_of(Scheme::loop).add_limit_row({wheel(n), {Scheme::loop}, {}}, VertexId(0), rows);
  return mask_of(rows, n);
}

TEST(loop_masks, sum_to_one_and_are_not_negative) {
  for (std::size_t n = 3; n <= testing::fewer(1000); ++n) {
    for (const Mask& mask : {vertex_mask(n), limit_mask(n)}) {
      const long double sum = mask.centre + static_cast<long double>(n) * mask.each;
      EXPECT_LE(std::fabs(sum - 1), mask.error + 1e-18L) << n;
      EXPECT_LT(mask.error, 1e-14) << n;
      EXPECT_GE(mask.centre, mask.error) << n;
      EXPECT_GE(mask.each, 0) << n;
    }
  }
}

TEST(loop_masks, contain_the_formula) {
  for (std::size_t n = 3; n <= testing::fewer(1000); ++n) {
    const auto count = static_cast<long double>(n);
    const long double c = std::cos(2 * std::numbers::pi_v<long double> / count);
    const long double a = 0.625L - (3 + 2 * c) * (3 + 2 * c) / 64;
    const Mask mask = vertex_mask(n);
    EXPECT_NEAR(mask.centre, static_cast<double>(1 - a), 4e-16) << n;
    EXPECT_LE(std::fabs(mask.centre - (1 - a)) + count * std::fabs(mask.each - a / count),
              mask.error + 1e-18L)
        << n;
  }
}

// The limit mask w is a left eigenvector: applying the step first changes nothing.
TEST(loop_masks, limits_are_kept_by_a_step) {
  for (std::size_t n = 3; n <= testing::fewer(1000); ++n) {
    const Mask step = vertex_mask(n), limit = limit_mask(n);
    // Ring to ring: each new ring vertex takes 3/8 of the centre and 5/8 of the ring in sum.
    const double centre = limit.centre * step.centre + static_cast<double>(n) * limit.each * 0.375;
    const double each = limit.centre * step.each + limit.each * 0.625;
    EXPECT_NEAR(centre, limit.centre, 4e-16) << n;
    EXPECT_NEAR(each, limit.each, 4e-16) << n;
  }
}

TEST(loop_masks, are_exact_where_they_are_dyadic) {
  EXPECT_EQ(vertex_mask(6).centre, 0.625);
  EXPECT_EQ(vertex_mask(6).each, 0.0625);
  EXPECT_EQ(vertex_mask(3).each, 0.1875);
  EXPECT_EQ(vertex_mask(4).centre, 0.515625);
  for (const std::size_t n : {3u, 4u, 6u}) EXPECT_EQ(vertex_mask(n).error, 0) << n;
  EXPECT_EQ(limit_mask(6).centre, 0.5);
}

}  // namespace
}  // namespace snug::loop_test
