#include <snug/io/formats.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <snug/io/utf8.h>
#include <snug/io/xml.h>
#include <snug/io/zip.h>
#include <support/error.h>
#include <support/names.h>
#include <support/number.h>
#include <support/read_file.h>
#include <support/system_files.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

constexpr std::string_view core_namespace = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";

// Extensions under which the meshes are the shape.
constexpr std::array<std::string_view, 3> harmless_extensions{
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07"};

// Elements of extensions that add to or change the shape.
constexpr std::array<std::string_view, 6> other_shapes{"beamlattice", "booleanshape",     "displacementmesh",
                                                       "levelset",    "implicitfunction", "volumedata"};

constexpr auto units = std::to_array<Named<double>>({{"micron", 1e-6},
                                                     {"millimeter", 1e-3},
                                                     {"centimeter", 1e-2},
                                                     {"inch", 0.0254},
                                                     {"foot", 0.3048},
                                                     {"meter", 1.0}});

// Parts and components, whatever a file of components of components promises.
constexpr std::size_t max_parts = std::size_t{1} << 18;
constexpr std::size_t max_nesting = 256;

/// Another object, and where it is put.
struct Component {
  std::string model;  // the file that has it
  std::uint64_t object = 0;
  AffineEnclosure map;
  std::size_t line = 0;
};

struct Object {
  std::string name;
  bool counts = true;               // not a support
  std::optional<std::size_t> mesh;  // in PlacedMeshes::meshes
  std::vector<Component> components;
};

struct Model {
  std::map<std::uint64_t, Object> objects;
  std::vector<Component> items;
  double metres_per_unit = 1e-3;
};

std::string without_slash(std::string_view path) {
  if (path.starts_with('/')) path.remove_prefix(1);
  return std::string(path);
}

/// One file of the package.
class ModelReader {
 public:
  ModelReader(std::string_view text, std::string name, std::string path, PlacedMeshes& placed,
              std::set<std::string>& left_out)
      : name_(std::move(name)),
        path_(std::move(path)),
        xml_(text, name_),
        placed_(placed),
        left_out_(left_out) {}

  Model read() {
    if (xml_.next() != XmlReader::Event::begin || xml_.element() != "model")
      xml_.fail("3MF: 'model' is missing");
    read_heads();
    xml_.each_child([&] {
      if (is("resources")) {
        xml_.each_child([&] { is("object") ? read_object() : skip_other(); });
      } else if (is("build")) {
        xml_.each_child([&] {
          if (is("item")) model_.items.push_back(component());
          xml_.skip();
        });
      } else {
        skip_other();
      }
    });
    static_cast<void>(xml_.next());  // the end of the text, or a fault
    return std::move(model_);
  }

 private:
  [[nodiscard]] bool is(std::string_view element) const {
    return xml_.prefix() == core_ && xml_.element() == element;
  }

  void skip_other() {
    if (std::ranges::find(other_shapes, xml_.element()) != other_shapes.end())
      left_out_.emplace(xml_.element());
    xml_.skip();
  }

  void read_heads() {
    std::map<std::string_view, std::string_view> namespaces;
    for (const XmlReader::Attribute& own : xml_.attributes()) {
      if (own.prefix == "xmlns") namespaces[own.name] = own.value;
      if (own.prefix.empty() && own.name == "xmlns") namespaces[{}] = own.value;
    }
    const auto of_root = namespaces.find(xml_.prefix());
    if (of_root == namespaces.end() || of_root->second != core_namespace)
      xml_.fail("3MF: 'model' is not of the namespace of 3MF's core specification");
    core_ = of_root->first;
    if (const std::optional<std::string> unit = xml_.text("unit")) {
      const auto metres = value_in(units, *unit);
      if (!metres)
        xml_.fail("3MF: unit: " + in_quotes(*unit) + " is not one of " + listed(all_names(units), "and"));
      model_.metres_per_unit = *metres;
    }
    const std::string needed = xml_.text("requiredextensions").value_or("");
    for (std::size_t begin = needed.find_first_not_of(' '); begin != std::string::npos;) {
      const std::size_t end = std::min(needed.find(' ', begin), needed.size());
      const auto known = namespaces.find(std::string_view(needed).substr(begin, end - begin));
      const std::string_view what =
          known == namespaces.end() ? std::string_view(needed).substr(begin, end - begin) : known->second;
      if (std::ranges::find(harmless_extensions, what) == harmless_extensions.end())
        xml_.fail("3MF: the extension " + in_quotes(what) + " is needed: write the file without it");
      begin = needed.find_first_not_of(' ', end);
    }
  }

  void read_object() {
    const std::uint64_t id = xml_.count("id");
    Object object;
    object.name = xml_.text("name").value_or("");
    const std::string type = xml_.text("type").value_or("model");
    object.counts = type != "support" && type != "other";
    xml_.each_child([&] {
      if (is("mesh")) {
        if (object.mesh) xml_.fail("3MF: object " + std::to_string(id) + " has two meshes");
        object.mesh = read_mesh();
      } else if (is("components")) {
        xml_.each_child([&] {
          if (is("component")) object.components.push_back(component());
          xml_.skip();
        });
      } else {
        skip_other();
      }
    });
    if (!model_.objects.emplace(id, std::move(object)).second)
      xml_.fail("3MF: the id " + std::to_string(id) + " is that of two objects");
  }

  std::size_t read_mesh() {
    ControlMesh mesh;
    mesh.tags.scheme = Scheme::flat;
    mesh.metres_per_unit = model_.metres_per_unit;
    xml_.each_child([&] {
      if (is("vertices")) {
        xml_.each_child([&] {
          if (is("vertex")) mesh.points.push_back({xml_.number("x"), xml_.number("y"), xml_.number("z")});
          xml_.skip();
        });
      } else if (is("triangles")) {
        xml_.each_child([&] {
          if (is("triangle")) read_triangle(mesh);
          xml_.skip();
        });
      } else {
        skip_other();
      }
    });
    placed_.meshes.push_back(std::move(mesh));
    return placed_.meshes.size() - 1;
  }

  void read_triangle(ControlMesh& mesh) {
    std::array<VertexId, 3> face;
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr std::array<std::string_view, 3> names{"v1", "v2", "v3"};
      const std::uint64_t index = xml_.count(names[k]);
      if (index >= mesh.points.size()) {
        xml_.fail("3MF: " + std::string(names[k]) + ": index " + std::to_string(index) + " names none of " +
                  std::to_string(mesh.points.size()) + " vertices");
      }
      face[k] = VertexId(index);
    }
    mesh.add_face(face);
  }

  /// Of an item or a component.
  Component component() {
    Component result;
    result.object = xml_.count("objectid");
    result.model = path_;
    result.line = xml_.line();
    for (const XmlReader::Attribute& own : xml_.attributes()) {
      if (!own.prefix.empty() && own.name == "path") result.model = without_slash(own.value);
    }
    const std::optional<std::string> transform = xml_.text("transform");
    if (!transform) return result;
    const std::vector<double> n = numbers_of(xml_, "transform", *transform, 12);
    const std::array<double, 16> rows{n[0], n[1], n[2], 0, n[3], n[4],  n[5],  0,
                                      n[6], n[7], n[8], 0, n[9], n[10], n[11], 1};
    const TransformOperation operation = transform_operation("transform", rows);
    if (!operation.fault.empty()) xml_.fail("3MF: the transform " + operation.fault);
    result.map = operation.map;
    return result;
  }

  std::string name_, path_;
  XmlReader xml_;
  PlacedMeshes& placed_;
  std::set<std::string>& left_out_;
  std::string_view core_;
  Model model_;
};

