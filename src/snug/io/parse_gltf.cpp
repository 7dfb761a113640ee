#include <snug/io/formats.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <snug/io/other_file.h>
#include <snug/io/placed_meshes.h>
#include <snug/io/transform.h>
#include <snug/mesh/weld.h>
#include <support/binary.h>
#include <support/error.h>
#include <support/number.h>
#include <support/read_file.h>
#include <support/text_cursor.h>
#include <nlohmann/json.hpp>

namespace snug {
namespace {

using Json = nlohmann::json;

/// The member of this name; nothing if there is none, or no object.
const Json* find(const Json& of, std::string_view key) {
  if (!of.is_object()) return nullptr;
  const auto found = of.find(key);
  return found != of.end() ? &*found : nullptr;
}

/// A whole number from 0 to 2^53; nothing else.
std::optional<std::uint64_t> whole_number(const Json& value) {
  if (!value.is_number()) return {};
  const auto number = value.get<double>();
  if (!(number >= 0 && number <= 0x1p53) || number != std::floor(number)) return {};
  return static_cast<std::uint64_t>(number);
}

/// Empty for other values.
std::string_view text(const Json& value) {
  return value.is_string() ? std::string_view(value.get_ref<const std::string&>()) : std::string_view();
}

/// The representation of an accessor's numbers.
struct Component {
  unsigned code;
  std::size_t size;
  double max;  // of an integer: the largest, for normalized ones
  bool is_signed;
};
constexpr std::array<Component, 6> components{{{5120, 1, 127, true},
                                               {5121, 1, 255, false},
                                               {5122, 2, 32767, true},
                                               {5123, 2, 65535, false},
                                               {5125, 4, 4294967295, false},
                                               {5126, 4, 0, true}}};
constexpr unsigned float_code = 5126;

double number_at(const char* at, const Component& component) {
  constexpr std::endian order = std::endian::little;
  switch (component.code) {
    case 5120:
      return load<std::int8_t>(at, order);
    case 5121:
      return load<std::uint8_t>(at, order);
    case 5122:
      return load<std::int16_t>(at, order);
    case 5123:
      return load<std::uint16_t>(at, order);
    case 5125:
      return load<std::uint32_t>(at, order);
    default:
      return double{load<float>(at, order)};
  }
}

/// Elements in the binary chunk, one `stride` after the other.
struct Elements {
  const char* begin = nullptr;  // none: zeros
  std::size_t stride = 0, count = 0, width = 1;
  const Component* component = nullptr;
  bool normalized = false;
  std::map<std::uint64_t, const char*> replaced;  // of sparse ones

  [[nodiscard]] double number(std::size_t element, std::size_t k) const {
    const auto found = replaced.empty() ? replaced.end() : replaced.find(element);
    const char* const base = found != replaced.end() ? found->second
                             : begin                 ? begin + element * stride
                                                     : nullptr;
    if (!base) return 0;
    const double value = number_at(base + k * component->size, *component);
    return normalized ? std::fmax(value / component->max, -1) : value;
  }
};

bool has_no_geometry(std::string_view extension) {
  for (const std::string_view front : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_",
                                       "KHR_lights_", "KHR_mesh_quantization"}) {
    if (extension.starts_with(front)) return true;
  }
  return false;
}

class GltfReader {
 public:
  /// `binary`: the chunk of a binary file, if there is one.
  GltfReader(const Json& json, std::optional<std::string_view> binary, std::size_t file_size,
             const std::string& name, const OtherFiles& files, const Notes& notes)
      : json_(json),
        binary_(binary),
        name_(name),
        files_(files),
        notes_(notes),
        max_work_(100 * file_size),
        buffers_(list(json, "buffers").size()) {}

