#pragma once

#include <string>
#include <string_view>

namespace snug::command {

/// The text on one line, whatever it holds: control characters, line separators and marks that turn the writing direction
/// become \n, \t, \x1b, \u2028 and the like, bytes that are no UTF-8 \xff. All else stays.
[[nodiscard]] std::string one_line(std::string_view text);

/// The text as UTF-8: bytes that are none become U+FFFD, the mark for that.
[[nodiscard]] std::string as_utf8(std::string_view text);

/// Writes to standard error as it is. Nothing happens where that is closed or full: there is nobody left to
/// tell.
/// Guarantee: async-signal-safe.
void to_standard_error(std::string_view text) noexcept;

/// The name of the program, a colon and the text, on one line of standard error.
void print_message(std::string_view text) noexcept;

/// The name that messages begin with, `snug` until it is set.
/// Requires:  a string that stays where it is.
void set_program_name(const char* name) noexcept;
[[nodiscard]] const char* program_name() noexcept;

/// Writes text to standard output.
/// Errors:    InputError (unreadable) where it is closed or full.
void write_output(std::string_view text);

}  // namespace snug::command
