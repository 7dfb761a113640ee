#include <snug/io/formats.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include <support/binary.h>
#include <support/error.h>
#include <support/names.h>
#include <support/number.h>
#include <support/read_file.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

enum class Format : std::uint8_t { ascii, little_endian, big_endian };

constexpr auto format_names = std::to_array<Named<Format>>({{"ascii", Format::ascii},
                                                            {"binary_little_endian", Format::little_endian},
                                                            {"binary_big_endian", Format::big_endian}});

/// A type of numbers; those of integers have a range.
struct Scalar {
  const char *name, *new_name;
  std::size_t size;
  std::int64_t least = 0, most = 0;

  [[nodiscard]] bool is_integer() const { return most > 0; }
};

constexpr std::array<Scalar, 8> scalars{{{"char", "int8", 1, INT8_MIN, INT8_MAX},
                                         {"uchar", "uint8", 1, 0, UINT8_MAX},
                                         {"short", "int16", 2, INT16_MIN, INT16_MAX},
                                         {"ushort", "uint16", 2, 0, UINT16_MAX},
                                         {"int", "int32", 4, INT32_MIN, INT32_MAX},
                                         {"uint", "uint32", 4, 0, UINT32_MAX},
                                         {"float", "float32", 4},
                                         {"double", "float64", 8}}};

/// Role of a property in the mesh.
enum class Role : std::uint8_t { x, y, z, corners, none };

constexpr auto vertex_roles = std::to_array<Named<Role>>({{"x", Role::x}, {"y", Role::y}, {"z", Role::z}});
constexpr auto face_roles =
    std::to_array<Named<Role>>({{"vertex_index", Role::corners}, {"vertex_indices", Role::corners}});