class PackageReader {
 public:
  PackageReader(std::string_view bytes, const std::string& name, const Notes& notes)
      : name_(name), notes_(notes), archive_(bytes, name), max_elements_(100 * bytes.size()) {}

  PlacedMeshes read() {
    const std::string root = root_model();
    for (const Component& item : model(root).items) place(root, item, {}, "", 0);
    if (placed_.parts.empty())
      fail_in_file(name_, "3MF: nothing is built: the file has no items with triangles");
    write_notes();
    placed_.max_elements = std::min(placed_.max_elements, max_elements_);
    return std::move(placed_);
  }

 private:
  /// The file that the package's relationships name.
  std::string root_model() {
    const std::string relations = "_rels/.rels", usual = "3D/3dmodel.model";
    if (!archive_.holds(relations)) {
      if (archive_.holds(usual)) return usual;
      fail_in_file(name_, "this is a ZIP archive, but no 3MF package: it has no _rels/.rels");
    }
    const std::string text = archive_.read(relations), where = name_ + ": " + relations;
    XmlReader xml(text, where);
    std::string found;
    while (true) {
      const XmlReader::Event event = xml.next();
      if (event == XmlReader::Event::done) break;
      if (event == XmlReader::Event::begin && xml.element() == "Relationship" &&
          xml.text("Type").value_or("").ends_with("/3dmodel")) {
        found = without_slash(xml.required_text("Target"));
      }
    }
    if (found.empty()) fail_in_file(name_, "3MF: the package names no 3D model");
    return found;
  }

