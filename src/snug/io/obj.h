#pragma once

#include <string>
#include <string_view>

#include <snug/mesh.h>
#include <snug/mesh/control_mesh.h>

namespace snug {

/// The control mesh that an OBJ text describes. `name` is what messages call the text.
///
/// Reads:     `v` (three numbers; a weight or colour after them is ignored), `f` and its old name `fo`
///            (corners as a, a/b, a//c or a/b/c; negative indices count back from the line they are on,
///            positive ones may point ahead), `l` (a polyline, likewise), and the tags of obj_tags.h.
///            Everything else is ignored: normals, texture coordinates, groups, free-form curves. Words may
///            be separated and lines may end as in text_cursor.h.
/// Guarantee: coordinates are the nearest doubles. Vertices, faces and polylines keep their order; messages
///            number them from 0, as everywhere in snug. Faces with repeated corners, or with one or two, are
///            kept: see mesh/validate.h.
/// Notes:     one line for each sort of tag that is left out although it changes the surface, hierarchical
///            edits among them: the surface is the one without them.
/// Errors:    InputError (unreadable) naming the line: numbers that are not finite, indices that name no
///            vertex, faces and polylines without corners, tags with bad values, statements of the SMF format
///            that would move or renumber vertices, no vertices, neither faces nor polylines, a file that is
///            no text.
/// Cost:      linear; about 0.4 s for a million triangles.
[[nodiscard]] ControlMesh parse_obj(std::string_view text, const std::string& name, const Notes& notes = {});

/// The mesh as OBJ text that parse_obj reads back as the same mesh, tags included and bit by bit.
///
/// Errors:    InputError (value) on coordinates that are not finite and on faces or polylines without corners.
[[nodiscard]] std::string format_obj(const ControlMesh& mesh);

}  // namespace snug