struct Property {
  std::string name;
  const Scalar* type = nullptr;
  const Scalar* count_type = nullptr;  ///< of a list
  Role role = Role::none;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::size_t line = 0;
  std::vector<Property> properties;
};

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
  std::size_t lines = 0;
  std::string_view body;
};

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& name)
      : name_(name), line_end_(bytes.starts_with("ply\r") && !bytes.starts_with("ply\r\n") ? '\r' : '\n') {
    header_.body = bytes;
  }

  Header parse() {
    next_line();  // ply
    for (;;) {
      TextCursor at = next_line();
      const std::string_view keyword = at.word();
      if (keyword == "comment" || keyword == "obj_info") continue;
      if (keyword == "format") {
        read_format(at);
      } else if (!has_format_) {
        at.fail("the header says " + in_quotes(keyword) + " instead of its format");
      } else if (keyword == "element") {
        read_element(at);
      } else if (keyword == "property") {
        read_property(at);
      } else if (keyword == "end_header") {
        for (Element& element : header_.elements) assign_roles(at, element);
        return std::move(header_);
      } else {
        at.fail(in_quotes(keyword) + " is not a statement of a PLY header");
      }
      if (const std::string_view extra = at.word(); !extra.empty()) {
        at.fail(in_quotes(extra) + " follows a header line that is complete");
      }
    }
  }

 private:
  /// The lines of a header are text until a line end; then there may be bytes that are no text.
  TextCursor next_line() {
    const std::size_t size = header_.body.find(line_end_);
    if (size == std::string_view::npos) {
      fail_in_file(name_, "the header has no line end_header: the file is truncated");
    }
    std::string_view line = header_.body.substr(0, size);
    if (line.ends_with('\r')) line.remove_suffix(1);
    header_.body.remove_prefix(size + 1);
    TextCursor at(line, name_, ++header_.lines);
    if (line.find('\r') != std::string_view::npos) {
      at.fail("some lines of the header end with CR and some with LF");
    }
    return at;
  }

  void read_format(TextCursor& at) {
    if (has_format_) at.fail("the header names its format twice");
    const std::string_view format = at.word();
    const auto known = value_in(format_names, format);
    if (!known) at.fail(in_quotes(format) + " is not a format: " + listed(all_names(format_names), "or"));
    header_.format = *known;
    const std::string_view version = at.word();
    if (version != "1.0") at.fail("the version is " + in_quotes(version) + ": only 1.0 is supported");
    has_format_ = true;
  }

  void read_element(TextCursor& at) {
    Element element;
    element.name = at.word();
    element.line = at.line();
    if (element.name.empty()) at.fail("an element has no name");
    if (header_.elements.size() == max_names) {
      at.fail("the header declares more than " + std::to_string(max_names) + " kinds of elements");
    }
    for (const Element& other : header_.elements) {
      if (other.name == element.name) at.fail("element " + in_quotes(element.name) + " is declared twice");
    }
    const std::string_view word = at.word();
    const auto count = parse_integer(word);
    if (!count || *count < 0) {
      at.fail("the header says " + in_quotes(word) + " instead of a number of elements " +
              in_quotes(element.name));
    }
    element.count = static_cast<std::uint64_t>(*count);
    if (element.name == "tristrips" && element.count > 0) {
      at.fail("the file contains triangle strips: convert them to faces");
    }
    header_.elements.push_back(std::move(element));
  }

  void read_property(TextCursor& at) {
    if (header_.elements.empty()) at.fail("a property comes before the first element");
    Property property;
    std::string_view type = at.word();
    if (type == "list") {
      property.count_type = read_type(at, at.word());
      if (!property.count_type->is_integer()) at.fail("the count of a list must have an integer type");
      type = at.word();
    }
    property.type = read_type(at, type);
    property.name = at.word();
    if (property.name.empty()) at.fail("a property has no name");
    std::vector<Property>& properties = header_.elements.back().properties;
    if (properties.size() == max_names) {
      at.fail("an element has more than " + std::to_string(max_names) + " properties");
    }
    for (const Property& other : properties) {
      if (other.name == property.name) at.fail("property " + in_quotes(property.name) + " is declared twice");
    }
    properties.push_back(std::move(property));
  }

  static const Scalar* read_type(const TextCursor& at, std::string_view word) {
    const auto type = std::find_if(scalars.begin(), scalars.end(), [&](const Scalar& scalar) {
      return word == scalar.name || word == scalar.new_name;
    });
    if (type == scalars.end()) {
      at.fail(in_quotes(word) + " is not a PLY type: char to double, or int8 to float64");
    }
    return &*type;
  }

  static void assign_roles(const TextCursor& at, Element& element) {
    if (element.properties.empty() && element.count > 0) {
      at.fail_at(element.line, "element " + in_quotes(element.name) + " has no properties");
    }
    std::size_t found = 0;
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    for (Property& property : element.properties) {
      if (is_vertex) property.role = value_in(vertex_roles, property.name).value_or(Role::none);
      if (is_face) property.role = value_in(face_roles, property.name).value_or(Role::none);
      if (property.role == Role::none) continue;
      if (is_vertex && property.count_type) {
        at.fail_at(element.line, "a coordinate of the vertices is a list");
      }
      if (is_face && !(property.count_type && property.type->is_integer())) {
        at.fail_at(element.line, "the corners of the faces are not a list of integers");
      }
      ++found;
    }
    if (is_vertex && found < 3)
      at.fail_at(element.line, "the vertices lack one of the properties x, y and z");
    if (is_face && found == 0) at.fail_at(element.line, "the faces lack a list vertex_indices");
    if (is_face && found == 2) at.fail_at(element.line, "the faces have two lists of corners");
  }

  // Of elements, and of the properties of one: all names are compared with one another.
  static constexpr std::size_t max_names = 1000;

  const std::string& name_;
  char line_end_;
  Header header_;  // its body begins with the next line
  bool has_format_ = false;
};

/// The element that is being read.
struct ElementPlace {
  const Element* element = nullptr;
  std::size_t number = 0;

  [[nodiscard]] std::string in_element(const std::string& message) const {
    const std::string quoted = in_quotes(element->name);
    return quoted.substr(1, quoted.size() - 2) + ' ' + std::to_string(number) + ": " + message;
  }
};

/// The values behind the header of a text, an element a line.
class AsciiBody {
 public:
  AsciiBody(const Header& header, const std::string& name) : cursor_(header.body, name, header.lines + 1) {}

