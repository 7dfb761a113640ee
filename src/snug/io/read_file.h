#pragma once

#include <string>

#include <snug/base/progress.h>

namespace snug {

/// All bytes of a file; "-" is standard input.
///
/// Errors:    InputError (unreadable) that names the file: an empty name, a directory, whatever the system
///            reports. Interrupted if a signal ends the wait for input and the monitor says stop.
[[nodiscard]] std::string read_file(const std::string& path, const WorkMonitor& monitor = {});

/// What messages call the file: its path, or "standard input" for "-".
[[nodiscard]] std::string input_name(const std::string& path);

}  // namespace snug
