#pragma once

#include <string>

#include <snug/monitor.h>

namespace snug {

/// All bytes of a file; "-" is standard input.
///
/// Errors:    InputError (unreadable) that names the file: an empty name, a directory, whatever the system
///            reports; a file larger than the machine's memory; one that yields more than 2^30 bytes, of
///            devices 2^20, unless that was its size when it was opened: it may never end. Interrupted if the
///            monitor says stop, also where a signal ends the wait for input.
[[nodiscard]] std::string read_file(const std::string& path, const WorkMonitor& monitor = {});

/// What messages call the file: its path, or "standard input" for "-".
[[nodiscard]] std::string input_name(const std::string& path);

}  // namespace snug
