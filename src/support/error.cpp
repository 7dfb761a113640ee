#include <support/error.h>

#include <charconv>
#include <cmath>

namespace snug {

void refuse_value(const char* message) { throw InputError(InputProblem::value, message); }

std::string shortest(double x) {
  char digits[32];
  const char* const end = std::to_chars(digits, digits + sizeof digits, x).ptr;
  return {digits, static_cast<std::size_t>(end - digits)};
}

void require_length(double x, const char* what) {
  if (x >= 0 && std::isfinite(x)) return;
  throw InputError(InputProblem::value,
                   std::string(what) + " is " + shortest(x) + ": give a finite number that is not negative");
}

}  // namespace snug
