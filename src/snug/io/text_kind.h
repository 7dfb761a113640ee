#pragma once

#include <string>
#include <string_view>

namespace snug {

/// Errors:    InputError (unreadable) that says what the bytes look like, and what to do, if they are empty,
///            UTF-16 with a mark, compressed, or of another known format.
void refuse_other_formats(std::string_view bytes, const std::string& name);

/// The text of a file that should be plain text: without a UTF-8 byte order mark and a final control-Z.
///
/// Errors:    as refuse_other_formats; InputError (unreadable) for text that is UTF-16 without a mark or
///            holds NUL bytes; control characters are looked for in the first 4 KiB.
/// Cost:      one pass that looks for NUL bytes.
[[nodiscard]] std::string_view plain_text(std::string_view bytes, const std::string& name);

}  // namespace snug
