#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <snug/geometry/point.h>
#include <snug/io/text_cursor.h>

namespace snug {

/// More vertices, faces or face corners than this do not fit 32-bit ids.
inline constexpr std::uint64_t most_elements = 0xFFFFFFFE;

/// One coordinate of a vertex.
///
/// Errors:    InputError (unreadable) naming line, vertex and word, unless the word is a finite number.
[[nodiscard]] double read_coordinate(const TextCursor& at, std::size_t vertex, std::string_view word);

/// Errors:    InputError (unreadable) unless one more element fits; `what` is the plural of its sort.
void expect_room(const TextCursor& at, std::size_t count, const char* what);

/// Errors:    InputError (unreadable) if there are no vertices or no faces.
void expect_elements(const TextCursor& at, std::size_t vertices, std::size_t faces);

/// Appends "x y z".
///
/// Errors:    InputError (value) on a coordinate that is not finite.
void append_point(std::string& text, const Point3& point);

}  // namespace snug
