#include <support/error.h>

#include <charconv>
#include <cmath>

namespace snug {

void refuse_value(const char* message) { throw InputError(InputProblem::value, message); }

void refuse_open(const std::string& reason) {
  throw InputError(InputProblem::refused, "solids are bounded by closed surfaces, and " + reason +
                                              "; close the mesh or ask about its surface");
}

std::string shortest(double x) {
  char digits[32];
  const char* const end = std::to_chars(digits, digits + sizeof digits, x).ptr;
  return {digits, static_cast<std::size_t>(end - digits)};
}

void refuse_length(double x, const char* what) {
  throw InputError(InputProblem::value,
                   std::string(what) + " is " + shortest(x) + ": give a finite number that is not negative");
}

}  // namespace snug
