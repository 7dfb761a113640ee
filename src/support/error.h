#pragma once

#include <cmath>
#include <string>

#include <snug/run.h>

namespace snug {

/// Throws InputError (value) with this message, one line that names the thing and the next step.
[[noreturn]] void refuse_value(const char* message);
/// The same unless `holds`: for what a public function requires of its caller.
inline void require_value(bool holds, const char* message) {
  if (!holds) refuse_value(message);
}

/// Throws InputError (refused) for a surface that bounds no solid; `reason` is that of Surface::open_reason().
[[noreturn]] void refuse_open(const std::string& reason);

/// The shortest digits that read back as x: 1e-300 is not 0.
[[nodiscard]] std::string shortest(double x);

[[noreturn]] void refuse_length(double x, const char* what);
/// Throws InputError (value), naming `what`, unless x is finite and >= 0.
inline void require_length(double x, const char* what) {
  if (!(x >= 0 && x < INFINITY)) refuse_length(x, what);
}

}  // namespace snug
