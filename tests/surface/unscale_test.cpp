#include <snug/surface/unscale.h>

#include <gtest/gtest.h>
#include <support/error.h>

namespace snug::unscale_test {
namespace {

TEST(unscaled, is_exact_in_the_normal_range) {
  const OffsetTriangle scaled{{Point3{1, 0.1, 0.2}, {1.3, 0, 0}, {0, 1.7, 0}}, 0.01, 1e-16};
  const OffsetTriangle back = unscaled(scaled, PowerOfTwo(-900));
  EXPECT_EQ(back.radius, std::ldexp(0.01, -900));
  EXPECT_EQ(back.base[0].y, std::ldexp(0.1, -900));
}

TEST(unscaled, widens_where_denormals_lose_digits) {
  const OffsetTriangle scaled{{Point3{1, 0.1, 0.2}, {1.3, 0, 0}, {0, 1.7, 0}}, 0.01, 1e-16};
  const OffsetTriangle back = unscaled(scaled, PowerOfTwo(-1060));
  EXPECT_GE(back.radius, 2e-308);
  // An exact radius grows too where the base is not exact.
  const OffsetTriangle exact_radius{scaled.base, 0.25, 0};
  EXPECT_GE(unscaled(exact_radius, PowerOfTwo(-1060)).radius, std::ldexp(0.25, -1060) + 2e-308);
  EXPECT_GT(unscaled_up(1.0 / 3, PowerOfTwo(-1060)), unscaled_down(1.0 / 3, PowerOfTwo(-1060)));
}

TEST(unscaled, refuses_what_overflows) {
  const Box3 box{{-1, -1, -1}, {3.9, 1, 1}};
  EXPECT_THROW(static_cast<void>(unscaled(box, PowerOfTwo(1023))), InputError);
}

}  // namespace
}  // namespace snug::unscale_test