  PlacedMeshes read() {
    refuse_other_versions();
    visit_nodes();
    write_notes();
    if (placed_.parts.empty()) fail("the file has no triangles in its scene");
    placed_.max_elements = std::min(placed_.max_elements, max_work_);
    return std::move(placed_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { fail_in_file(name_, message); }

  // --- the parts of the JSON text

  [[nodiscard]] const std::vector<Json>& list(const Json& of, std::string_view key) const {
    static const std::vector<Json> none;
    const Json* const found = find(of, key);
    if (!found) return none;
    if (!found->is_array()) fail("glTF: " + in_quotes(key) + " is not a list");
    return found->get_ref<const std::vector<Json>&>();
  }

  const Json& item(std::string_view key, std::uint64_t index) const {
    const std::vector<Json>& all = list(json_, key);
    if (index >= all.size()) {
      fail("glTF: " + in_quotes(key) + " has no number " + std::to_string(index) + ": it counts " +
           std::to_string(all.size()));
    }
    return all[index];
  }

  [[nodiscard]] std::optional<std::uint64_t> integer(const Json& of, std::string_view key) const {
    const Json* const found = find(of, key);
    if (!found) return {};
    const auto value = whole_number(*found);
    if (!value) fail("glTF: " + in_quotes(key) + " is not a whole number >= 0");
    return value;
  }

  [[nodiscard]] std::uint64_t required(const Json& of, std::string_view key, const char* what) const {
    const auto value = integer(of, key);
    if (!value) fail(std::string("glTF: ") + what + " has no " + in_quotes(key));
    return *value;
  }

  void refuse_other_versions() const {
    const Json* const asset = find(json_, "asset");
    const Json* const version = asset ? find(*asset, "version") : nullptr;
    const Json* const least = asset ? find(*asset, "minVersion") : nullptr;
    if (!version || !text(*version).starts_with("2.") || (least && text(*least) != "2.0")) {
      fail("glTF: only version 2.0 is read");
    }
    for (const Json& extension : list(json_, "extensionsRequired")) {
      if (has_no_geometry(text(extension))) continue;
      fail("glTF: the extension " + in_quotes(text(extension)) + " is needed: write the file without it");
    }
  }

  /// Whatever instances and shared accessors promise, work is bounded by the size of the file.
  void spend(std::size_t work) {
    if (work > max_work_ - spent_) {
      fail("glTF: instances or shared values make more than 100 times the file: write fewer of them");
    }
    spent_ += work;
  }

  // --- buffers

  /// A buffer, read when it is first asked for.
  std::string_view bytes_of(std::uint64_t number) {
    const Json& own = item("buffers", number);
    const std::uint64_t size = required(own, "byteLength", "a buffer");
    const std::string what = "glTF: buffer " + std::to_string(number);
    const Json* const uri = find(own, "uri");
    std::string_view bytes;
    if (!uri && number == 0 && binary_) {
      bytes = *binary_;
    } else if (!uri) {
      fail(what + " has no 'uri', and no bytes in the file");
    } else {
      std::optional<std::string>& kept = buffers_[number];
      if (!kept) kept = read_buffer(text(*uri), what);
      bytes = *kept;
    }
    return bytes.substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(size, bytes.size())));
  }

  std::string read_buffer(std::string_view uri, const std::string& what) {
    if (uri.starts_with("data:")) return data_of_uri(uri, name_, what);
    const std::string path = path_inside(uri, name_, what);
    if (!files_) {
      fail(what + " is in the file " + in_quotes(path) +
           ", which is not at hand: give the path of the file, or write one .glb file with all in it");
    }
    std::string bytes;
    try {
      bytes = files_(path);
    } catch (const InputError& error) {
      throw InputError(error.problem(), name_ + ": " + what + ": " + error.what());
    }
    max_work_ += 100 * bytes.size();
    return bytes;
  }

  // --- accessors

