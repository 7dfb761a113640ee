#pragma once

#include <stdexcept>
#include <string>

/// Marks what a shared libsnug exports.
#define SNUG_API __attribute__((visibility("default")))

namespace snug {

/// What is wrong with an input.
enum class InputProblem {
  unreadable,       ///< a file that cannot be opened, read, written or parsed
  refused,          ///< a mesh that is defective or not supported
  pose,             ///< a transform that is not rigid, mirrors, or is not finite
  value,            ///< a point, tolerance, parameter or option that is not finite or out of its range
  unrepresentable,  ///< a result that does not fit a double
};

/// Bad input. The message is one line that names the file, line, face or vertex, and the next step.
class SNUG_API InputError : public std::runtime_error {
 public:
  InputError(InputProblem problem, const std::string& message)
      : std::runtime_error(message), problem_(problem) {}
  [[nodiscard]] InputProblem problem() const noexcept { return problem_; }

 private:
  InputProblem problem_;
};

/// Thrown at the next checkpoint after a stop was requested, see WorkMonitor.
class SNUG_API Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace snug