  /// How many elements of this sort the rest of the file can hold at most.
  [[nodiscard]] std::uint64_t room_for(const Element& element) const {
    return (std::uint64_t{cursor_.bytes_left()} + 1) / (2 * element.properties.size());  // digit and blank
  }
  /// The next values belong to this element.
  void begin(const ElementPlace& place) {
    place_ = place;
    while (!cursor_.more_in_line()) {
      if (!cursor_.next_line()) {
        fail("the file ends before it: it is truncated, or its header declares too much");
      }
    }
  }
  double coordinate(const Scalar&) { return read_coordinate(cursor_, place_.number, cursor_.word()); }
  std::int64_t integer(const Scalar& type) {
    const std::string_view word = next_word();
    const auto value = parse_integer(word);
    if (!value) fail(in_quotes(word) + " is not a whole number");
    if (*value < type.least || *value > type.most) {
      fail(in_quotes(word) + " does not fit the type " + type.name + " that the header declares");
    }
    return *value;
  }
  /// Values that are passed over are checked only as far as they must be to find the next.
  void skip(const Scalar&, std::uint64_t count) {
    for (; count > 0; --count) next_word();
  }
  void end() {
    if (const std::string_view extra = cursor_.word(); !extra.empty()) {
      fail(in_quotes(extra) + " follows the values that the header declares");
    }
    cursor_.next_line();
  }
  /// Refuses what follows the last element.
  void finish() {
    if (const std::string_view extra = cursor_.word_across_lines(); !extra.empty()) {
      cursor_.fail(in_quotes(extra) + " follows the last element: correct the counts of the header");
    }
  }
  [[noreturn]] void fail(const std::string& message) const { cursor_.fail(place_.in_element(message)); }

 private:
  std::string_view next_word() {
    const std::string_view word = cursor_.word();
    if (word.empty()) fail("the line ends before its last value");
    return word;
  }

  TextCursor cursor_;
  ElementPlace place_;
};

/// The same of a binary file.
class BinaryBody {
 public:
  BinaryBody(const Header& header, const std::string& name)
      : rest_(header.body),
        name_(name),
        order_(header.format == Format::little_endian ? std::endian::little : std::endian::big) {}

  [[nodiscard]] std::uint64_t room_for(const Element& element) const {
    std::size_t least = 0;
    for (const Property& property : element.properties) {
      least += (property.count_type ? property.count_type : property.type)->size;
    }
    return rest_.size() / least;
  }
  void begin(const ElementPlace& place) { place_ = place; }
  double coordinate(const Scalar& type) {
    double value = 0;
    if (type.is_integer()) {
      value = static_cast<double>(integer(type));
    } else {
      const char* const bytes = take(type, 1);
      value = type.size == sizeof(float) ? double{load<float>(bytes, order_)} : load<double>(bytes, order_);
    }
    if (!std::isfinite(value)) fail("a coordinate is not a finite number");
    return value;
  }
  std::int64_t integer(const Scalar& type) {
    const char* const bytes = take(type, 1);
    std::int64_t value = 0;
    for (std::size_t i = 0; i < type.size; ++i) {
      const char byte = bytes[order_ == std::endian::big ? i : type.size - 1 - i];
      value = value << 8 | static_cast<unsigned char>(byte);
    }
    return value > type.most ? value - (type.most - type.least + 1) : value;
  }
  void skip(const Scalar& type, std::uint64_t count) { take(type, count); }
  void end() {}
  void finish() {
    const auto is_blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    if (!std::all_of(rest_.begin(), rest_.end(), is_blank)) {
      fail_in_file(name_, std::to_string(rest_.size()) +
                              " bytes follow the last element: correct the counts of the header");
    }
  }
  [[noreturn]] void fail(const std::string& message) const {
    fail_in_file(name_, place_.in_element(message));
  }

 private:
  const char* take(const Scalar& type, std::uint64_t count) {
    if (count > rest_.size() / type.size) {
      fail("the file ends within it: it is truncated, or its header declares too much");
    }
    const char* const taken = rest_.data();
    rest_.remove_prefix(count * type.size);
    return taken;
  }

  std::string_view rest_;
  const std::string& name_;
  std::endian order_;
  ElementPlace place_;
};

/// Reads the elements that a header declares.
template <class Body>
class MeshReader {
 public:
  MeshReader(const Header& header, const std::string& name)
      : header_(header), at_(std::string_view(), name), body_(header, name) {}

