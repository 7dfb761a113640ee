#include <snug/base/error.h>

#include <charconv>
#include <cmath>

namespace snug {

void refuse_value(const char* message) { throw InputError(InputProblem::value, message); }

void require_length(double x, const char* what) {
  if (x >= 0 && std::isfinite(x)) return;
  char digits[32];  // the shortest that read back: 1e-300 is not 0
  const char* const end = std::to_chars(digits, digits + sizeof digits, x).ptr;
  throw InputError(InputProblem::value, std::string(what) + " is " +
                                            std::string(digits, static_cast<std::size_t>(end - digits)) +
                                            ": give a finite number that is not negative");
}

}  // namespace snug
