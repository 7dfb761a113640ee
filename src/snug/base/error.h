#pragma once

#include <stdexcept>
#include <string>

namespace snug {

/// What a caller or a file got wrong; the command turns it into its exit status.
enum class InputProblem {
  unreadable,       ///< a file that cannot be opened, read, written or parsed
  refused,          ///< a mesh that is well formed but outside what snug answers
  pose,             ///< a motion that is not rigid, mirrors, or is not finite
  value,            ///< a point, tolerance, parameter or option that is not finite or out of its range
  unrepresentable,  ///< a result that does not fit a double
};

/// Bad data from outside. The message is one line that names the file, line, face or vertex, and the next
/// step.
class InputError : public std::runtime_error {
 public:
  InputError(InputProblem problem, const std::string& message)
      : std::runtime_error(message), problem_(problem) {}
  [[nodiscard]] InputProblem problem() const noexcept { return problem_; }

 private:
  InputProblem problem_;
};

/// Throws InputError (value) with this message.
[[noreturn]] void refuse_value(const char* message);
/// The same unless `holds`: for what a public function requires of its caller. The message is one line that names the thing
/// and the next step.
inline void require_value(bool holds, const char* message) {
  if (!holds) refuse_value(message);
}

/// Throws InputError (value), naming `what`, unless x is finite and >= 0.
void require_length(double x, const char* what);

/// Thrown at the next check point after an interruption was asked for (base/progress.h).
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace snug
