#include <snug/io/formats.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <snug/io/obj_tags.h>
#include <support/error.h>
#include <support/number.h>
#include <support/read_file.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

/// The rest of a corner after its vertex index: nothing, or one or two slashes with optional integers.
bool is_corner_suffix(std::string_view suffix) {
  for (int part = 0; part < 2 && !suffix.empty(); ++part) {
    if (suffix.front() != '/') return false;
    suffix.remove_prefix(1);
    const std::size_t size = std::min(suffix.find('/'), suffix.size());
    if (size > 0 && !parse_integer(suffix.substr(0, size))) return false;
    suffix.remove_prefix(size);
  }
  return suffix.empty();
}

/// Statements by which SMF, a format much like OBJ, moves and renumbers the vertices after them.
bool is_smf_statement(std::string_view keyword) {
  constexpr std::array<std::string_view, 9> statements{"begin", "trans", "scale", "rot", "mmult",
                                                       "mload", "set",   "inc",   "dec"};
  return std::find(statements.begin(), statements.end(), keyword) != statements.end();
}

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name, const Notes& notes)
      : cursor_(text, name), tags_(notes) {}

  ControlMesh parse() {
    while (cursor_.next_line()) {
      const std::string_view keyword = cursor_.word();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "f" || keyword == "fo") {
        read_element("face", "faces", mesh_.face_vertices, mesh_.face_offsets);
      } else if (keyword == "l") {
        read_element("polyline", "polylines", mesh_.polyline_vertices, mesh_.polyline_offsets);
      } else if (keyword == "t") {
        tags_.read(cursor_);
      } else if (is_smf_statement(keyword)) {
        read_smf_statement(keyword);
      }
    }
    // Polylines alone are a mesh, too: that of curves.
    expect_elements(cursor_, mesh_.vertex_count(), mesh_.face_count() + mesh_.polyline_count());
    if (largest_.vertex >= mesh_.vertex_count()) {
      cursor_.fail_at(largest_.line, largest_.owner + ": index " + std::to_string(largest_.vertex + 1) +
                                         " is beyond the " + std::to_string(mesh_.vertex_count()) +
                                         " vertices of the file");
    }
    mesh_.tags = tags_.finish(cursor_, mesh_.vertex_count(), mesh_.face_count());
    return std::move(mesh_);
  }

 private:
  struct Reference {
    std::uint64_t vertex = 0;
    std::size_t line = 0;
    std::string owner;  // "face 3"
  };

  void read_vertex() {
    const std::size_t vertex = mesh_.vertex_count();
    expect_room(cursor_, vertex, "vertices");
    Point3 point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = read_coordinate(cursor_, vertex, cursor_.word());
    }
    mesh_.points.push_back(point);
  }

  void read_element(const char* kind, const char* plural, std::vector<VertexId>& vertices,
                    std::vector<std::uint32_t>& offsets) {
    kind_ = kind;
    number_ = offsets.size() - 1;
    expect_room(cursor_, number_, plural);
    std::string_view corner = cursor_.word();
    if (corner.empty()) cursor_.fail(element() + " has no vertices");
    for (; !corner.empty(); corner = cursor_.word()) {
      expect_room(cursor_, vertices.size(), "corners of elements");
      vertices.push_back(read_corner(corner));
    }
    offsets.push_back(static_cast<std::uint32_t>(vertices.size()));
  }

  VertexId read_corner(std::string_view corner) {
    const std::size_t slash = std::min(corner.find('/'), corner.size());
    const auto index = parse_integer(corner.substr(0, slash));
    if (!index || !is_corner_suffix(corner.substr(slash))) {
      fail_in_element(in_quotes(corner) + " is not a corner: write a, a/b, a//c or a/b/c with whole numbers");
    }
    if (*index == 0) fail_in_element("index 0 is not a vertex: OBJ counts from 1");
    if (*index < 0) {
      const auto above = static_cast<std::int64_t>(mesh_.vertex_count());
      if (*index < -above) {
        fail_in_element("index " + std::to_string(*index) + " goes back beyond the first of the " +
                        std::to_string(above) + " vertices above this line");
      }
      return VertexId(static_cast<std::size_t>(above + *index));
    }
    const auto vertex = static_cast<std::uint64_t>(*index) - 1;
    if (vertex >= max_elements) {
      fail_in_element("index " + std::string(corner.substr(0, slash)) +
                      " is larger than a vertex count can be");
    }
    // A larger index is legal here: its vertex may come later in the file.
    if (vertex >= mesh_.vertex_count() && vertex > largest_.vertex) {
      largest_ = {vertex, cursor_.line(), element()};
    }
    return VertexId(vertex);
  }

  void read_smf_statement(std::string_view keyword) {
    // One block that holds the whole file changes nothing.
    if (keyword == "begin" && mesh_.vertex_count() == 0) return;
    cursor_.fail(in_quotes(keyword) +
                 " is a statement of the SMF format that OBJ does not have: convert the file to OBJ");
  }

  /// The current element, for messages: "face 3".
  [[nodiscard]] std::string element() const { return kind_ + (' ' + std::to_string(number_)); }

  [[noreturn]] void fail_in_element(const std::string& message) const {
    cursor_.fail(element() + ": " + message);
  }

  TextCursor cursor_;
  ObjTagReader tags_;
  ControlMesh mesh_;
  Reference largest_;
  const char* kind_ = "face";
  std::size_t number_ = 0;
};

void append_element(std::string& text, char keyword, std::span<const VertexId> vertices) {
  require_value(!vertices.empty(), "OBJ: a face or polyline to write has no corners; take it out");
  text += keyword;
  for (const VertexId vertex : vertices) {
    text += ' ';
    append_integer(text, std::uint64_t{vertex.value()} + 1);
  }
  text += '\n';
}

}  // namespace

ControlMesh parse_obj(std::string_view text, const std::string& name, const Notes& notes) {
  return ObjParser(plain_text(text, name), name, notes).parse();
}

std::string format_obj(const ControlMesh& mesh) {
  std::string text;
  text.reserve(mesh.vertex_count() * 48 + (mesh.face_vertices.size() + mesh.polyline_vertices.size()) * 9);
  for (const Point3& point : mesh.points) {
    text += "v ";
    append_point(text, point);
    text += '\n';
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) append_element(text, 'f', mesh.face(FaceId(f)));
  for (std::size_t p = 0; p < mesh.polyline_count(); ++p) {
    append_element(text, 'l', mesh.polyline(PolylineId(p)));
  }
  append_obj_tags(text, mesh.tags);
  return text;
}

}  // namespace snug
