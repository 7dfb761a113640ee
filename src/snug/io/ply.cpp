#include <snug/io/ply.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <snug/base/contract.h>
#include <snug/base/error.h>
#include <snug/base/names.h>
#include <snug/io/binary.h>
#include <snug/io/element_text.h>
#include <snug/io/number.h>
#include <snug/io/text_cursor.h>
#include <snug/io/text_kind.h>

namespace snug {
namespace {

constexpr auto ply_format_names =
    std::to_array<Named<PlyFormat>>({{"ascii", PlyFormat::ascii},
                                     {"binary_little_endian", PlyFormat::binary_little_endian},
                                     {"binary_big_endian", PlyFormat::binary_big_endian}});

enum class Scalar : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr auto scalar_names = std::to_array<Named<Scalar>>({{"char", Scalar::int8},
                                                            {"int8", Scalar::int8},
                                                            {"uchar", Scalar::uint8},
                                                            {"uint8", Scalar::uint8},
                                                            {"short", Scalar::int16},
                                                            {"int16", Scalar::int16},
                                                            {"ushort", Scalar::uint16},
                                                            {"uint16", Scalar::uint16},
                                                            {"int", Scalar::int32},
                                                            {"int32", Scalar::int32},
                                                            {"uint", Scalar::uint32},
                                                            {"uint32", Scalar::uint32},
                                                            {"float", Scalar::float32},
                                                            {"float32", Scalar::float32},
                                                            {"double", Scalar::float64},
                                                            {"float64", Scalar::float64}});

std::size_t size_of(Scalar type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

bool is_integer(Scalar type) { return type < Scalar::float32; }

struct IntegerRange {
  std::int64_t least, most;
};

IntegerRange range_of(Scalar type) {
  SNUG_EXPECT(is_integer(type));
  const std::int64_t count = std::int64_t{1} << (8 * size_of(type));
  const bool is_signed = type == Scalar::int8 || type == Scalar::int16 || type == Scalar::int32;
  return is_signed ? IntegerRange{-count / 2, count / 2 - 1} : IntegerRange{0, count - 1};
}

/// What a property is to the mesh.
enum class Role : std::uint8_t { x, y, z, corners, none };

struct Property {
  std::string name;
  Scalar type;
  std::optional<Scalar> count_type;  ///< of a list
  Role role = Role::none;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::size_t line = 0;
  std::vector<Property> properties;
};

struct Header {
  PlyFormat format = PlyFormat::ascii;
  std::vector<Element> elements;
  std::size_t lines = 0;
  std::string_view body;
};

/// The lines of a header: text until a line end, and then perhaps bytes that are no text.
class HeaderLines {
 public:
  HeaderLines(std::string_view bytes, const std::string& name)
      : rest_(bytes),
        name_(name),
        end_(bytes.starts_with("ply\r") && !bytes.starts_with("ply\r\n") ? '\r' : '\n') {}

  TextCursor next() {
    const std::size_t size = rest_.find(end_);
    if (size == std::string_view::npos) {
      throw InputError(InputProblem::unreadable,
                       name_ + ": the header has no line end_header: the file is truncated");
    }
    std::string_view line = rest_.substr(0, size);
    if (line.ends_with('\r')) line.remove_suffix(1);
    rest_.remove_prefix(size + 1);
    TextCursor at(line, name_, ++count_);
    if (line.find('\r') != std::string_view::npos) {
      at.fail("some lines of the header end with CR and some with LF");
    }
    return at;
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  const std::string& name_;
  char end_;
  std::size_t count_ = 0;
};

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& name) : lines_(bytes, name) {}

  Header parse() {
    lines_.next();  // ply
    for (;;) {
      TextCursor at = lines_.next();
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
        header_.lines = lines_.count();
        header_.body = lines_.rest();
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
  void read_format(TextCursor& at) {
    if (has_format_) at.fail("the header names its format twice");
    const std::string_view format = at.word();
    const auto known = value_in(ply_format_names, format);
    if (!known) at.fail(in_quotes(format) + " is not a format: " + listed(all_names(ply_format_names), "or"));
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
    if (header_.elements.size() == most_names) {
      at.fail("the header declares more than " + std::to_string(most_names) + " kinds of elements");
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
    Property property{};
    std::string_view type = at.word();
    if (type == "list") {
      property.count_type = read_type(at, at.word());
      if (!is_integer(*property.count_type)) at.fail("the count of a list must have an integer type");
      type = at.word();
    }
    property.type = read_type(at, type);
    property.name = at.word();
    if (property.name.empty()) at.fail("a property has no name");
    std::vector<Property>& properties = header_.elements.back().properties;
    if (properties.size() == most_names) {
      at.fail("an element has more than " + std::to_string(most_names) + " properties");
    }
    for (const Property& other : properties) {
      if (other.name == property.name) at.fail("property " + in_quotes(property.name) + " is declared twice");
    }
    properties.push_back(std::move(property));
  }

  static Scalar read_type(const TextCursor& at, std::string_view word) {
    const auto type = value_in(scalar_names, word);
    if (!type) at.fail(in_quotes(word) + " is not a PLY type: char to double, or int8 to float64");
    return *type;
  }

  static void assign_roles(const TextCursor& at, Element& element) {
    if (element.properties.empty() && element.count > 0) {
      at.fail_at(element.line, "element " + in_quotes(element.name) + " has no properties");
    }
    std::size_t found = 0;
    if (element.name == "vertex") {
      for (Property& property : element.properties) {
        constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
        const auto axis = std::find(axes.begin(), axes.end(), property.name);
        if (axis == axes.end()) continue;
        if (property.count_type) at.fail_at(element.line, "a coordinate of the vertices is a list");
        property.role = static_cast<Role>(axis - axes.begin());
        ++found;
      }
      if (found < 3) at.fail_at(element.line, "the vertices lack one of the properties x, y and z");
    } else if (element.name == "face") {
      for (Property& property : element.properties) {
        if (property.name != "vertex_index" && property.name != "vertex_indices") continue;
        if (!property.count_type || !is_integer(property.type)) {
          at.fail_at(element.line, "the corners of the faces are not a list of integers");
        }
        property.role = Role::corners;
        ++found;
      }
      if (found == 0) at.fail_at(element.line, "the faces lack a list vertex_indices");
      if (found == 2) at.fail_at(element.line, "the faces have two lists of corners");
    }
  }

  // Of elements, and of the properties of one: all names are compared with one another.
  static constexpr std::size_t most_names = 1000;

  HeaderLines lines_;
  Header header_;
  bool has_format_ = false;
};

/// The values behind a header, element by element.
class Body {
 public:
  Body() = default;
  virtual ~Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  /// How many elements of this sort the rest of the file can hold at most.
  [[nodiscard]] virtual std::uint64_t room_for(const Element& element) const = 0;
  /// The next values belong to this element; messages name it.
  void begin(const Element& element, std::size_t number) {
    element_ = &element;
    number_ = number;
    step_to_element();
  }
  virtual double coordinate(Scalar type) = 0;
  virtual std::int64_t integer(Scalar type) = 0;
  /// Values that are passed over, checked only as far as they must be to find the next.
  virtual void skip(Scalar type, std::uint64_t count) = 0;
  virtual void end() = 0;
  /// Refuses what follows the last element.
  virtual void finish() = 0;
  [[noreturn]] virtual void fail(const std::string& message) const = 0;

 protected:
  virtual void step_to_element() = 0;
  [[nodiscard]] std::size_t number() const { return number_; }
  [[nodiscard]] std::string in_element(const std::string& message) const {
    const std::string quoted = in_quotes(element_->name);
    return quoted.substr(1, quoted.size() - 2) + ' ' + std::to_string(number_) + ": " + message;
  }

 private:
  const Element* element_ = nullptr;
  std::size_t number_ = 0;
};

class AsciiBody final : public Body {
 public:
  AsciiBody(std::string_view text, const std::string& name, std::size_t line) : cursor_(text, name, line) {}

  [[nodiscard]] std::uint64_t room_for(const Element& element) const override {
    return (std::uint64_t{cursor_.bytes_left()} + 1) / (2 * element.properties.size());  // digit and blank
  }
  double coordinate(Scalar) override { return read_coordinate(cursor_, number(), cursor_.word()); }
  std::int64_t integer(Scalar type) override {
    const std::string_view word = next_word();
    const auto value = parse_integer(word);
    if (!value) fail(in_quotes(word) + " is not a whole number");
    const IntegerRange range = range_of(type);
    if (*value < range.least || *value > range.most) {
      fail(in_quotes(word) + " does not fit the type " + name_in(scalar_names, type) +
           " that the header declares");
    }
    return *value;
  }
  void skip(Scalar, std::uint64_t count) override {
    for (; count > 0; --count) next_word();
  }
  void end() override {
    if (const std::string_view extra = cursor_.word(); !extra.empty()) {
      fail(in_quotes(extra) + " follows the values that the header declares");
    }
    cursor_.next_line();
  }
  void finish() override {
    if (const std::string_view extra = cursor_.word_across_lines(); !extra.empty()) {
      cursor_.fail(in_quotes(extra) + " follows the last element: correct the counts of the header");
    }
  }
  [[noreturn]] void fail(const std::string& message) const override { cursor_.fail(in_element(message)); }

 private:
  void step_to_element() override {
    while (!cursor_.more_in_line()) {
      if (!cursor_.next_line()) {
        fail("the file ends before it: it is truncated, or its header declares too much");
      }
    }
  }
  std::string_view next_word() {
    const std::string_view word = cursor_.word();
    if (word.empty()) fail("the line ends before its last value");
    return word;
  }

  TextCursor cursor_;
};

class BinaryBody final : public Body {
 public:
  BinaryBody(std::string_view bytes, const std::string& name, std::endian order)
      : rest_(bytes), name_(name), order_(order) {}

  [[nodiscard]] std::uint64_t room_for(const Element& element) const override {
    std::size_t least = 0;
    for (const Property& property : element.properties)
      least += size_of(property.count_type.value_or(property.type));
    return rest_.size() / least;
  }
  double coordinate(Scalar type) override {
    double value = 0;
    if (is_integer(type)) {
      value = static_cast<double>(integer(type));
    } else {
      const char* const bytes = take(type, 1);
      value = type == Scalar::float32 ? double{load<float>(bytes, order_)} : load<double>(bytes, order_);
    }
    if (!std::isfinite(value)) fail("a coordinate is not a finite number");
    return value;
  }
  std::int64_t integer(Scalar type) override {
    const char* const bytes = take(type, 1);
    switch (type) {
      case Scalar::int8:
        return load<std::int8_t>(bytes, order_);
      case Scalar::uint8:
        return load<std::uint8_t>(bytes, order_);
      case Scalar::int16:
        return load<std::int16_t>(bytes, order_);
      case Scalar::uint16:
        return load<std::uint16_t>(bytes, order_);
      case Scalar::int32:
        return load<std::int32_t>(bytes, order_);
      default:
        SNUG_EXPECT(type == Scalar::uint32);
        return load<std::uint32_t>(bytes, order_);
    }
  }
  void skip(Scalar type, std::uint64_t count) override { take(type, count); }
  void end() override {}
  void finish() override {
    const auto is_blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    if (!std::all_of(rest_.begin(), rest_.end(), is_blank)) {
      throw InputError(InputProblem::unreadable,
                       name_ + ": " + std::to_string(rest_.size()) +
                           " bytes follow the last element: correct the counts of the header");
    }
  }
  [[noreturn]] void fail(const std::string& message) const override {
    throw InputError(InputProblem::unreadable, name_ + ": " + in_element(message));
  }

 private:
  void step_to_element() override {}
  const char* take(Scalar type, std::uint64_t count) {
    if (count > rest_.size() / size_of(type)) {
      fail("the file ends within it: it is truncated, or its header declares too much");
    }
    const char* const taken = rest_.data();
    rest_.remove_prefix(count * size_of(type));
    return taken;
  }

  std::string_view rest_;
  const std::string& name_;
  std::endian order_;
};

class PlyParser {
 public:
  PlyParser(std::string_view bytes, const std::string& name)
      : name_(name), header_(HeaderParser(bytes, name).parse()) {
    if (header_.format == PlyFormat::ascii) {
      body_ = std::make_unique<AsciiBody>(header_.body, name, header_.lines + 1);
    } else {
      const bool little = header_.format == PlyFormat::binary_little_endian;
      body_ =
          std::make_unique<BinaryBody>(header_.body, name, little ? std::endian::little : std::endian::big);
    }
  }

  ControlMesh parse() {
    vertices_ = count_of("vertex");
    const TextCursor whole({}, name_);
    expect_elements(whole, vertices_, count_of("face"));
    for (const Element& element : header_.elements) {
      expect_promise(element);
      if (element.name == "vertex") {
        mesh_.points.reserve(element.count);
        read_all(element, [this](const Element& vertex) { read_vertex(vertex); });
      } else if (element.name == "face") {
        mesh_.face_offsets.reserve(element.count + 1);
        read_all(element, [this](const Element& face) { read_face(face); });
      } else {
        read_all(element, [this](const Element& other) {
          for (const Property& property : other.properties) pass_over(property);
        });
      }
    }
    body_->finish();
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::size_t count_of(std::string_view name) const {
    for (const Element& element : header_.elements) {
      if (element.name == name) return element.count;
    }
    return 0;
  }

  /// Before anything is allocated for them: can the file hold this many, and ids number them?
  void expect_promise(const Element& element) const {
    const TextCursor at({}, name_);
    if (element.count == 0) return;
    if (element.count > body_->room_for(element)) {
      at.fail_at(element.line, "the header declares " + std::to_string(element.count) + " elements " +
                                   in_quotes(element.name) +
                                   ", more than the file can hold: it is truncated, or the count is wrong");
    }
    if (element.count > most_elements) {
      at.fail_at(element.line, "at most " + std::to_string(most_elements) + " elements of one kind are read");
    }
  }

  template <class Read>
  void read_all(const Element& element, const Read& read) {
    for (std::size_t i = 0; i < element.count; ++i) {
      body_->begin(element, i);
      read(element);
      body_->end();
    }
  }

  void read_vertex(const Element& vertex) {
    Point3 point;
    for (const Property& property : vertex.properties) {
      if (property.role == Role::none) {
        pass_over(property);
      } else {
        point[static_cast<std::size_t>(property.role)] = body_->coordinate(property.type);
      }
    }
    mesh_.points.push_back(point);
  }

  void read_face(const Element& face) {
    for (const Property& property : face.properties) {
      if (property.role == Role::corners) {
        read_corners(property);
      } else {
        pass_over(property);
      }
    }
    mesh_.face_offsets.push_back(static_cast<std::uint32_t>(mesh_.face_vertices.size()));
  }

  void read_corners(const Property& property) {
    const std::uint64_t count = list_count(property);
    if (count == 0) body_->fail("0 is not a number of vertices");
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::int64_t index = body_->integer(property.type);
      if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_) {
        body_->fail("index " + std::to_string(index) + " is outside 0 to " + std::to_string(vertices_ - 1));
      }
      if (mesh_.face_vertices.size() >= most_elements) {
        body_->fail("more than " + std::to_string(most_elements) + " face corners: split the mesh");
      }
      mesh_.face_vertices.emplace_back(static_cast<std::size_t>(index));
    }
  }

  void pass_over(const Property& property) {
    body_->skip(property.type, property.count_type ? list_count(property) : 1);
  }

  std::uint64_t list_count(const Property& property) {
    const std::int64_t count = body_->integer(*property.count_type);
    if (count < 0) body_->fail(std::to_string(count) + " is not a number of values");
    return static_cast<std::uint64_t>(count);
  }

  const std::string& name_;
  Header header_;
  std::unique_ptr<Body> body_;
  ControlMesh mesh_;
  std::size_t vertices_ = 0;
};

class PlyWriter {
 public:
  PlyWriter(const ControlMesh& mesh, PlyFormat format) : mesh_(mesh), format_(format) {
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
      most_corners_ = std::max(most_corners_, mesh.face(FaceId(face)).size());
    }
  }

  std::string write() {
    bytes_.reserve(400 + mesh_.vertex_count() * 24 + mesh_.face_count() + mesh_.face_vertices.size() * 4);
    write_header();
    for (const Point3& point : mesh_.points) write_vertex(point);
    for (std::size_t face = 0; face < mesh_.face_count(); ++face) write_face(mesh_.face(FaceId(face)));
    return std::move(bytes_);
  }

 private:
  [[nodiscard]] bool short_counts() const {
    return most_corners_ <= std::numeric_limits<std::uint8_t>::max();
  }

  void write_header() {
    const bool int_holds = mesh_.vertex_count() <= std::size_t{1} << 31;
    bytes_ += "ply\nformat ";
    bytes_ += name_in(ply_format_names, format_);
    bytes_ += " 1.0\nelement vertex ";
    append_integer(bytes_, mesh_.vertex_count());
    bytes_ += "\nproperty double x\nproperty double y\nproperty double z\nelement face ";
    append_integer(bytes_, mesh_.face_count());
    bytes_ += short_counts() ? "\nproperty list uchar " : "\nproperty list uint ";
    bytes_ += int_holds ? "int vertex_indices\nend_header\n" : "uint vertex_indices\nend_header\n";
  }

  void write_vertex(const Point3& point) {
    require_value(is_finite(point), "PLY: a coordinate to write is not finite");
    if (format_ == PlyFormat::ascii) {
      append_point(bytes_, point);
      bytes_ += '\n';
      return;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) append_binary(bytes_, point[axis], order());
  }

  void write_face(std::span<const VertexId> corners) {
    require_value(!corners.empty(), "PLY: a face to write has no corners; take it out");
    if (format_ == PlyFormat::ascii) {
      append_integer(bytes_, corners.size());
      for (const VertexId vertex : corners) {
        bytes_ += ' ';
        append_integer(bytes_, vertex.value());
      }
      bytes_ += '\n';
      return;
    }
    if (short_counts()) {
      append_binary(bytes_, static_cast<std::uint8_t>(corners.size()), order());
    } else {
      append_binary(bytes_, static_cast<std::uint32_t>(corners.size()), order());
    }
    for (const VertexId vertex : corners) append_binary(bytes_, vertex.value(), order());
  }

  [[nodiscard]] std::endian order() const {
    return format_ == PlyFormat::binary_big_endian ? std::endian::big : std::endian::little;
  }

  const ControlMesh& mesh_;
  PlyFormat format_;
  std::size_t most_corners_ = 0;
  std::string bytes_;
};

}  // namespace

bool begins_like_ply(std::string_view bytes) {
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

ControlMesh parse_ply(std::string_view bytes, const std::string& name) {
  if (!begins_like_ply(bytes)) {
    refuse_other_formats(bytes, name);
    throw InputError(InputProblem::unreadable, name + ": the file does not begin with the line 'ply'");
  }
  return PlyParser(bytes, name).parse();
}

std::string format_ply(const ControlMesh& mesh, PlyFormat format) { return PlyWriter(mesh, format).write(); }

}  // namespace snug
