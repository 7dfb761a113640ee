#include <snug/io/formats.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <snug/mesh/weld.h>
#include <support/binary.h>
#include <support/error.h>
#include <support/number.h>
#include <support/read_file.h>
#include <support/scaling.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

constexpr std::size_t stl_header_size = 80, preamble_size = 84, facet_size = 50;

bool same_word(std::string_view word, std::string_view keyword) {
  return std::ranges::equal(word, keyword, {}, lower_case);
}

bool begins_like_ascii(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  return bytes.find('\0') == std::string_view::npos &&
         same_word(TextCursor(bytes, {}).word_across_lines(), "solid");
}

/// Three corners a facet.
using Corners = std::vector<Point3>;

Corners read_binary(std::string_view bytes, std::size_t facets, const std::string& name) {
  if (facets == 0) fail_in_file(name, "the file has no facets");
  if (facets > max_elements / 3) {
    fail_in_file(name, "more than " + std::to_string(max_elements / 3) + " facets: split the mesh");
  }
  Corners corners;
  corners.reserve(3 * facets);
  for (std::size_t facet = 0; facet < facets; ++facet) {
    const char* at = bytes.data() + preamble_size + facet * facet_size + 12;  // behind the normal
    for (int corner = 0; corner < 3; ++corner) {
      Point3& point = corners.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis, at += 4)
        point[axis] = load<float>(at, std::endian::little);
      if (!is_finite(point))
        fail_in_file(name, "facet " + std::to_string(facet) + ": a coordinate is not a finite number");
    }
  }
  return corners;
}

class AsciiParser {
 public:
  AsciiParser(std::string_view text, const std::string& name) : cursor_(text, name) {}

  Corners parse() {
    std::string_view word = cursor_.word_across_lines();
    while (same_word(word, "solid")) {
      read_solid();
      word = cursor_.word_across_lines();
    }
    if (!word.empty())
      cursor_.fail(in_quotes(word) + " found where 'solid' or the end of the file is expected");
    if (corners_.empty()) cursor_.fail_everywhere("the file has no facets");
    return std::move(corners_);
  }

 private:
  void read_solid() {
    cursor_.next_line();  // a name is anything up to there
    for (;;) {
      const std::string_view word = cursor_.word_across_lines();
      if (same_word(word, "endsolid")) break;
      if (!same_word(word, "facet")) fail_at_word(word, "facet or endsolid");
      read_facet();
    }
    cursor_.next_line();
  }

  void read_facet() {
    if (corners_.size() / 3 >= max_elements / 3) cursor_.fail("too many facets: split the mesh");
    expect("normal");
    for (int axis = 0; axis < 3; ++axis) cursor_.word_across_lines();
    expect("outer");
    expect("loop");
    for (int corner = 0; corner < 3; ++corner) {
      expect("vertex");
      Point3 point;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        point[axis] = read_coordinate(cursor_, corners_.size(), cursor_.word_across_lines());
      }
      corners_.push_back(point);
    }
    expect("endloop");
    expect("endfacet");
    ++facet_;
  }

  void expect(const char* keyword) {
    const std::string_view word = cursor_.word_across_lines();
    if (!same_word(word, keyword)) fail_at_word(word, keyword);
  }

  [[noreturn]] void fail_at_word(std::string_view word, const std::string& expected) const {
    const std::string where = "facet " + std::to_string(facet_) + ": ";
    if (word.empty()) cursor_.fail(where + "the file ends before its " + expected + ": it is truncated");
    cursor_.fail(where + in_quotes(word) + " found where " + expected + " is expected");
  }

  TextCursor cursor_;
  Corners corners_;
  std::size_t facet_ = 0;
};

Corners read_corners(std::string_view bytes, const std::string& name) {
  const bool has_count = bytes.size() >= preamble_size;
  const std::uint32_t facets =
      has_count ? load<std::uint32_t>(bytes.data() + stl_header_size, std::endian::little) : 0;
  const std::uint64_t promised = preamble_size + std::uint64_t{facet_size} * facets;
  // Text of this size would have to be gigabytes long.
  if (has_count && bytes.size() == promised) return read_binary(bytes, facets, name);
  if (begins_like_ascii(bytes)) return AsciiParser(plain_text(bytes, name), name).parse();
  refuse_other_formats(bytes, name);
  if (bytes.find('\0') == std::string_view::npos) {
    fail_in_file(name, "this is not an STL file: neither text that begins with 'solid' nor binary");
  }
  if (!has_count) fail_in_file(name, "the file is too short for binary STL: it is truncated");
  fail_in_file(name, "the file declares " + std::to_string(facets) + " facets, which take " +
                         std::to_string(promised) + " bytes, but has " + std::to_string(bytes.size()));
}

/// Of length 1, or zero where the area of the triangle is zero in doubles.
Vector3 unit_normal(const Point3& a, const Point3& b, const Point3& c) {
  // Before the differences: they may overflow.
  const double size = std::max({max_abs(a - Point3{}), max_abs(b - Point3{}), max_abs(c - Point3{})});
  if (size == 0) return {};
  const PowerOfTwo scale = PowerOfTwo::normalising(size);
  const Vector3 u = scale.apply(b) - scale.apply(a), v = scale.apply(c) - scale.apply(a);
  const double largest = std::max(max_abs(u), max_abs(v));
  if (largest == 0) return {};
  const PowerOfTwo zoom = PowerOfTwo::normalising(largest);
  const Vector3 normal = cross(zoom.apply(u), zoom.apply(v));
  const double norm = length(normal);
  return norm > 0 ? (1 / norm) * normal : Vector3{};
}

}  // namespace

ControlMesh parse_stl(std::string_view bytes, const std::string& name) {
  ControlMesh mesh = mesh_of_triangles(read_corners(bytes, name));
  mesh.tags.scheme = Scheme::flat;
  return mesh;
}

std::string format_stl(const ControlMesh& mesh, const std::string& name, const Notes& notes) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(InputProblem::refused, name + ": " + what);
  };
  if (mesh.face_count() > UINT32_MAX) refuse("too many faces for STL");
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const std::size_t corners = mesh.face(FaceId(face)).size();
    if (corners == 3) continue;
    refuse("face " + std::to_string(face) + " has " + std::to_string(corners) +
           " corners: STL holds triangles only; write PLY, OBJ or OFF");
  }
  const auto points = in_single_precision(mesh.points, name, notes);
  std::string bytes = "binary STL written by snug";
  bytes.reserve(preamble_size + facet_size * mesh.face_count());
  bytes.resize(stl_header_size, ' ');
  append_binary(bytes, static_cast<std::uint32_t>(mesh.face_count()));
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const auto corners = mesh.face(FaceId(face));
    const auto point = [&](std::size_t k) { return mesh.points[corners[k].index()]; };
    const Vector3 normal = unit_normal(point(0), point(1), point(2));
    for (std::size_t axis = 0; axis < 3; ++axis) append_binary(bytes, static_cast<float>(normal[axis]));
    for (const VertexId vertex : corners) {
      for (const float x : points[vertex.index()]) append_binary(bytes, x);
    }
    append_binary(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace snug