  const Model& model(const std::string& path) {
    const auto known = models_.find(path);
    if (known != models_.end()) return known->second;
    if (!archive_.holds(path)) fail_in_file(name_, "3MF: the package has no file " + in_quotes(path));
    const std::string bytes = archive_.read(path);
    const std::string where = name_ + ": " + path;
    const std::string_view text = plain_text(bytes, where);
    max_elements_ += bytes.size();
    const Model& read =
        models_.emplace(path, ModelReader(text, where, path, placed_, left_out_).read()).first->second;
    if (read.metres_per_unit != metres_per_unit_.value_or(read.metres_per_unit))
      fail_in_file(where, "3MF: its unit is not that of the other models of the package");
    metres_per_unit_ = read.metres_per_unit;
    return read;
  }

  void place(const std::string& from, const Component& at, const AffineEnclosure& above,
             const std::string& name, std::size_t depth) {
    const auto what = [&] { return "3MF: object " + std::to_string(at.object); };
    const auto fail = [&](const std::string& message) {
      fail_in_file(name_ + ": " + from + ':' + std::to_string(at.line), message);
    };
    if (depth > max_nesting)
      fail(what() + ": components of components, more than 256 deep or without an end");
    if (++visits_ > 4 * max_parts || placed_.parts.size() > max_parts)
      fail("3MF: more than " + std::to_string(max_parts) + " parts, with all components");
    const Model& own = model(at.model);
    const auto found = own.objects.find(at.object);
    if (found == own.objects.end()) fail(what() + " is in no file of the package");
    const Object& object = found->second;
    if (!object.counts) {
      ++supports_;
      return;
    }
    const AffineEnclosure map = above.after(at.map);
    if (!map.is_finite()) fail(what() + " is placed beyond the range of doubles");
    const std::string& named = object.name.empty() ? name : object.name;
    if (object.mesh && placed_.meshes[*object.mesh].face_count() > 0)
      placed_.parts.push_back({named, what(), *object.mesh, map});
    for (const Component& component : object.components) place(at.model, component, map, named, depth + 1);
  }

  void write_notes() const {
    if (!notes_) return;
    if (supports_ > 0)
      notes_(name_ + ": " + std::to_string(supports_) +
             " objects of the types support and other are left out");
    for (const std::string& element : left_out_)
      notes_(name_ + ": '" + element + "' is not read: the surface is the one without it");
  }

  const std::string& name_;
  const Notes& notes_;
  ZipArchive archive_;
  std::size_t max_elements_;
  std::map<std::string, Model> models_;  // by their files; nodes stay where they are
  PlacedMeshes placed_;
  std::optional<double> metres_per_unit_;
  std::set<std::string> left_out_;
  std::size_t visits_ = 0, supports_ = 0;
};

