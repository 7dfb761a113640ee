#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

#include <snug/mesh.h>
#include <snug/mesh/control_mesh.h>
#include <support/text_cursor.h>

namespace snug {

/// Collects the `t` statements of an OBJ text, in the form of OpenSubdiv's shapes:
///
///     t NAME INTS/FLOATS/STRINGS int... float... string...
///
///     crease               a chain of two or more vertices; one sharpness, or one for each edge of the chain
///     corner               one or more vertices; one sharpness, or one for each
///     hole                 faces
///     interpolateboundary  0 none, 1 edge-and-corner, 2 edge-only
///     creasemethod         "normal" or "uniform", "chaikin"
///     smoothtriangles      "catmark", "smooth"
///     scheme               the name of a scheme of surfaces; this one is snug's own
///
/// Vertices and faces count from 0 here, although `f` counts from 1. Tags may precede the elements they name. Of
/// the last four the last one in the file holds. `facevaryinginterpolateboundary` does not concern the
/// surface and is ignored; so are hierarchical edits (`vertexedit`, `edgeedit`, `faceedit`) and unknown
/// names, each name with one note.
class ObjTagReader {
 public:
  /// Requires:  the reader does not outlive `notes`.
  explicit ObjTagReader(const Notes& notes) : notes_(notes) {}

  /// Reads one statement; the cursor is after the word `t`.
  ///
  /// Errors:    InputError (unreadable) naming line and value: too few or too many values, ids that are
  ///            negative or no whole numbers, a sharpness that is negative or not finite, an unknown choice.
  void read(TextCursor& at);

  /// Everything read, once all vertices and faces are known.
  ///
  /// Errors:    InputError (unreadable) naming the line of an id that is out of range.
  [[nodiscard]] MeshTags finish(const TextCursor& at, std::size_t vertex_count, std::size_t face_count);

 private:
  /// The largest id of a sort that tags name, and where.
  struct Largest {
    const char* kind;
    std::uint64_t id = 0;
    std::size_t line = 0;
  };

  void ignore(const TextCursor& at, std::string_view name);
  static std::size_t reference(const TextCursor& at, std::uint64_t id, Largest& largest);

  const Notes& notes_;
  std::set<std::string, std::less<>> ignored_;
  MeshTags tags_;
  Largest vertices_{"vertex"}, faces_{"face"};
};

/// Appends the `t` statements that ObjTagReader reads back as the same tags. One edge, vertex or face a
/// statement, so that readers with short lines, or with another idea of long creases, agree.
///
/// Errors:    InputError (value) on a sharpness that is not finite.
void append_obj_tags(std::string& text, const MeshTags& tags);

}  // namespace snug
