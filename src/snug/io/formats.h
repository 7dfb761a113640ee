#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include <snug/io/other_file.h>
#include <snug/io/placed_meshes.h>
#include <snug/mesh.h>
#include <snug/mesh/control_mesh.h>

/// The formats of meshes, from bytes and to bytes. `name` is what messages call the file. docs/command.md, "Files", has
/// what each parser reads and ignores.
///
/// Guarantee: whatever a parser reads costs time linear in the bytes, whatever a header promises. Faces with
///            repeated corners, or with one or two, are kept: see mesh/validate.h.
/// Errors:    parsers throw InputError (unreadable) naming the line, element or facet, at least for
///            coordinates that are not finite, indices that name no vertex, faces without corners, and files
///            without vertices or faces. Writers throw InputError (value) on coordinates that are not finite
///            and on faces or polylines without corners.
namespace snug {

/// The control mesh that an OBJ text describes.
///
/// Guarantee: coordinates are the nearest doubles. Vertices, faces and polylines keep their order; messages
///            number them from 0, as everywhere in snug.
/// Notes:     one line for each sort of tag that is left out although it changes the surface, hierarchical
///            edits among them: the surface is the one without them.
/// Errors:    also polylines without corners, tags with bad values, statements of the SMF format that would
///            move or renumber vertices, a file that is no text.
[[nodiscard]] ControlMesh parse_obj(std::string_view text, const std::string& name, const Notes& notes = {});

/// The mesh as OBJ text that parse_obj reads back as the same mesh, tags included and bit by bit.
[[nodiscard]] std::string format_obj(const ControlMesh& mesh);

/// Whether a text begins with the header word of the OFF family, after blanks and comments.
[[nodiscard]] bool begins_like_off(std::string_view text);

/// The control mesh that an OFF text describes.
///
/// Reads:     an element begins a new line and ends with it. Over several lines it may go on only if the file has
///            more lines than elements; vertices may share lines only if a plain OFF file has fewer, and its first
///            vertex does. So words cannot slip from one element to the next and still fit the end of the file.
/// Guarantee: as parse_obj; OFF has no tags.
/// Errors:    also more or fewer elements than the header promises, 4OFF, nOFF and OFF BINARY, a file that is
///            no text.
[[nodiscard]] ControlMesh parse_off(std::string_view text, const std::string& name);

/// The mesh as OFF text that parse_off reads back bit by bit, without its tags: OFF has none.
[[nodiscard]] std::string format_off(const ControlMesh& mesh);

/// Whether the bytes begin with the line "ply".
[[nodiscard]] bool begins_like_ply(std::string_view bytes);

/// The control mesh that a PLY file describes.
///
/// Guarantee: coordinates are exactly the numbers of a binary file; in ascii files they are the doubles
///            nearest to the decimals, whatever type the header names. Vertices and faces keep their order.
/// Errors:    also a header that is not as above, `tristrips` that are not empty, values that do not fit
///            their type, more or fewer elements than the header promises.
/// Source:    Greg Turk's PLY files; differs: nothing may follow the last element but blanks and line ends.
[[nodiscard]] ControlMesh parse_ply(std::string_view bytes, const std::string& name);

/// The mesh as a binary PLY file, little endian, with double coordinates, which parse_ply reads back bit by
/// bit, without its tags: PLY has none. Lists of corners are counted by bytes where all faces have at most
/// 255 corners; indices are `int`, or `uint` where a mesh has more vertices than that.
[[nodiscard]] std::string format_ply(const ControlMesh& mesh);

/// The control mesh that an STL file describes.
///
/// Guarantee: coordinates are exactly the floats of a binary file and the doubles nearest to the decimals of
///            an ascii one. Corners become one vertex where they are equal, 0 and -0 being equal. Vertices
///            are numbered in the order of their first corners. Facets keep their order. The tag of the
///            scheme is flat: the facets are meant.
/// Errors:    also facets that are no triangles, a size that does not agree with the number of facets, a file
///            that is neither.
[[nodiscard]] ControlMesh parse_stl(std::string_view bytes, const std::string& name);

/// The mesh as a binary STL file with normals, without its tags. Coordinates are rounded to the nearest
/// float; vertices that no face uses are left out, and vertices in one place become one when it is read.
///
/// Notes:     one line if coordinates were rounded.
/// Errors:    InputError (refused) naming the face if one is no triangle, and the vertex if its coordinates
///            do not fit a float; for more than 2^32 - 1 facets.
[[nodiscard]] std::string format_stl(const ControlMesh& mesh, const std::string& name,
                                     const Notes& notes = {});

/// Whether a text begins with the header of USD's text format.
[[nodiscard]] bool begins_like_usda(std::string_view text);

/// The control mesh that a USD text describes.
///
/// Guarantee: coordinates are the doubles nearest to the decimals, whatever type the file names; where a
///            transform is not the identity, they are at most as far off as a note says. Meshes, vertices and
///            faces keep their order. The scheme and the rules are tags, the scheme always: `catmullClark`
///            where the file names none; `none` is flat, or bilinear where a face is no triangle. Faces of
///            left-handed meshes, and of mirrored right-handed ones, are reversed.
/// Notes:     one line for each reason why meshes are left out, for transforms, for reversed faces, for units
///            and axes, and for `none` with faces that are no triangles.
/// Errors:    also references, payloads, inherits, specializes, variants, sublayers, instancers and values by
///            time where they may concern a mesh that counts; meshes whose schemes or rules differ; binary
///            files.
/// Source:    OpenUSD, UsdGeomMesh, UsdGeomXformable and UsdGeomImageable.
[[nodiscard]] ControlMesh parse_usda(std::string_view bytes, const std::string& name,
                                     const Notes& notes = {});
/// The same as meshes of their own, each with its own scheme and rules. Mirrored ones are not reversed yet.
[[nodiscard]] PlacedMeshes read_usda(std::string_view bytes, const std::string& name,
                                     const Notes& notes = {});

/// The mesh as a USD text with one prim, which parse_usda reads back bit by bit and with its tags. `points`
/// have the type that USD asks for, point3f, but all digits: other programs round them to floats.
///
/// Notes:     one line for a dual scheme and one for a crease method, which USD does not have.
/// Errors:    InputError (refused) for more than 2^31 - 1 vertices.
[[nodiscard]] std::string format_usda(const ControlMesh& mesh, const std::string& name,
                                      const Notes& notes = {});

/// The meshes of a 3MF package, and where its build items and components place them.
///
/// Guarantee: coordinates are the doubles nearest to the decimals; vertices and triangles keep their order. The tag of the
///            scheme is flat, the unit that of the model. Whatever the package promises: it unpacks to at most 100 times its
///            size and a mebibyte, makes at most 2^18 parts, and 100 times its size in vertices and corners.
/// Notes:     one line for objects of the types support and other, and one for each element of an extension that would
///            change the surface.
/// Errors:    also a package without a model or items, extensions that are needed other than production's, materials' and
///            triangle sets', other units in other files of the package, document types.
/// Source:    3MF core specification 1.3, production extension 1.1.
[[nodiscard]] PlacedMeshes read_3mf(std::string_view bytes, const std::string& name, const Notes& notes = {});
/// The same as one mesh, see joined().
[[nodiscard]] ControlMesh parse_3mf(std::string_view bytes, const std::string& name, const Notes& notes = {});

/// The mesh as a 3MF package with one object, all digits of its coordinates and its unit, without its tags. Faces become
/// fans of triangles.
///
/// Notes:     one line each if faces were split, if triangles that name a vertex twice were left out, and if the unit is not
///            known: millimetres are written.
/// Errors:    InputError (refused) for a unit that 3MF does not have, a face of one or two corners, more than 4 GiB.
[[nodiscard]] std::string format_3mf(const ControlMesh& mesh, const std::string& name,
                                     const Notes& notes = {});
/// Parts as items with their poses as they are; a mesh of several parts is one object, and a component of each of theirs.
///
/// Notes, errors: likewise; InputError (refused) also for meshes in different units.
/// Requires:  meshes of parts exist.
[[nodiscard]] std::string format_3mf(const MeshAssembly& assembly, const std::string& name,
                                     const Notes& notes = {});

/// Bytes before the first chunk of a binary glTF file, and of a chunk before its content.
inline constexpr std::size_t glb_header_size = 12, glb_chunk_head_size = 8;

/// Whether the bytes begin like a glTF file: the binary form, or JSON.
[[nodiscard]] bool begins_like_gltf(std::string_view bytes);

/// The meshes of the triangles of a glTF 2.0 file, binary or text, and the nodes that place them.
///
/// Guarantee: coordinates are exactly the floats. The file splits vertices by normals and the like: within a mesh, corners
///            become one vertex where they are equal. Triangles with two corners in one place are left out, the others keep
///            their order. Instances and shared accessors make at most 100 times the files. The tag of the scheme is flat:
///            the triangles are meant. The unit is a metre.
/// Notes:     one line each for primitives without triangles, triangles that are left out, and skins or morph targets,
///            which are not applied.
/// Errors:    also buffers of other files that `files` does not have or that are not in the file's folder, extensions that are
///            needed and may concern the geometry, such as Draco's and meshopt's, nodes that do not form trees.
/// Source:    glTF 2.0 specification, sections 3.5 to 3.7 and 4.4.
[[nodiscard]] PlacedMeshes read_gltf(std::string_view bytes, const std::string& name,
                                     const OtherFiles& files = {}, const Notes& notes = {});
/// The same as one mesh, see joined().
[[nodiscard]] ControlMesh parse_gltf(std::string_view bytes, const std::string& name,
                                     const OtherFiles& files = {}, const Notes& notes = {});

/// The mesh as a binary glTF 2.0 file, for viewers: one node, one mesh, one list of triangles; positions as
/// floats, indices of 32 bits, normals of the vertices if there are any, no materials. Its tags are left out.
///
/// Guarantee: a face of n corners becomes the n - 2 triangles of the fan at its first corner; vertices keep
///            their numbers. Coordinates are the nearest floats, `min` and `max` are exact. A vertex whose normal
///            is 0 0 0 gets 0 0 1: the format has unit vectors only.
/// Requires:  no normals, or one a vertex, of length 1 or 0.
/// Notes:     one line if coordinates were rounded; one if faces were split into triangles.
/// Errors:    InputError (refused) naming a face of one or two corners, or a vertex that does not fit floats;
///            for files beyond 4 GiB, which the format cannot hold, and meshes without triangles.
/// Source:    glTF 2.0 specification, sections 3.6, 3.7 and 4.4.
[[nodiscard]] std::string format_glb(const ControlMesh& mesh, const std::string& name,
                                     const Notes& notes = {}, std::span<const Vector3> normals = {});
/// The same as glTF text, with its buffer as a data URI: one file, a third longer.
[[nodiscard]] std::string format_gltf(const ControlMesh& mesh, const std::string& name,
                                      const Notes& notes = {}, std::span<const Vector3> normals = {});

/// Endings of files that Assimp reads.
inline constexpr std::array<std::string_view, 6> assimp_endings{".dae",   ".fbx", ".3ds",
                                                                ".blend", ".lwo", ".x"};
/// Was the library built with it?
[[nodiscard]] bool has_assimp();

/// The meshes of such a file, and the nodes that place them; COLLADA in metres, its axes as they are.
///
/// Guarantee: coordinates are the floats that Assimp makes of the file, which is the only one it opens. The meshes of a node, one for each
///            material, are one, in which corners with equal coordinates are one vertex. The tag of the scheme is flat if
///            all faces of the file are triangles. A broken file may do whatever Assimp does with it.
/// Notes:     one line each that coordinates are floats, for what is no face, and for what deforms the surface.
/// Errors:    also whatever Assimp refuses; always, in a library without it.
[[nodiscard]] PlacedMeshes read_assimp(std::string_view bytes, const std::string& ending,
                                       const std::string& name, const Notes& notes = {});

}  // namespace snug
