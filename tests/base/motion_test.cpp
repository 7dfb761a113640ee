#include <snug/base/motion.h>

#include <gtest/gtest.h>
#include <snug/base/error.h>

#include <cmath>

namespace snug {
namespace {

Placement turned(double angle, double stretch = 1) {
  const double c = stretch * std::cos(angle), s = stretch * std::sin(angle);
  return {{c, -s, 0, 1, s, c, 0, 2, 0, 0, stretch, 3}};
}

TEST(require_rigid, accepts_motions) {
  EXPECT_NO_THROW(require_rigid({}));
  EXPECT_NO_THROW(require_rigid(turned(0.7)));
  EXPECT_NO_THROW(require_rigid(turned(0.7, 1 + 4e-10)));
}

TEST(require_rigid, refuses_scaling_mirrors_and_what_is_not_finite) {
  EXPECT_THROW(require_rigid(turned(0.7, 1 + 2e-9)), InputError);
  EXPECT_THROW(require_rigid({{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0}}), InputError);
  EXPECT_THROW(require_rigid({{1, 0, 0, NAN, 0, 1, 0, 0, 0, 0, 1, 0}}), InputError);
  EXPECT_THROW(require_rigid({{1, 0, INFINITY, 0, 0, 1, 0, 0, 0, 0, 1, 0}}), InputError);
  EXPECT_THROW(require_rigid({{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}), InputError);
}

TEST(rigidity_defect, is_tiny_for_rotations_and_never_zero) {
  EXPECT_LT(rigidity_defect(turned(1.1)), 1e-14);
  EXPECT_GT(rigidity_defect({}), 0);
}

}  // namespace
}  // namespace snug