  /// `size` bytes at an offset of a buffer view; its stride too.
  std::pair<std::string_view, std::size_t> view(std::uint64_t number) {
    const Json& view = item("bufferViews", number);
    const std::uint64_t buffer = required(view, "buffer", "a buffer view"),
                        begin = integer(view, "byteOffset").value_or(0),
                        size = required(view, "byteLength", "a buffer view"),
                        stride = integer(view, "byteStride").value_or(0);
    const std::string_view bytes = bytes_of(buffer);
    const std::size_t whole = bytes.size();
    if (begin > whole || size > whole - begin) {
      fail("glTF: buffer view " + std::to_string(number) + " ends beyond its buffer: the file is truncated");
    }
    if (stride > 252) fail("glTF: byteStride " + std::to_string(stride) + " is more than 252");
    return {bytes.substr(begin, size), stride};
  }

  [[nodiscard]] const Component& component_of(const Json& of) const {
    const std::uint64_t code = required(of, "componentType", "an accessor");
    const auto found = std::ranges::find(components, code, &Component::code);
    if (found == components.end()) fail("glTF: " + std::to_string(code) + " is not a componentType");
    return *found;
  }

  /// `count` elements of a view at an offset; which must be there.
  const char* elements_in(const Json& of, std::size_t count, std::size_t element_size, std::size_t* stride) {
    const auto [bytes, own_stride] = view(required(of, "bufferView", "an accessor"));
    const std::uint64_t begin = integer(of, "byteOffset").value_or(0);
    const std::size_t step = stride && own_stride ? own_stride : element_size;
    if (stride) *stride = step;
    const bool fits = count == 0 || (begin <= bytes.size() && element_size <= bytes.size() - begin &&
                                     count - 1 <= (bytes.size() - begin - element_size) / step);
    if (!fits)
      fail("glTF: an accessor of " + std::to_string(count) + " elements ends beyond its buffer view");
    return bytes.data() + begin;
  }

  Elements accessor(std::uint64_t number, const char* type, std::size_t width) {
    const Json& own = item("accessors", number);
    const std::string what = "glTF: accessor " + std::to_string(number);
    const Json* const given = find(own, "type");
    if (!given || text(*given) != type) fail(what + " is not of the type " + type);
    Elements elements;
    elements.component = &component_of(own);
    elements.width = width;
    const Json* const normalized = find(own, "normalized");
    elements.normalized = normalized && *normalized == true && elements.component->code != float_code;
    const std::uint64_t count = required(own, "count", "an accessor");
    if (const auto number_of_view = integer(own, "bufferView")) static_cast<void>(view(*number_of_view));
    if (count > max_work_) fail(what + " counts more than the file can hold");
    elements.count = count;
    if (find(own, "bufferView")) {
      elements.begin = elements_in(own, count, width * elements.component->size, &elements.stride);
    }
    if (const Json* const sparse = find(own, "sparse")) replace(elements, *sparse, what);
    return elements;
  }

  void replace(Elements& elements, const Json& sparse, const std::string& what) {
    const std::uint64_t count = required(sparse, "count", "a sparse accessor");
    const Json *const indices = find(sparse, "indices"), *const values = find(sparse, "values");
    if (!indices || !values) fail(what + ": sparse values need 'indices' and 'values'");
    if (count > elements.count) fail(what + ": more sparse values than elements");
    spend(count);
    const Component& component = component_of(*indices);
    if (component.is_signed) fail(what + ": sparse indices are not whole numbers from 0");
    const std::size_t size = elements.width * elements.component->size;
    const char* const places = elements_in(*indices, count, component.size, nullptr);
    const char* const news = elements_in(*values, count, size, nullptr);
    for (std::size_t i = 0; i < count; ++i) {
      const auto place = static_cast<std::uint64_t>(number_at(places + i * component.size, component));
      if (place >= elements.count)
        fail(what + ": sparse index " + std::to_string(place) + " is out of range");
      elements.replaced[place] = news + i * size;
    }
  }

  // --- nodes

