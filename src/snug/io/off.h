#pragma once

#include <string>
#include <string_view>

#include <snug/mesh/control_mesh.h>

namespace snug {

/// Whether a text begins with the header word of the OFF family, after blanks and comments.
[[nodiscard]] bool begins_like_off(std::string_view text);

/// The control mesh that an OFF text describes. `name` is what messages call the text.
///
/// Reads:     the header word OFF with any of the prefixes ST, C, N (texture coordinates, colours and normals
///            after the coordinates are ignored), or none; the counts on its line or the next, with or without a
///            number of edges; face colours are ignored. Comments and blank lines may stand anywhere. An element
///            begins a new line and ends with it. Over several lines it may go on only if the file has more
///            lines than elements; vertices may share lines only if a plain OFF file has fewer, and its first
///            vertex does. So words cannot slip from one element to the next and still fit the end of the file.
/// Guarantee: as parse_obj; OFF has no tags.
/// Errors:    InputError (unreadable) naming the line: numbers that are not finite, indices that name no
///            vertex, faces without corners, more or fewer elements than the header promises, no vertices or
///            faces, 4OFF, nOFF and OFF BINARY, a file that is no text.
/// Cost:      linear in the text, whatever the header promises.
[[nodiscard]] ControlMesh parse_off(std::string_view text, const std::string& name);

/// The mesh as OFF text that parse_off reads back bit by bit, without its tags: OFF has none.
///
/// Errors:    InputError (value) on coordinates that are not finite and on faces without corners.
[[nodiscard]] std::string format_off(const ControlMesh& mesh);

}  // namespace snug