  ControlMesh read() {
    vertices_ = count_of("vertex");
    expect_elements(at_, vertices_, count_of("face"));
    for (const Element& element : header_.elements) {
      expect_promise(element);
      const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
      if (is_vertex) mesh_.points.reserve(element.count);
      if (is_face) mesh_.face_offsets.reserve(element.count + 1);
      for (std::size_t i = 0; i < element.count; ++i) {
        body_.begin({&element, i});
        const Point3 point = read_properties(element);
        if (is_vertex) mesh_.points.push_back(point);
        if (is_face) mesh_.face_offsets.push_back(static_cast<std::uint32_t>(mesh_.face_vertices.size()));
        body_.end();
      }
    }
    body_.finish();
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::size_t count_of(std::string_view name) const {
    const auto found = std::ranges::find(header_.elements, name, &Element::name);
    return found == header_.elements.end() ? 0 : found->count;
  }

  /// Before anything is allocated for them: can the file hold this many, and ids number them?
  void expect_promise(const Element& element) const {
    if (element.count == 0) return;
    if (element.count > body_.room_for(element)) {
      at_.fail_at(element.line, "the header declares " + std::to_string(element.count) + " elements " +
                                    in_quotes(element.name) +
                                    ", more than the file can hold: it is truncated, or the count is wrong");
    }
    if (element.count > max_elements) {
      at_.fail_at(element.line, "at most " + std::to_string(max_elements) + " elements of one kind are read");
    }
  }

  /// The coordinates among them, too.
  Point3 read_properties(const Element& element) {
    Point3 point;
    for (const Property& property : element.properties) {
      if (property.role == Role::none) {
        body_.skip(*property.type, property.count_type ? list_count(property) : 1);
      } else if (property.role == Role::corners) {
        read_corners(property);
      } else {
        point[static_cast<std::size_t>(property.role)] = body_.coordinate(*property.type);
      }
    }
    return point;
  }

  void read_corners(const Property& property) {
    const std::uint64_t count = list_count(property);
    if (count == 0) body_.fail("0 is not a number of vertices");
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::int64_t index = body_.integer(*property.type);
      if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_) {
        body_.fail("index " + std::to_string(index) + " is outside 0 to " + std::to_string(vertices_ - 1));
      }
      if (mesh_.face_vertices.size() >= max_elements) {
        body_.fail("more than " + std::to_string(max_elements) + " face corners: split the mesh");
      }
      mesh_.face_vertices.emplace_back(static_cast<std::size_t>(index));
    }
  }

  std::uint64_t list_count(const Property& property) {
    const std::int64_t count = body_.integer(*property.count_type);
    if (count < 0) body_.fail(std::to_string(count) + " is not a number of values");
    return static_cast<std::uint64_t>(count);
  }

  const Header& header_;
  TextCursor at_;  // for messages
  Body body_;
  ControlMesh mesh_;
  std::size_t vertices_ = 0;
};

}  // namespace

bool begins_like_ply(std::string_view bytes) {
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

ControlMesh parse_ply(std::string_view bytes, const std::string& name) {
  if (!begins_like_ply(bytes)) {
    refuse_other_formats(bytes, name);
    fail_in_file(name, "the file does not begin with the line 'ply'");
  }
  const Header header = HeaderParser(bytes, name).parse();
  if (header.format == Format::ascii) return MeshReader<AsciiBody>(header, name).read();
  return MeshReader<BinaryBody>(header, name).read();
}

std::string format_ply(const ControlMesh& mesh) {
  std::size_t max_corners = 0;
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    max_corners = std::max(max_corners, mesh.face(FaceId(face)).size());
  }
  const bool short_counts = max_corners <= UINT8_MAX, int_holds = mesh.vertex_count() <= std::size_t{1} << 31;
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  bytes.reserve(400 + mesh.vertex_count() * 24 + mesh.face_count() + mesh.face_vertices.size() * 4);
  append_integer(bytes, mesh.vertex_count());
  bytes += "\nproperty double x\nproperty double y\nproperty double z\nelement face ";
  append_integer(bytes, mesh.face_count());
  bytes += short_counts ? "\nproperty list uchar " : "\nproperty list uint ";
  bytes += int_holds ? "int vertex_indices\nend_header\n" : "uint vertex_indices\nend_header\n";
  for (const Point3& point : mesh.points) {
    require_value(is_finite(point), "PLY: a coordinate to write is not finite");
    for (std::size_t axis = 0; axis < 3; ++axis) append_binary(bytes, point[axis]);
  }
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const auto corners = mesh.face(FaceId(face));
    require_value(!corners.empty(), "PLY: a face to write has no corners; take it out");
    if (short_counts) {
      append_binary(bytes, static_cast<std::uint8_t>(corners.size()));
    } else {
      append_binary(bytes, static_cast<std::uint32_t>(corners.size()));
    }
    for (const VertexId vertex : corners) append_binary(bytes, vertex.value());
  }
  return bytes;
}

}  // namespace snug