  [[nodiscard]] std::vector<std::uint64_t> roots() const {
    const std::vector<Json>& scenes = list(json_, "scenes");
    std::vector<std::uint64_t> result;
    if (!scenes.empty()) {
      const Json& scene = item("scenes", integer(json_, "scene").value_or(0));
      for (const Json& node : list(scene, "nodes")) result.push_back(whole_number(node).value_or(UINT64_MAX));
      return result;
    }
    // Without scenes: nodes that are nobody's children.
    const std::vector<Json>& nodes = list(json_, "nodes");
    std::vector<bool> is_child(nodes.size(), false);
    for (const Json& node : nodes) {
      for (const Json& child : list(node, "children")) {
        const std::uint64_t index = whole_number(child).value_or(UINT64_MAX);
        if (index < nodes.size()) is_child[index] = true;
      }
    }
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (!is_child[n]) result.push_back(n);
    }
    return result;
  }

  /// Parents before children, in the order of the file.
  void visit_nodes() {
    struct Open {
      std::uint64_t node;
      AffineEnclosure above;
    };
    std::vector<bool> met(list(json_, "nodes").size(), false);
    std::vector<Open> open;
    const auto push = [&](const std::vector<std::uint64_t>& nodes, const AffineEnclosure& above) {
      for (std::size_t i = nodes.size(); i-- > 0;) open.push_back({nodes[i], above});
    };
    push(roots(), {});
    while (!open.empty()) {
      const Open next = open.back();
      open.pop_back();
      const Json& node = item("nodes", next.node);
      if (met[next.node])
        fail("glTF: node " + std::to_string(next.node) + " is met twice: nodes must form trees");
      met[next.node] = true;
      const AffineEnclosure map = next.above.after(own_map(node, next.node));
      if (!map.is_finite())
        fail("glTF: node " + std::to_string(next.node) + " is beyond the range of doubles");
      if (const Json* const extensions = find(node, "extensions");
          extensions && find(*extensions, "EXT_mesh_gpu_instancing")) {
        fail("glTF: node " + std::to_string(next.node) +
             " has instances by EXT_mesh_gpu_instancing: write them as nodes");
      }
      if (const auto mesh = integer(node, "mesh")) add_part(*mesh, map, next.node);
      deforms_ = deforms_ || find(node, "skin") || find(node, "weights");
      std::vector<std::uint64_t> children;
      for (const Json& child : list(node, "children"))
        children.push_back(whole_number(child).value_or(UINT64_MAX));
      push(children, map);
    }
  }

  [[nodiscard]] std::vector<double> numbers(const Json& list_of, const std::string& what) const {
    if (!list_of.is_array()) fail(what + " is not a list");
    std::vector<double> result;
    for (const Json& each : list_of) {
      if (!each.is_number()) fail(what + " contains something that is not a number");
      result.push_back(each.get<double>());
    }
    return result;
  }

  [[nodiscard]] AffineEnclosure own_map(const Json& node, std::uint64_t number) const {
    AffineEnclosure map;
    struct Key {
      const char *key, *kind;
    };
    // Scaled first, moved last; a matrix excludes the others.
    for (const auto& [key, kind] : {Key{"matrix", "transform"},
                                    {"translation", "translate"},
                                    {"rotation", "orient"},
                                    {"scale", "scale"}}) {
      const Json* const found = find(node, key);
      if (!found) continue;
      const std::string what = "glTF: " + in_quotes(key) + " of node " + std::to_string(number);
      std::vector<double> values = numbers(*found, what);
      if (key == std::string_view("rotation") && values.size() == 4) {
        std::rotate(values.begin(), values.begin() + 3, values.end());  // x y z w here
      }
      const TransformOperation operation = transform_operation(kind, values);
      if (!operation.fault.empty()) fail(what + ' ' + operation.fault);
      map = map.after(operation.map);
    }
    return map;
  }

  // --- triangles

