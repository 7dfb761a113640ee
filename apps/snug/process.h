#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// The process and what surrounds it, as POSIX and Windows have them. Interrupts end in `stop_requested` (progress_bar.h) and, 0.3 s
/// later or at a second one, in end_interrupted().
namespace snug::command::process {

/// The arguments after the name of the program, as UTF-8.
[[nodiscard]] std::vector<std::string> arguments(int argc, char** argv);
/// Where the program lies; empty if the system does not say.
[[nodiscard]] std::filesystem::path folder();
[[nodiscard]] bool is_terminal(int descriptor);
/// Would a read return at once?
[[nodiscard]] bool can_read_now(int descriptor);
/// Without destructors. Async-signal-safe.
[[noreturn]] void end(int status) noexcept;

/// Descriptors 0 to 2 that are closed become ones that fail as closed ones do, so that no file is opened in
/// their place and receives messages: to be called before any file is opened.
void hold_standard_descriptors() noexcept;
/// Loads, while there is memory, the library that the C library unwinds through itself with (std::call_once).
void load_what_unwinds() noexcept;

/// Its names are seen by libraries that are loaded later; null on failure.
[[nodiscard]] void* load_library(const std::filesystem::path& file);
[[nodiscard]] void* symbol_of(void* library, const char* name);

}  // namespace snug::command::process
