#pragma once

#include <optional>
#include <string>
#include <vector>

namespace snug::command {

/// What a program in the folder of this executable writes to standard output. Its standard error is ours.
///
/// Returns:   nothing if there is no such program.
/// Errors:    InputError (unreadable) if it fails; Interrupted if an interrupt ended it.
[[nodiscard]] std::optional<std::string> output_of_neighbour(const std::string& program,
                                                             const std::vector<std::string>& arguments);

/// A file such as "examples/models/star.obj" below the current folder, or below one of those above this executable; nothing if there
/// is none.
[[nodiscard]] std::optional<std::string> file_around(const std::string& name);

}  // namespace snug::command
