#pragma once

#include <string>
#include <string_view>

#include <snug/mesh.h>
#include <snug/mesh/control_mesh.h>

namespace snug {

/// The control mesh that an STL file describes. `name` is what messages call it.
///
/// Reads:     binary files: exactly 84 + 50 n bytes, n facets, whatever the first 80 bytes are; and ascii
///            files: text that begins with `solid`. Words count in any case, and the solids of one file are
///            joined. Normals, attributes, and names are ignored.
/// Guarantee: coordinates are exactly the floats of a binary file and the doubles nearest to the decimals of
///            an ascii one. Corners become one vertex where they are equal, 0 and -0 being equal. Vertices
///            are numbered in the order of their first corners. Facets keep their order; those with equal
///            corners are kept, see mesh/validate.h.
/// Errors:    InputError (unreadable) naming line or facet: coordinates that are not finite, facets that are
///            no triangles, a size that does not agree with the number of facets, no facets, a file that is
///            neither.
/// Cost:      linear.
[[nodiscard]] ControlMesh parse_stl(std::string_view bytes, const std::string& name);

/// The mesh as a binary STL file with normals, without its tags. Coordinates are rounded to the nearest float;
/// vertices that no face uses are left out, and vertices in one place become one when it is read. `name` is what
/// messages call the file.
///
/// Notes:     one line if coordinates were rounded.
/// Errors:    InputError (refused) naming the face if one is no triangle, and the vertex if its coordinates do
///            not fit a float; for more than 2^32 - 1 facets. InputError (value) on coordinates that are not finite.
[[nodiscard]] std::string format_stl(const ControlMesh& mesh, const std::string& name,
                                     const Notes& notes = {});

}  // namespace snug
