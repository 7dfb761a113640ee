#include <snug/base/motion.h>

#include <algorithm>
#include <string>

#include <snug/base/error.h>
#include <snug/base/rounding.h>

namespace snug {

double rigidity_defect(const Placement& placement) {
  const auto& m = placement.m;
  const Vector3 a{m[0], m[4], m[8]}, b{m[1], m[5], m[9]}, c{m[2], m[6], m[10]};
  const double aa = std::fabs(dot(a, a) - 1), bb = std::fabs(dot(b, b) - 1), cc = std::fabs(dot(c, c) - 1);
  const double ab = std::fabs(dot(a, b)), bc = std::fabs(dot(b, c)), ca = std::fabs(dot(c, a));
  const double worst = std::max({aa, bb, cc, ab, bc, ca}) + 8 * unit_roundoff;
  // A NaN may have been lost in the maximum, but not in a sum.
  return std::isfinite(aa + bb + cc + ab + bc + ca) ? worst : INFINITY;
}

void require_rigid(const Placement& placement) {
  for (std::size_t i = 0; i < 12; ++i) {
    if (!std::isfinite(placement.m[i])) {
      throw InputError(InputProblem::pose,
                       "placement: number " + std::to_string(i + 1) + " of 12 is not finite");
    }
  }
  const double defect = rigidity_defect(placement);
  if (!(defect <= rigidity_tolerance)) {
    throw InputError(
        InputProblem::pose,
        "placement: its 3x3 part is off from a rotation by more than 1e-9; give an orthonormal one");
  }
  if (dot(cross(placement.row(0), placement.row(1)), placement.row(2)) < 0) {
    throw InputError(InputProblem::pose, "placement: it mirrors; give a rotation with determinant 1");
  }
}

}  // namespace snug
