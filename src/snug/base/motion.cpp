#include <snug/base/motion.h>

#include <string>

#include <snug/base/error.h>
#include <snug/base/rounding.h>

namespace snug {

double rigidity_defect(const Placement& placement) {
  double worst = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 a{placement.m[i], placement.m[4 + i], placement.m[8 + i]};
    for (std::size_t j = i; j < 3; ++j) {
      const Vector3 b{placement.m[j], placement.m[4 + j], placement.m[8 + j]};
      const double defect = std::fabs(dot(a, b) - (i == j ? 1.0 : 0.0)) + 8 * unit_roundoff;
      if (!(defect <= worst)) worst = std::isfinite(defect) ? defect : INFINITY;
    }
  }
  return worst;
}

void require_rigid(const Placement& placement) {
  for (std::size_t i = 0; i < 12; ++i) {
    if (!std::isfinite(placement.m[i])) {
      throw InputError(InputProblem::refused,
                       "placement: number " + std::to_string(i + 1) + " of 12 is not finite");
    }
  }
  const double defect = rigidity_defect(placement);
  if (!(defect <= rigidity_tolerance)) {
    throw InputError(
        InputProblem::refused,
        "placement: its 3x3 part is off from a rotation by more than 1e-9; give an orthonormal one");
  }
  if (dot(cross(placement.row(0), placement.row(1)), placement.row(2)) < 0) {
    throw InputError(InputProblem::refused, "placement: it mirrors; give a rotation with determinant 1");
  }
}

}  // namespace snug
