#pragma once

#include <functional>
#include <string>

namespace snug {

/// Receives one line for each thing that a reader or writer leaves out although it changes the surface. An
/// empty function drops them: the library itself prints nothing.
using Notes = std::function<void(const std::string& line)>;

}  // namespace snug
