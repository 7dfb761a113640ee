#pragma once

#include <stdexcept>
#include <string>

namespace snug {

/// Which side of the border bad data failed at; the command turns it into its exit status.
enum class InputProblem {
  unreadable,  ///< a file that cannot be opened, read, written or parsed
  refused,     ///< a mesh, placement or option that is well formed but outside what snug answers
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

/// Thrown at the next check point after an interruption was asked for (base/progress.h).
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace snug