  /// Each mesh is welded by itself: other parts may touch it.
  void add_part(std::uint64_t number, const AffineEnclosure& map, std::uint64_t node) {
    const Json& mesh = item("meshes", number);
    auto known = meshes_.find(number);
    if (known == meshes_.end()) {
      std::vector<Point3> corners;
      for (const Json& primitive : list(mesh, "primitives")) add_primitive(primitive, node, corners);
      std::optional<std::size_t> place;
      if (!corners.empty()) {
        place = placed_.meshes.size();
        placed_.meshes.push_back(mesh_of_triangles(corners));
        placed_.meshes.back().tags.scheme = Scheme::flat;
        placed_.meshes.back().metres_per_unit = 1;
      }
      known = meshes_.emplace(number, place).first;
    }
    if (!known->second) return;
    spend(placed_.meshes[*known->second].face_vertices.size());
    const auto name_of = [](const Json& of) {
      const Json* const name = find(of, "name");
      return name ? std::string(text(*name)) : std::string();
    };
    std::string name = name_of(item("nodes", node));
    if (name.empty()) name = name_of(mesh);
    placed_.parts.push_back({std::move(name), "glTF: node " + std::to_string(node), *known->second, map});
  }

  void add_primitive(const Json& primitive, std::uint64_t node, std::vector<Point3>& corners) {
    const std::uint64_t mode = integer(primitive, "mode").value_or(4);
    const Json* const attributes = find(primitive, "attributes");
    const auto positions = attributes ? integer(*attributes, "POSITION") : std::nullopt;
    deforms_ = deforms_ || find(primitive, "targets");
    if (mode > 6) fail("glTF: " + std::to_string(mode) + " is not a mode of primitives");
    if (mode < 4 || !positions) {
      ++no_triangles_;
      return;
    }
    const Elements points = accessor(*positions, "VEC3", 3);
    const auto index_number = integer(primitive, "indices");
    std::optional<Elements> indices;
    if (index_number) {
      indices = accessor(*index_number, "SCALAR", 1);
      if (indices->component->is_signed || indices->normalized) {
        fail("glTF: accessor " + std::to_string(*index_number) + ": indices are not whole numbers from 0");
      }
    }
    const std::size_t count = indices ? indices->count : points.count;
    const auto point = [&](std::size_t i) {
      std::size_t element = i;
      if (indices) element = static_cast<std::size_t>(indices->number(i, 0));
      if (element >= points.count) {
        fail("glTF: node " + std::to_string(node) + ": index " + std::to_string(element) + " names none of " +
             std::to_string(points.count) + " vertices");
      }
      const Point3 p{points.number(element, 0), points.number(element, 1), points.number(element, 2)};
      if (!is_finite(p)) {
        fail("glTF: vertex " + std::to_string(element) + " of accessor " + std::to_string(*positions) +
             ": a coordinate is not a finite number");
      }
      return p;
    };
    if (mode == 4 && count % 3 != 0)
      fail("glTF: " + std::to_string(count) + " corners are not a multiple of 3");
    const std::size_t triangles = mode == 4 ? count / 3 : count - std::min<std::size_t>(count, 2);
    spend(3 * triangles);
    if (corners.size() + 3 * triangles > max_elements) {
      fail("more than " + std::to_string(max_elements) + " corners: split the mesh");
    }
    for (std::size_t t = 0; t < triangles; ++t) {
      const std::array<std::size_t, 3> at = mode == 4   ? std::array{3 * t, 3 * t + 1, 3 * t + 2}
                                            : mode == 5 ? std::array{t, t + 1 + t % 2, t + 2 - t % 2}
                                                        : std::array{t + 1, t + 2, std::size_t{0}};
      const std::array<Point3, 3> triangle{point(at[0]), point(at[1]), point(at[2])};
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
        ++degenerate_;
      } else {
        corners.insert(corners.end(), triangle.begin(), triangle.end());
      }
    }
  }

  void write_notes() const {
    if (!notes_) return;
    const auto note = [&](const std::string& text) { notes_(name_ + ": " + text); };
    if (no_triangles_ > 0)
      note(std::to_string(no_triangles_) + " primitives are left out: they contain no triangles");
    if (degenerate_ > 0) {
      note(std::to_string(degenerate_) +
           " triangles with two corners in one place are left out: faces are numbered "
           "without them");
    }
    if (deforms_) note("skins and morph targets are not applied");
  }

  const Json& json_;
  std::optional<std::string_view> binary_;
  const std::string& name_;
  const OtherFiles& files_;
  const Notes& notes_;
  std::size_t max_work_, spent_ = 0;
  std::vector<std::optional<std::string>> buffers_;  // of those in other files or data URIs
  PlacedMeshes placed_;
  std::map<std::uint64_t, std::optional<std::size_t>>
      meshes_;  // by their numbers in the file; empty without triangles
  std::size_t no_triangles_ = 0, degenerate_ = 0;
  bool deforms_ = false;
};

