#pragma once

#include <string>
#include <string_view>

#include <snug/run.h>

namespace snug {

/// All bytes of a file; "-" is standard input.
///
/// Errors:    InputError (unreadable) that names the file: an empty name, a directory, whatever the system
///            reports; a file larger than the machine's memory; one that yields more than 2^30 bytes, of
///            devices 2^20, unless that was its size when it was opened: it may never end. Interrupted if the
///            monitor says stop, also where a signal ends the wait for input.
[[nodiscard]] std::string read_file(const std::string& path, const WorkMonitor& monitor = {});

/// Name of the file in messages: its path, or "standard input" for "-".
[[nodiscard]] std::string input_name(const std::string& path);

/// Errors:    InputError (unreadable) that says what the bytes look like, and what to do, if they are empty,
///            UTF-16 with a mark, compressed, or of another known format.
void refuse_other_formats(std::string_view bytes, const std::string& name);

/// The text of a file that should be plain text: without a UTF-8 byte order mark and a final control-Z.
///
/// Errors:    as refuse_other_formats; InputError (unreadable) for text that is UTF-16 without a mark or
///            holds NUL bytes; control characters are looked for in the first 4 KiB.
[[nodiscard]] std::string_view plain_text(std::string_view bytes, const std::string& name);

}  // namespace snug
