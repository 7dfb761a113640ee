#include <snug/base/error.h>

#include <cmath>

namespace snug {

void require_length(double x, const std::string& what) {
  if (x >= 0 && std::isfinite(x)) return;
  throw InputError(InputProblem::value,
                   what + " is " + std::to_string(x) + ": give a finite number that is not negative");
}

}  // namespace snug
