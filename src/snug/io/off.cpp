#include <snug/io/formats.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <support/error.h>
#include <support/number.h>
#include <support/read_file.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

/// The prefix of a header word "[ST][C][N][4][n]OFF"; nothing if the word is not one.
std::optional<std::string_view> header_prefix(std::string_view word) {
  if (!word.ends_with("OFF")) return std::nullopt;
  const std::string_view prefix = word.substr(0, word.size() - 3);
  std::string_view rest = prefix;
  for (const std::string_view part : {"ST", "C", "N", "4", "n"}) {
    if (rest.starts_with(part)) rest.remove_prefix(part.size());
  }
  return rest.empty() ? std::optional(prefix) : std::nullopt;
}

/// Where the elements of a file stand.
enum class Layout {
  line_each,     ///< one element on each line
  broken_lines,  ///< an element begins a line and may go on over several
  shared_lines,  ///< vertices follow one another freely
};

class OffParser {
 public:
  OffParser(std::string_view text, const std::string& name) : cursor_(text, name) {}

  ControlMesh parse() {
    read_header();
    // A promise allocates no more than the text can keep: a vertex takes 6 bytes, a face 4.
    mesh_.points.reserve(std::min(vertices_, cursor_.bytes_left() / 6));
    mesh_.face_offsets.reserve(std::min(faces_, cursor_.bytes_left() / 4) + 1);
    while (mesh_.vertex_count() < vertices_) read_vertex();
    while (mesh_.face_count() < faces_) read_face();
    if (const std::string_view extra = cursor_.word_across_lines(); !extra.empty()) {
      cursor_.fail(in_quotes(extra) + " follows the " + std::to_string(faces_) +
                   " faces that the header declares: correct the counts");
    }
    return std::move(mesh_);
  }

 private:
  void read_header() {
    std::string_view word = cursor_.word_across_lines();
    if (word.empty()) cursor_.fail_everywhere("the file has no header");
    std::string_view prefix;
    if (const auto found = header_prefix(word)) {
      prefix = *found;
      if (prefix.find_first_of("4n") != std::string_view::npos) {
        cursor_.fail(in_quotes(word) + " declares points that do not have three dimensions");
      }
      word = cursor_.word_across_lines();
    } else if (!parse_integer(word)) {
      cursor_.fail("the file begins with " + in_quotes(word) + " instead of OFF");
    }
    vertices_ = read_count(word, "vertices");
    const std::size_t line = cursor_.line();
    faces_ = read_count(cursor_.word_across_lines(), "faces");
    // The number of edges may be missing, but not among counts on lines of their own.
    if (cursor_.line() != line) read_count(cursor_.word_across_lines(), "edges");
    expect_elements(cursor_, vertices_, faces_);
    next_content();

    layout_ = layout_from_here(prefix);
  }

  [[nodiscard]] Layout layout_from_here(std::string_view prefix) const {
    const std::size_t lines = cursor_.count_lines_with_words();
    const std::size_t elements = vertices_ + faces_;
    if (lines > elements) return Layout::broken_lines;
    TextCursor ahead = cursor_;
    for (int coordinate = 0; coordinate < 3; ++coordinate) ahead.word();
    const bool shared = lines < elements && prefix.empty() && ahead.more_in_line();
    return shared ? Layout::shared_lines : Layout::line_each;
  }

  std::size_t read_count(std::string_view word, const std::string& what) {
    if (word.empty()) cursor_.fail("the file ends before its number of " + what);
    const auto count = parse_integer(word);
    if (!count || *count < 0)
      cursor_.fail("the header says " + in_quotes(word) + " instead of a number of " + what);
    if (static_cast<std::uint64_t>(*count) > max_elements) {
      cursor_.fail("the header declares " + std::string(word) + ' ' + what + ": at most " +
                   std::to_string(max_elements) + " are read");
    }
    return static_cast<std::size_t>(*count);
  }

  /// Leaves the rest of the line and stops at the next one that holds a word, or at the end.
  void next_content() {
    while (cursor_.next_line() && !cursor_.more_in_line()) continue;
  }

  std::string_view next_word(bool across_lines) {
    return across_lines ? cursor_.word_across_lines() : cursor_.word();
  }

  void read_vertex() {
    const std::size_t vertex = mesh_.vertex_count();
    expect_more(vertex, vertices_, "vertices");
    Point3 point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = read_coordinate(cursor_, vertex, next_word(layout_ != Layout::line_each));
    }
    mesh_.points.push_back(point);
    if (layout_ != Layout::shared_lines || !cursor_.more_in_line()) next_content();
  }

  void read_face() {
    const std::size_t face = mesh_.face_count();
    expect_more(face, faces_, "faces");
    const std::string_view count_word = cursor_.word();
    const auto count = parse_integer(count_word);
    if (!count || *count < 1) fail_in_face(in_quotes(count_word) + " is not a number of vertices");
    for (std::int64_t i = 0; i < *count; ++i) {
      const std::string_view word = next_word(layout_ == Layout::broken_lines);
      if (word.empty()) {
        fail_in_face("only " + std::to_string(i) + " of its " + std::to_string(*count) +
                     " vertices are given");
      }
      expect_room(cursor_, mesh_.face_vertices.size(), "face corners");
      mesh_.face_vertices.push_back(read_corner(word));
    }
    mesh_.face_offsets.push_back(static_cast<std::uint32_t>(mesh_.face_vertices.size()));
    next_content();
  }

  VertexId read_corner(std::string_view word) {
    const auto index = parse_integer(word);
    if (!index) fail_in_face(in_quotes(word) + " is not a whole number");
    if (*index < 0 || static_cast<std::uint64_t>(*index) >= vertices_) {
      fail_in_face("index " + std::to_string(*index) + " is outside 0 to " + std::to_string(vertices_ - 1));
    }
    return VertexId(static_cast<std::size_t>(*index));
  }

  void expect_more(std::size_t read, std::size_t promised, const std::string& what) const {
    if (cursor_.bytes_left() > 0) return;
    cursor_.fail("the file ends after " + std::to_string(read) + " of " + std::to_string(promised) + ' ' +
                 what + ": it is truncated, or its header declares too much");
  }

  [[noreturn]] void fail_in_face(const std::string& message) const {
    cursor_.fail("face " + std::to_string(mesh_.face_count()) + ": " + message);
  }

  TextCursor cursor_;
  ControlMesh mesh_;
  std::size_t vertices_ = 0, faces_ = 0;
  Layout layout_ = Layout::line_each;
};

}  // namespace

bool begins_like_off(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return header_prefix(TextCursor(text, {}).word_across_lines()).has_value();
}

ControlMesh parse_off(std::string_view text, const std::string& name) {
  return OffParser(plain_text(text, name), name).parse();
}

std::string format_off(const ControlMesh& mesh) {
  std::string text = "OFF\n";
  text.reserve(mesh.vertex_count() * 46 + mesh.face_vertices.size() * 9);
  append_integer(text, mesh.vertex_count());
  text += ' ';
  append_integer(text, mesh.face_count());
  text += " 0\n";
  for (const Point3& point : mesh.points) {
    append_point(text, point);
    text += '\n';
  }
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const auto corners = mesh.face(FaceId(face));
    require_value(!corners.empty(), "OFF: a face to write has no corners; take it out");
    append_integer(text, corners.size());
    for (const VertexId vertex : corners) {
      text += ' ';
      append_integer(text, vertex.value());
    }
    text += '\n';
  }
  return text;
}

}  // namespace snug
