#include <support/scaling.h>

#include <support/contract.h>
#include <support/error.h>

namespace snug {

PowerOfTwo PowerOfTwo::normalising(double largest) {
  SNUG_EXPECT(std::isfinite(largest) && largest >= 0);
  return largest == 0 ? PowerOfTwo(0) : PowerOfTwo(-std::ilogb(largest));
}

double require_representable(double x) {
  if (!std::isfinite(x)) {
    throw InputError(InputProblem::unrepresentable,
                     "a result no longer fits a double: the coordinates are too large; scale the mesh down");
  }
  return x;
}

Point3 require_representable(Point3 p) {
  return {require_representable(p.x), require_representable(p.y), require_representable(p.z)};
}

Vector3 require_representable(Vector3 v) {
  return {require_representable(v.x), require_representable(v.y), require_representable(v.z)};
}

}  // namespace snug