// --- writing

void append_escaped(std::string& text, std::string_view name) {
  for (const char32_t c : code_points(name)) {
    if (c == '<') {
      text += "&lt;";
    } else if (c == '&') {
      text += "&amp;";
    } else if (c == '"') {
      text += "&quot;";
    } else if (c >= ' ' && c <= '~') {
      text += static_cast<char>(c);
    } else if (c < 0xa0 || (c >= 0xd800 && c < 0xe000) || c == 0xfffe || c >= 0xffff) {
      text += '_';  // none that XML has, or none that editors show
    } else {
      append_utf8(text, c);  // lib3mf takes no references to characters
    }
  }
}

std::string_view unit_of(const ControlMesh& mesh, const std::string& name, const Notes& notes) {
  if (!mesh.metres_per_unit) {
    if (notes)
      notes(name +
            ": the unit of the mesh is not known: it is written as millimetres, as 3MF does without one");
    return "millimeter";
  }
  for (const Named<double>& unit : units) {
    if (unit.value == *mesh.metres_per_unit) return unit.name;
  }
  std::string text = name + ": 3MF has no unit of ";
  append_real(text, *mesh.metres_per_unit);
  throw InputError(InputProblem::refused, text + " metres; it has " + listed(all_names(units), "and"));
}

// The root model of a package, handed on part by part.
class ModelWriter {
 public:
  ModelWriter(std::string_view unit, const std::string& name, const ZipWriter::Append& append)
      : name_(name), append_(append) {
    text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"";
    text_.append(unit).append("\" xml:lang=\"en-US\" xmlns=\"").append(core_namespace);
    text_ += "\">\n<resources>\n";
  }

  /// An object; returns its id.
  std::uint32_t add(const ControlMesh& mesh, std::string_view name) {
    begin_object(name);
    text_ += "<mesh>\n<vertices>\n";
    for (const Point3& point : mesh.points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        text_ += std::array{"<vertex x=\"", "\" y=\"", "\" z=\""}[axis];
        append_real(text_, point[axis]);
      }
      text_ += "\"/>\n";
      if (text_.size() >= part_size) send();
    }
    text_ += "</vertices>\n<triangles>\n";
    for (std::size_t f = 0; f < mesh.face_count(); ++f) add_face(mesh.face(FaceId(f)), f);
    text_ += "</triangles>\n</mesh>\n</object>\n";
    return objects_;
  }
  /// An object that is another one, placed; returns its id.
  std::uint32_t add(std::uint32_t object, std::string_view name, const Motion& pose) {
    begin_object(name);
    text_ += "<components>\n<component objectid=\"";
    append_place(text_, object, pose);
    text_ += "</components>\n</object>\n";
    return objects_;
  }
  void build(std::uint32_t object, const Motion& pose) {
    items_ += "<item objectid=\"";
    append_place(items_, object, pose);
  }

  void write_notes(const Notes& notes) const {
    if (!notes) return;
    if (polygons_) notes(name_ + ": 3MF holds triangles only: faces with more corners are split into fans");
    if (degenerate_ > 0) {
      notes(name_ + ": " + std::to_string(degenerate_) +
            " triangles that name a vertex twice are left out: 3MF has none");
    }
  }
  void finish() {
    text_.append("</resources>\n<build>\n").append(items_).append("</build>\n</model>\n");
    send();
  }

 private:
  static constexpr std::size_t part_size = std::size_t{1} << 16;

  void send() {
    append_(text_);
    text_.clear();
  }

  void begin_object(std::string_view name) {
    text_ += "<object id=\"";
    append_integer(text_, ++objects_);
    text_ += "\" type=\"model\"";
    if (!name.empty()) {
      text_ += " name=\"";
      append_escaped(text_, name);
      text_ += '"';
    }
    text_ += ">\n";
  }

  void add_face(std::span<const VertexId> corners, std::size_t face) {
    if (corners.size() < 3) {
      throw InputError(InputProblem::refused, name_ + ": face " + std::to_string(face) + " has " +
                                                  std::to_string(corners.size()) + " corners");
    }
    polygons_ = polygons_ || corners.size() > 3;
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const std::array<VertexId, 3> triangle{corners[0], corners[k - 1], corners[k]};
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
        ++degenerate_;
        continue;
      }
      for (std::size_t i = 0; i < 3; ++i) {
        text_ += std::array{"<triangle v1=\"", "\" v2=\"", "\" v3=\""}[i];
        append_integer(text_, triangle[i].value());
      }
      text_ += "\"/>\n";
      if (text_.size() >= part_size) send();
    }
  }

  // 3MF multiplies rows by matrices: it has the columns of ours.
  static void append_place(std::string& text, std::uint32_t object, const Motion& pose) {
    append_integer(text, object);
    if (!(pose == Motion())) {
      text += "\" transform=\"";
      for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 3; ++row) {
          if (column + row > 0) text += ' ';
          append_real(text, pose.numbers()[4 * row + column]);
        }
      }
    }
    text += "\"/>\n";
  }

  const std::string& name_;
  const ZipWriter::Append& append_;
  std::string text_, items_;
  std::uint32_t objects_ = 0;
  bool polygons_ = false;
  std::size_t degenerate_ = 0;
};

