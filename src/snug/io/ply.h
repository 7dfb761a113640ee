#pragma once

#include <string>
#include <string_view>

#include <snug/mesh/control_mesh.h>

namespace snug {

/// Whether the bytes begin with the line "ply".
[[nodiscard]] bool begins_like_ply(std::string_view bytes);

/// The control mesh that a PLY file describes. `name` is what messages call it.
///
/// Reads:     version 1.0 of all three formats; `vertex` with the scalars x, y, z of any type, and `face` with
/// the list `vertex_index` or `vertex_indices` of any integer type. Elements stand in any order. Other elements
/// and properties, lists too, are passed over, and so are `comment` and `obj_info` lines. Types have their old
/// names (char to double) or the new ones (int8 to float64). Header lines end with LF, CR LF or CR, as the
/// first one does. In ascii files an element stands on a line of its own, in words as in text_cursor.h; blank
/// lines may stand between them.
/// Guarantee: coordinates are exactly the numbers of a binary file; in ascii files they are the doubles nearest
///            to the decimals, whatever type the header names. Vertices and faces keep their order. Faces with
///            repeated corners, or with one or two, are kept: see mesh/validate.h.
/// Errors:    InputError (unreadable) naming line or element: a header that is not as above, `tristrips` that
///            are not empty, coordinates that are not finite, indices that name no vertex, faces without
///            corners, values that do not fit their type, more or fewer elements than the header promises, no
///            vertices or faces.
/// Cost:      linear in the file, whatever the header promises.
/// Source:    Greg Turk's PLY files; differs: nothing may follow the last element but blanks and line ends.
[[nodiscard]] ControlMesh parse_ply(std::string_view bytes, const std::string& name);

/// The mesh as a binary PLY file, little endian, with double coordinates, which parse_ply reads back bit by
/// bit, without its tags: PLY has none. Lists of corners are counted by bytes where all faces have at most
/// 255 corners; indices are `int`, or `uint` where a mesh has more vertices than that.
///
/// Errors:    InputError (value) on coordinates that are not finite and on faces without corners.
[[nodiscard]] std::string format_ply(const ControlMesh& mesh);

}  // namespace snug
