#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace snug {

/// The code points of a UTF-8 text; bytes that are none are each one by themselves.
[[nodiscard]] std::u32string code_points(std::string_view utf8);
/// Adds a code point as UTF-8.
void append_utf8(std::string& text, std::uint32_t code);

}  // namespace snug