// Of what write(model) adds to the root model.
template <class Write>
std::string package_of(std::string_view unit, const std::string& name, const Notes& notes,
                       const Write& write) {
  ZipWriter archive;
  archive.add(
      "[Content_Types].xml",
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
      "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
      "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
      "</Types>\n");
  archive.add("_rels/.rels",
              "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
              "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
              "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
              "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n");
  archive.add("3D/3dmodel.model", [&](const ZipWriter::Append& append) {
    ModelWriter model(unit, name, append);
    write(model);
    model.write_notes(notes);
    model.finish();
  });
  return archive.finish(name);
}

}  // namespace

PlacedMeshes read_3mf(std::string_view bytes, const std::string& name, const Notes& notes) {
  if (!begins_like_zip(bytes)) {
    refuse_other_formats(bytes, name);
    fail_in_file(name, "this is not a 3MF file: it does not begin like a ZIP archive");
  }
  return PackageReader(bytes, name, notes).read();
}

ControlMesh parse_3mf(std::string_view bytes, const std::string& name, const Notes& notes) {
  return joined(read_3mf(bytes, name, notes), name, notes);
}

std::string format_3mf(const ControlMesh& mesh, const std::string& name, const Notes& notes) {
  return package_of(unit_of(mesh, name, notes), name, notes, [&](ModelWriter& model) {
    model.build(model.add(mesh, system_files::stem_of(name)), {});
  });
}

std::string format_3mf(const MeshAssembly& assembly, const std::string& name, const Notes& notes) {
  std::vector<std::size_t> uses(assembly.meshes.size());
  std::optional<std::string_view> unit;
  for (const MeshAssembly::Part& part : assembly.parts) {
    const ControlMesh& mesh = assembly.meshes[part.mesh];
    if (!unit) unit = unit_of(mesh, name, notes);
    if (mesh.metres_per_unit != assembly.meshes[assembly.parts[0].mesh].metres_per_unit)
      throw InputError(InputProblem::refused, name + ": 3MF files are in one unit, the parts are not");
    ++uses[part.mesh];
  }
  return package_of(unit.value_or("millimeter"), name, notes, [&](ModelWriter& model) {
    std::vector<std::uint32_t> objects(assembly.meshes.size());
    for (const MeshAssembly::Part& part : assembly.parts) {
      const bool shared = uses[part.mesh] > 1;
      std::uint32_t& object = objects[part.mesh];
      if (object == 0) object = model.add(assembly.meshes[part.mesh], shared ? "" : part.name);
      if (shared) {
        model.build(model.add(object, part.name, part.pose), {});
      } else {
        model.build(object, part.pose);
      }
    }
  });
}

}  // namespace snug