/// The chunk at an offset, which moves behind it.
std::string_view take_chunk(std::string_view bytes, std::size_t& at, std::string_view type,
                            const std::string& name) {
  if (bytes.size() - at < glb_chunk_head_size)
    fail_in_file(name, "glTF: the file ends within a chunk: it is truncated");
  const std::size_t size = load<std::uint32_t>(bytes.data() + at, std::endian::little);
  if (bytes.substr(at + 4, 4) != type) {
    fail_in_file(name, "glTF: " + in_quotes(bytes.substr(at + 4, 4)) + " found where the chunk " +
                           in_quotes(type) + " is expected");
  }
  at += glb_chunk_head_size;
  if (size > bytes.size() - at) fail_in_file(name, "glTF: a chunk ends beyond the file: it is truncated");
  const std::string_view chunk = bytes.substr(at, size);
  at += size;
  return chunk;
}

/// Numbers become the nearest doubles; of members of one name the last counts.
Json parse_json(std::string_view text, const std::string& name) {
  // The parser takes a zero for the end of the text.
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
    fail_in_file(name, "glTF: byte " + std::to_string(zero) + " of the JSON text is zero");
  }
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error ...; last read: ..."
    std::string_view what = error.what();
    what.remove_prefix(std::min(what.find("] ") + 2, what.size()));
    constexpr std::size_t longest = 160;
    fail_in_file(name,
                 "glTF: JSON: " + std::string(what.substr(0, std::min(what.find("; last read"), longest))));
  }
}

}  // namespace

bool begins_like_gltf(std::string_view bytes) {
  if (bytes.starts_with("glTF")) return true;
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && bytes[first] == '{';
}

PlacedMeshes read_gltf(std::string_view bytes, const std::string& name, const OtherFiles& files,
                       const Notes& notes) {
  using namespace std::string_view_literals;
  if (!begins_like_gltf(bytes)) {
    refuse_other_formats(bytes, name);
    fail_in_file(name, "this is not a glTF file: it begins neither with 'glTF' nor with '{'");
  }
  if (!bytes.starts_with("glTF")) {
    const Json json = parse_json(plain_text(bytes, name), name);
    return GltfReader(json, {}, bytes.size(), name, files, notes).read();
  }
  if (bytes.size() < glb_header_size)
    fail_in_file(name, "glTF: the file ends within its header: it is truncated");
  const auto version = load<std::uint32_t>(bytes.data() + 4, std::endian::little),
             length = load<std::uint32_t>(bytes.data() + 8, std::endian::little);
  if (version != 2)
    fail_in_file(name, "glTF: version " + std::to_string(version) + " is not read: write version 2");
  if (length != bytes.size()) {
    fail_in_file(name, "glTF: the file declares " + std::to_string(length) + " bytes, but has " +
                           std::to_string(bytes.size()));
  }
  std::size_t at = glb_header_size;
  const Json json = parse_json(take_chunk(bytes, at, "JSON"sv, name), name);
  const std::string_view binary =
      at < bytes.size() ? take_chunk(bytes, at, "BIN\0"sv, name) : std::string_view();
  return GltfReader(json, binary, bytes.size(), name, files, notes).read();
}

ControlMesh parse_gltf(std::string_view bytes, const std::string& name, const OtherFiles& files,
                       const Notes& notes) {
  return joined(read_gltf(bytes, name, files, notes), name, notes);
}

}  // namespace snug
