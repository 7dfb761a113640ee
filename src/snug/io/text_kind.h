#pragma once

#include <string>
#include <string_view>

namespace snug {

/// The text of a file that should be plain text: without a UTF-8 byte order mark and a final control-Z.
///
/// Errors:    InputError (unreadable) that says what the bytes look like, and what to do, if they are empty,
///            UTF-16, compressed, of a known binary format, or hold NUL bytes; control characters are looked
///            for in the first 4 KiB.
/// Cost:      one pass that looks for NUL bytes.
[[nodiscard]] std::string_view plain_text(std::string_view bytes, const std::string& name);

}  // namespace snug
